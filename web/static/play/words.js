// Words for actions and things; sentences come from the one table of them.
import PHRASES from "/phrases.js";

const filled = (text, values) => text.replace(/\{(\w+)\}/g, (_, key) => values[key] ?? "");

export const say = (name, values = {}) => filled(PHRASES.play[name], values);

export function name(things, id) {
  return things.get(id)?.words ?? PHRASES.verbs.wall;
}

// The name of a thing, and that the goal is about it: of two that look alike, one may not count.
export function titled(state, id) {
  const thing = state.things.get(id);
  const label = name(state.things, id);
  return thing && state.wanted.has(thing.className) ? say("for_goal", { thing: label }) : label;
}

// An act by the names of its things; an action without words of its own stands before them.
const acted = (action, names) =>
  action in PHRASES.verbs ? filled(PHRASES.verbs[action], { thing: names[0], place: names[1] }) : [action, ...names].join(" ");

export const spoken = (action, ids, things) => acted(action, ids.map((id) => name(things, id)));

export const stateWord = (state) => PHRASES.states[state] ?? state.toLowerCase().replaceAll("_", " ");

export const written = (action, ids, things) =>
  [`[${action}]`, ...ids.map((id) => `<${things.get(id).className}> (1.${id})`)].join(" ");

const READ = /<([^>]+)> \((?:\d+\.)?(\d+)\)/g;

// An instruction as its action and the names that the page has for its things.
function told(instruction, things) {
  const names = [...instruction.matchAll(READ)].map(([, given, id]) => things.get(Number(id))?.words ?? given.replaceAll("_", " "));
  return [/\[(\w+)\]/.exec(instruction)?.[1] ?? "", names];
}

// What a character did in the last tick, or why it could not; "" before it did anything.
export function happened(agent, state, late) {
  const mine = agent.agent === state.me;
  const who = say(mine ? "you" : "the_other");
  if (agent.waited) return say(mine && late ? "late" : "waited", { who, seconds: state.patience });
  if (!agent.last) return "";
  const [action, names] = told(agent.last.instruction, state.things);
  const failure = agent.last.failure;
  if (!failure && action in PHRASES.done) return filled(PHRASES.done[action], { who, thing: names[0], place: names[1] });
  const act = acted(action, names);
  const small = PHRASES.language === "de" ? act : act[0].toLowerCase() + act.slice(1); // there a noun may come first
  return say(failure ? "failed" : "did", { who, act: small, why: failure?.words });
}

// Why a game is over, in words.
export function ending(state) {
  return say(`end_${endOf(state)}`, { after: say(state.tick === 1 ? "after_one" : "after", { tick: state.tick }) });
}

function endOf(state) {
  if (state.success) return "reached";
  if (state.goal.some((each) => each.lost)) return "lost";
  if (state.end === "FINISHED") return state.ended_by === state.me ? "you" : "other";
  if (state.end === "TIMED_OUT" && state.ended_by === 0) return "time";
  return state.end ? "helper" : "ticks";
}

// Whole seconds until a moment of `performance.now`, and seconds as a clock shows them.
export const left = (until) => Math.max(0, Math.ceil((until - performance.now()) / 1000));
export const clockTime = (seconds) => `${Math.floor(seconds / 60)}:${String(seconds % 60).padStart(2, "0")}`;

// What a refusal means to who plays.
export function refused({ code, place }) {
  const known = PHRASES.refused;
  return place === "act" ? known.act : known[code] ?? known.other;
}
