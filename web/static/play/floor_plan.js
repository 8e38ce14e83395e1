// The floor plan (panel E): rooms, what is known of furniture, characters with facing, trails and what they hold.
import { name, say } from "./words.js";

const SVG = "http://www.w3.org/2000/svg";

function made(tag, attributes, text) {
  const node = document.createElementNS(SVG, tag);
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
  if (text) node.textContent = text;
  return node;
}

export class FloorPlan {
  constructor(svg, choose) {
    this.svg = svg;
    this.choose = choose;
  }

  begin(state) {
    const rooms = state.plan.filter(([kind]) => kind === "room");
    const xs = rooms.flatMap(([, , box]) => [box[0], box[2]]);
    const zs = rooms.flatMap(([, , box]) => [box[1], box[3]]);
    const [left, right, low, high] = [Math.min(...xs) - 0.3, Math.max(...xs) + 0.3, Math.min(...zs) - 0.3, Math.max(...zs) + 0.3];
    this.high = high;
    this.svg.setAttribute("viewBox", `${left} 0 ${right - left} ${high - low}`);
    this.svg.replaceChildren();
    this.layers = {};
    for (const layer of ["rooms", "furniture", "walls", "names", "trails", "characters"]) {
      this.layers[layer] = this.svg.appendChild(made("g", { class: layer }));
    }
    for (const each of state.plan) this.fixed(...each);
    this.drawn = new Set();
  }

  fixed(kind, className, box, id, words) {
    const layer = kind === "room" ? "rooms" : "walls";
    const shape = this.layers[layer].appendChild(made("rect", { ...this.rect(box), class: `${kind} ${className}` }));
    // A finger is taken to mean what can be pressed nearby: walls and windows, of which nothing can be done, are not.
    if (["room", "door"].includes(kind)) shape.addEventListener("click", () => this.choose(id));
    if (kind !== "room") return;
    const [x, y] = [(box[0] + box[2]) / 2, this.high - box[3] + 0.45];
    this.layers.names.appendChild(made("text", { x, y, class: "room-name" }, words));
  }

  rect([x0, z0, x1, z1]) {
    return { x: x0, y: this.high - z1, width: Math.max(x1 - x0, 0.05), height: Math.max(z1 - z0, 0.05) };
  }

  update(state) {
    for (const thing of state.things.values()) {
      if (thing.group !== "furniture" || !thing.box || this.drawn.has(thing.id)) continue;
      this.drawn.add(thing.id);
      const shape = made("rect", { ...this.rect(thing.box), class: "piece" });
      shape.appendChild(made("title", {}, name(state.things, thing.id)));
      shape.addEventListener("click", () => this.choose(thing.id));
      this.layers.furniture.appendChild(shape);
    }
    this.layers.trails.replaceChildren(...[...state.trails].map(([who, way]) => this.trail(who, way, state.me)));
    this.layers.characters.replaceChildren(...state.agents.filter((a) => a.place).map((a) => this.character(a, state)));
    this.svg.setAttribute("aria-label", this.told(state));
  }

  trail(who, way, me) {
    const points = way.map(([, x, z]) => `${x},${this.high - z}`).join(" ");
    return made("polyline", { points, class: `trail ${who === me ? "me" : "other"}` });
  }

  character(agent, state) {
    const [x, z, yaw] = agent.place;
    const group = made("g", { class: `character ${agent.agent === state.me ? "me" : "other"}`, transform: `translate(${x} ${this.high - z})` });
    group.appendChild(made("path", { d: "M 0 -0.55 L 0.24 -0.1 L -0.24 -0.1 Z", transform: `rotate(${yaw})` }));
    group.appendChild(made("circle", { r: 0.26 }));
    const held = agent.holding.map((id) => name(state.things, id)).join(", ");
    // Of two who stand together, one has it above and the other below, so that both can be read.
    if (held) group.appendChild(made("text", { x: 0, y: agent.agent === state.me ? 0.62 : -0.45, class: "held" }, held));
    return group;
  }

  told(state) {
    const room = (id) => (id ? name(state.things, id) : "–");
    const sides = say("sides").split(", ");
    const said = state.agents.filter((agent) => agent.place).map((agent) => {
      const side = sides[Math.round(agent.place[2] / 45) % 8];
      return say(agent.agent === state.me ? "plan_you" : "plan_other", { room: room(agent.room), side });
    });
    return said.join(" ");
  }
}
