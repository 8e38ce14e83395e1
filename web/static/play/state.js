// What the page knows of a game: the server's messages put together.
export class State {
  constructor() {
    this.things = new Map();
    this.trails = new Map();
    this.legal = {};
    this.agents = [];
    this.goal = [];
    this.tick = -1;
    this.held = new Map(); // what each other character held when it was seen last
  }

  take(message) {
    if (message.type === "begin") {
      Object.assign(this, { me: message.me, plan: message.plan, limit: message.limit, helper: message.helper });
      Object.assign(this, { partial: message.partial, code: message.code, port: message.port, token: message.token, characters: message.characters });
      this.until = message.left === null ? null : performance.now() + 1000 * message.left;
      this.things.clear();
      this.held.clear();
      this.trails = new Map(Object.entries(message.trails).map(([who, way]) => [Number(who), way]));
    }
    for (const [id, [className, group, box, words]] of Object.entries(message.things)) {
      this.things.set(Number(id), { id: Number(id), className, group, box, words, seen: false });
    }
    for (const [id, [room, relation, holder, states, close]] of Object.entries(message.changed)) {
      Object.assign(this.things.get(Number(id)), { room, relation, holder, states, close: Boolean(close), seen: true });
    }
    for (const id of message.gone) this.things.get(id).seen = false;
    for (const key of ["tick", "goal", "legal", "agents", "over", "success", "end", "ended_by", "decided", "go_on", "other", "patience"]) this[key] = message[key];
    const { decide_within: within } = message;
    this.decideUntil = within === null || within === undefined ? null : performance.now() + 1000 * within;
    for (const agent of this.agents) if (agent.agent !== this.me) this.held.set(agent.agent, agent.holding);
    if (message.type === "tick") this.follow();
    this.usable = new Set(Object.values(this.legal).flat(2));
    this.wanted = new Set(this.goal.flatMap((each) => each.classes));
  }

  follow() {
    for (const agent of this.agents) {
      if (!agent.place) continue;
      if (!this.trails.has(agent.agent)) this.trails.set(agent.agent, []);
      const way = this.trails.get(agent.agent);
      if (way.at(-1)?.[0] !== this.tick) way.push([this.tick, ...agent.place]);
    }
  }

  get mine() {
    return this.agents.find((agent) => agent.agent === this.me);
  }

  // The instructions that name a thing, as [action, ids].
  about(id) {
    const found = [];
    for (const [action, places] of Object.entries(this.legal)) {
      if (places.length === 1 && places[0].includes(id)) found.push([action, [id]]);
      if (places.length !== 2) continue;
      if (places[0].includes(id)) for (const other of places[1]) if (other !== id) found.push([action, [id, other]]);
      if (places[1].includes(id)) for (const other of places[0]) if (other !== id) found.push([action, [other, id]]);
    }
    return found;
  }

  // One is at a room once one is in it, at a thing once it is within reach: then going on would only cost ticks.
  at(thing) {
    return thing.group === "rooms" && this.mine.room === thing.id || Boolean(thing.close);
  }

  can(action, ids = []) {
    const places = this.legal[action];
    return Boolean(places) && places.length === ids.length && ids.every((id, n) => places[n].includes(id));
  }
}
