// First person by pictures of Hearth's own renderer, for machines without WebGL: the server says what a click is on.
import { viewKeys } from "./view_keys.js";
import { say, titled } from "./words.js";

const AGAIN = 1000; // milliseconds

export class FirstPerson {
  constructor(game, element, { choose, send, act, save, finish }) {
    Object.assign(this, { element, choose, send });
    this.image = document.createElement("img");
    this.image.alt = "";
    this.image.width = 640;
    this.image.height = 480;
    this.label = document.createElement("div");
    this.label.className = "label";
    this.label.textContent = say("loading");
    element.replaceChildren(this.image, this.label);
    this.image.addEventListener("click", (event) => {
      const box = this.image.getBoundingClientRect();
      const [x, y] = [(event.clientX - box.left) / box.width * 640, (event.clientY - box.top) / box.height * 480];
      send({ type: "pick", x: Math.floor(x), y: Math.floor(y) });
    });
    viewKeys(this, { act, save, finish });
    send({ type: "picture" });
  }

  update(state) {
    this.state = state;
  }

  // A busy server sends no picture: it is asked for again, until the one of this tick is there.
  trouble({ code }) {
    if (code !== "TIMED_OUT" || this.element.dataset.tick === String(this.state?.tick)) return;
    setTimeout(() => this.send({ type: "picture" }), AGAIN);
  }

  picture(data) {
    if (!this.image.src) this.label.hidden = true;
    const last = this.image.src;
    this.image.src = URL.createObjectURL(data);
    this.element.dataset.tick = this.state?.tick ?? 0;
    if (last) URL.revokeObjectURL(last);
  }

  picked(id) {
    this.show(id);
    this.click(id);
  }

  click(id) {
    if (id) this.choose(id, this.element);
  }

  show(id) {
    this.label.hidden = !id;
    if (id) this.label.textContent = titled(this.state, id);
  }

  lookUp() {}

  turnHeld() {}
}
