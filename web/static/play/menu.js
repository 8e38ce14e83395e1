// What one can do with a thing: a panel with a button for each legal instruction about it.
import { say, spoken, stateWord, titled } from "./words.js";

const USUAL = new Set(["CLEAN", "PLUGGED_IN"]); // states that nobody asks about

// Of pieces of floor that nobody can tell apart, the first.
function distinct(options, state) {
  const known = new Set();
  return options.filter(([action, ids]) => {
    if (!ids.some((id) => state.things.get(id).group === "floor")) return true;
    const words = spoken(action, ids, state.things);
    return !known.has(words) && Boolean(known.add(words));
  });
}

export class Menu {
  constructor(act, walk) {
    this.panel = document.getElementById("menu");
    this.title = document.getElementById("menu-title");
    this.actions = document.getElementById("menu-actions");
    this.act = act;
    this.walk = walk;
    this.id = null;
    this.from = null;
    document.getElementById("menu-close").addEventListener("click", () => this.close());
    document.addEventListener("keydown", (event) => event.key === "Escape" && this.close());
  }

  open(id, state, from = document.activeElement) {
    this.id = id;
    this.from = from;
    this.panel.hidden = false;
    this.fill(state);
    (this.actions.querySelector("button") ?? document.getElementById("menu-close")).focus();
  }

  close() {
    if (this.panel.hidden) return;
    this.panel.hidden = true;
    this.id = null;
    const back = [this.from, document.getElementById("view"), document.getElementById("main")];
    back.find((each) => each?.isConnected && !each.disabled && each !== document.body).focus({ preventScroll: true });
  }

  fill(state) {
    const id = this.id; // the menu forgets it when it closes, before it does what was pressed
    const thing = state.things.get(id);
    const states = (thing.states ?? []).filter((each) => !USUAL.has(each)).map(stateWord).join(", ");
    this.title.textContent = `${titled(state, id)}${states ? ` (${states})` : ""}`;
    const options = distinct(state.about(id), state);
    const buttons = options.map(([action, ids]) => {
      const made = this.button(spoken(action, ids, state.things), () => this.act(action, ids));
      made.dataset.instruction = [action, ...ids].join(" ");
      return made;
    });
    if (state.can("Walktowards", [id])) {
      buttons.find((button) => button.dataset.instruction.startsWith("Walktowards")).textContent = say("one_step");
      if (!state.at(thing)) buttons.unshift(this.button(say("all_the_way"), () => this.walk(id)));
    }
    const nothing = document.createElement("p");
    nothing.textContent = say("nothing");
    const inside = this.actions.contains(document.activeElement);
    this.actions.replaceChildren(...(buttons.length ? buttons : [nothing]));
    if (inside) (this.actions.querySelector("button") ?? document.getElementById("menu-close")).focus({ preventScroll: true });
  }

  button(text, done) {
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = text;
    button.addEventListener("click", () => {
      this.close();
      done();
    });
    return button;
  }

  update(state) {
    if (this.panel.hidden) return;
    if (state.over || !state.things.get(this.id)?.seen) this.close();
    else this.fill(state);
  }
}
