// Words for actions and things; sentences come from the one table of them.
import PHRASES from "/phrases.js";

const VERBS = {
  Walktowards: "Walk to", Walk: "Walk to", Grab: "Take", Open: "Open", Close: "Close", SwitchOn: "Switch on", SwitchOff: "Switch off",
  Sit: "Sit down on", StandUp: "Stand up", Turnleft: "Turn left", Turnright: "Turn right", Walkforward: "Walk forward",
};
const PUTS = { PutBack: "on", PutIn: "in" };

const filled = (text, values) => text.replace(/\{(\w+)\}/g, (_, key) => values[key] ?? "");

export const say = (name, values = {}) => filled(PHRASES.play[name], values);

export function name(things, id) {
  return things.get(id)?.words ?? "wall";
}

export function spoken(action, ids, things) {
  if (action in PUTS) return `Put ${name(things, ids[0])} ${PUTS[action]} ${name(things, ids[1])}`;
  return [VERBS[action] ?? action, ...ids.map((id) => name(things, id))].join(" ");
}

export const written = (action, ids, things) =>
  [`[${action}]`, ...ids.map((id) => `<${things.get(id).className}> (1.${id})`)].join(" ");

const READ = /<([^>]+)> \((?:\d+\.)?(\d+)\)/g;

// An act that was done, by the names that the page has for its things.
export function retold(instruction, things) {
  const action = /\[(\w+)\]/.exec(instruction)?.[1] ?? "";
  const names = [...instruction.matchAll(READ)].map(([, given, id]) => things.get(Number(id))?.words ?? given.replaceAll("_", " "));
  if (action in PUTS) return `put ${names[0]} ${PUTS[action]} ${names[1]}`;
  return [(VERBS[action] ?? action).toLowerCase(), ...names].join(" ");
}

// What a refusal means to who plays.
export function refused({ code, place }) {
  const known = PHRASES.refused;
  return place === "act" ? known.act : known[code] ?? known.other;
}
