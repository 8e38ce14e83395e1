// Words for actions and things; sentences come from the one table of them.
import PHRASES from "/phrases.js";

const filled = (text, values) => text.replace(/\{(\w+)\}/g, (_, key) => values[key] ?? "");

export const say = (name, values = {}) => filled(PHRASES.play[name], values);

export function name(things, id) {
  return things.get(id)?.words ?? PHRASES.verbs.wall;
}

// An act by the names of its things; an action without words of its own stands before them.
const acted = (action, names) =>
  action in PHRASES.verbs ? filled(PHRASES.verbs[action], { thing: names[0], place: names[1] }) : [action, ...names].join(" ");

export const spoken = (action, ids, things) => acted(action, ids.map((id) => name(things, id)));

export const stateWord = (state) => PHRASES.states[state] ?? state.toLowerCase().replaceAll("_", " ");

export const written = (action, ids, things) =>
  [`[${action}]`, ...ids.map((id) => `<${things.get(id).className}> (1.${id})`)].join(" ");

const READ = /<([^>]+)> \((?:\d+\.)?(\d+)\)/g;

// An act that was done, by the names that the page has for its things.
export function retold(instruction, things) {
  const action = /\[(\w+)\]/.exec(instruction)?.[1] ?? "";
  const names = [...instruction.matchAll(READ)].map(([, given, id]) => things.get(Number(id))?.words ?? given.replaceAll("_", " "));
  const said = acted(action, names);
  return PHRASES.language === "en" ? said[0].toLowerCase() + said.slice(1) : said; // in others a noun may come first
}

// What a refusal means to who plays.
export function refused({ code, place }) {
  const known = PHRASES.refused;
  return place === "act" ? known.act : known[code] ?? known.other;
}
