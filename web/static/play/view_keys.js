// The keys of the first-person views: walk and turn, look, choose a thing, rotate what is held, save, finish.
const MOVES = { w: "Walkforward", a: "Turnleft", d: "Turnright" };
const LOOKS = { ArrowUp: 10, ArrowDown: -10 };
const TURNS = { ArrowLeft: "Turnleft", ArrowRight: "Turnright" };

export function viewKeys(view, element, { act, save, finish }) {
  let chosen = -1;

  // What one can do something with, what is close first.
  const within = () => [...view.state.things.values()]
    .filter((thing) => thing.seen && view.state.usable.has(thing.id) && thing.group !== "floor")
    .sort((a, b) => b.close - a.close || view.state.wanted.has(b.className) - view.state.wanted.has(a.className) || a.id - b.id);

  element.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.altKey || event.metaKey || !view.state) return;
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    const things = key === "t" || key === "Enter" ? within() : [];
    if (key in MOVES) act(MOVES[key]);
    else if (key in TURNS) act(TURNS[key]);
    else if (key === "s") act("Turnright", 6);
    else if (key in LOOKS) view.lookUp(LOOKS[key]);
    else if (key === "t") {
      chosen = (chosen + (event.shiftKey ? things.length - 1 : 1)) % things.length;
      view.show(things[chosen]?.id);
    } else if (key === "Enter") view.click(things[Math.max(0, chosen)]?.id);
    else if (key === "q" || key === "e") view.turnHeld(key === "q" ? -15 : 15);
    else if (key === "v") save();
    else if (key === "g") finish();
    else if (key === ".") act("");
    else return;
    event.preventDefault();
  });
}
