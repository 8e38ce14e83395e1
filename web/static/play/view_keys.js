// The keys of the first-person views: walk and turn, look, choose a thing, rotate what is held, save, finish.
const MOVES = { w: "Walkforward", a: "Turnleft", d: "Turnright" };
const LOOKS = { ArrowUp: 10, ArrowDown: -10 };
const TURNS = { ArrowLeft: "Turnleft", ArrowRight: "Turnright" };

export function viewKeys(view, { act, save, finish }) {
  let chosen = 0;

  // What one can do something with, and that is in the picture, where that is known; what is close first.
  function within() {
    const usable = [...view.state.things.values()].filter((thing) => thing.seen && view.state.usable.has(thing.id) && thing.group !== "floor");
    const sight = view.inSight?.();
    const shown = usable.filter((thing) => !sight || sight.has(thing.id));
    const wanted = (thing) => view.state.wanted.has(thing.className);
    return (shown.length ? shown : usable).sort((a, b) => b.close - a.close || wanted(b) - wanted(a) || a.id - b.id);
  }

  function next(back) {
    const things = within();
    const at = things.findIndex((thing) => thing.id === chosen);
    chosen = things.at(at < 0 ? (back ? -1 : 0) : (at + (back ? -1 : 1)) % things.length)?.id ?? 0;
    view.show(chosen);
    view.mark?.(chosen);
  }

  // Keys work wherever one pressed last, except where one writes or is asked something.
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.altKey || event.metaKey || !view.state) return;
    if (event.target.closest("input, select, textarea") || document.querySelector("dialog[open]")) return;
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    if (key === "Enter" && event.target.closest("button, a")) return;
    if (key in MOVES) act(MOVES[key]);
    else if (key in TURNS) act(TURNS[key]);
    else if (key === "s") act("Turnright", 6);
    else if (key in LOOKS) view.lookUp(LOOKS[key]);
    else if (key === "t") next(event.shiftKey);
    else if (key === "Enter") {
      const things = within();
      view.click((things.find((thing) => thing.id === chosen) ?? things[0])?.id);
    } else if (key === "q" || key === "e") view.turnHeld(key === "q" ? -15 : 15);
    else if (key === "v") save();
    else if (key === "g") finish();
    else if (key === ".") act("");
    else return;
    event.preventDefault();
  });
}
