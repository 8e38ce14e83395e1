// All things as buttons (panels B, C, D): enabled when something can be done with them, green when close.
import { name, say } from "./words.js";

const PEOPLE = -1; // stands for the room of people in the list of rooms
const PANELS = ["rooms", "furniture", "things"];

export class ObjectPanels {
  constructor(choose) {
    this.choose = choose;
    this.buttons = new Map();
    this.find = document.getElementById("find");
    this.which = document.getElementById("which");
    for (const field of [this.find, this.which]) field.addEventListener("input", () => this.state && this.update(this.state));
  }

  begin() {
    this.buttons.clear();
    this.shown = "";
    for (const panel of PANELS) document.getElementById(panel).replaceChildren();
  }

  button(thing, state) {
    const button = document.createElement("button");
    button.type = "button";
    button.className = "thing";
    button.dataset.id = thing.id;
    button.append(name(state.things, thing.id), document.createElement("small"));
    button.addEventListener("click", () => this.choose(thing.id));
    this.buttons.set(thing.id, button);
    return button;
  }

  update(state) {
    this.state = state;
    const text = this.find.value.trim().toLowerCase();
    const chosen = [...state.things.values()].filter((thing) => this.wants(thing, state, text));
    for (const thing of chosen) this.dress(this.buttons.get(thing.id) ?? this.button(thing, state), thing, state);
    document.getElementById("none").hidden = chosen.length > 0;
    const order = chosen.map((thing) => `${thing.id}:${thing.room}`).join();
    if (order !== this.shown) this.arrange(chosen, state);
    this.shown = order;
  }

  // Things that were seen in another room are listed where one looks for them: as names, with that room.
  wants(thing, state, text) {
    const which = this.which.value;
    if (!thing.seen && !(thing.room && (text || which === "goal"))) return false;
    if (which === "close" && !thing.close) return false;
    if (which === "goal" && !state.wanted.has(thing.className) && thing.group !== "rooms") return false;
    return !text || `${name(state.things, thing.id)} ${thing.className}`.replaceAll("_", " ").includes(text);
  }

  dress(button, thing, state) {
    button.disabled = state.over || !thing.seen || !state.usable.has(thing.id);
    button.classList.toggle("close", thing.seen && thing.close);
    button.classList.toggle("wanted", state.wanted.has(thing.className));
    const label = thing.seen
      ? [this.where(thing, state), thing.close ? say("reach") : ""].filter(Boolean).join(" · ")
      : say("seen_before", { room: name(state.things, thing.room) });
    if (button.lastChild.textContent !== label) button.lastChild.textContent = label;
  }

  where(thing, state) {
    if (!thing.holder) return "";
    const mine = state.mine?.node === thing.holder;
    const place = mine ? say("you").toLowerCase() : name(state.things, thing.holder);
    if (thing.relation === "held") return say("held", { who: place });
    return say(`lying_${thing.relation}`, { place });
  }

  // Buttons stay the same elements, so that the focus stays where it is.
  arrange(chosen, state) {
    const focused = document.activeElement;
    for (const panel of PANELS) {
      const groups = new Map();
      const some = chosen.filter((thing) => (thing.group === "people" ? "rooms" : thing.group) === panel);
      for (const thing of some.sort((a, b) => a.className.localeCompare(b.className) || a.id - b.id)) {
        const room = panel !== "rooms" ? thing.room : thing.group === "people" ? PEOPLE : 0;
        if (!groups.has(room)) groups.set(room, []);
        groups.get(room).push(this.buttons.get(thing.id));
      }
      const here = state.mine?.room ?? 0;
      const rooms = [...groups.keys()].sort((a, b) => (b === here) - (a === here) || (a < 0) - (b < 0) || a - b);
      const lists = rooms.flatMap((room) => this.group(room, groups.get(room), state));
      document.getElementById(panel).replaceChildren(...lists);
    }
    if (focused?.isConnected && focused !== document.activeElement) focused.focus();
  }

  group(room, buttons, state) {
    const list = document.createElement("ul");
    for (const button of buttons) list.appendChild(document.createElement("li")).appendChild(button);
    if (!room) return [list];
    const head = document.createElement("h3");
    head.textContent = room === PEOPLE ? say("people") : name(state.things, room);
    return [head, list];
  }
}
