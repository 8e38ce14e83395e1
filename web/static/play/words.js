// Words for actions and things.
const VERBS = {
  Walktowards: "Walk to", Walk: "Walk to", Grab: "Take", Open: "Open", Close: "Close", SwitchOn: "Switch on", SwitchOff: "Switch off",
  Sit: "Sit down on", StandUp: "Stand up", Turnleft: "Turn left", Turnright: "Turn right", Walkforward: "Walk forward",
};
const PUTS = { PutBack: "on", PutIn: "in" };

const CALLED = { character: "the other person", maindoor: "front door" };

export function name(things, id) {
  const found = things.get(id);
  return found ? (CALLED[found.className] ?? found.words) : "wall";
}

export function spoken(action, ids, things) {
  if (action in PUTS) return `Put ${name(things, ids[0])} ${PUTS[action]} ${name(things, ids[1])}`;
  return [VERBS[action] ?? action, ...ids.map((id) => name(things, id))].join(" ");
}

export const written = (action, ids, things) =>
  [`[${action}]`, ...ids.map((id) => `<${things.get(id).className}> (1.${id})`)].join(" ");

const READ = /<([^>]+)> \((?:\d+\.)?(\d+)\)/g;

export function retold(instruction) {
  const action = /\[(\w+)\]/.exec(instruction)?.[1] ?? "";
  const names = [...instruction.matchAll(READ)].map((found) => found[1].replaceAll("_", " "));
  if (action in PUTS) return `put ${names[0]} ${PUTS[action]} ${names[1]}`;
  return [(VERBS[action] ?? action).toLowerCase(), ...names].join(" ");
}

// What a refusal means to who plays; what the engine says of an act comes in words.
const REFUSED = {
  OUT_OF_ORDER: "That came too late: the game has gone on. Decide again.",
  TIMED_OUT: "The server is busy, and nothing has changed. Try again in a moment.",
  TOO_FAST: "That was too fast. Wait a moment, then go on.",
  DISCONNECTED: "The connection is lost. Trying again …",
  NO_SESSION: "Your session is not known here any more. Open the link of your session again.",
  UNKNOWN_ID: "This game is not there any more.",
  LOCKED: "This game is open in another tab.",
};

export function refused({ code, place, actual }) {
  return REFUSED[code] ?? (place === "act" ? `That can't be done: ${actual}.` : "That did not work. Try again.");
}
