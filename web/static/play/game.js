// The page of a game: takes the server's messages, shows them, sends what the person decides.
import { Connection } from "./connection.js";
import { FloorPlan } from "./floor_plan.js";
import { Menu } from "./menu.js";
import { ObjectPanels } from "./object_panels.js";
import { State } from "./state.js";
import { name, refused, retold, spoken, written } from "./words.js";

const root = document.getElementById("game");
const state = new State();
const said = document.getElementById("said");
const banner = document.getElementById("banner");
const sure = document.getElementById("sure");
let busy = false; // a decision is on its way
let walking = null; // the thing that one goes all the way to
let view = null; // first person
let again = 0; // how often the same move is still wanted
let [shown, shownAt] = ["", -1]; // what was said last of the other person, and at which tick
let latest = null; // the last message about the game

const choose = (id, from) => state.things.has(id) && state.things.get(id).seen && menu.open(id, state, from);
const menu = new Menu(decide, walk);
const plan = new FloorPlan(document.getElementById("plan"), choose);
const panels = root.dataset.interface === "symbolic" ? new ObjectPanels(choose) : null;

function decide(action, ids = []) {
  walking = null;
  again = 0;
  return send(action, ids);
}

function send(action, ids = []) {
  if (busy || state.over || state.tick < 0 || waits()) return false;
  const act = action ? written(action, ids, state.things) : null;
  busy = connection.send({ type: "act", tick: state.tick, act });
  if (busy) said.textContent = action ? `${spoken(action, ids, state.things)} …` : "Waiting a tick …";
  return busy;
}

// Whether it is for the other of two people to come or to decide; then that is said.
function waits() {
  const decided = state.decided.includes(state.me);
  if (state.other !== "awaited" && !decided) return false;
  said.textContent = decided ? "You have decided. Waiting for the other person …" : "The other person is not here yet.";
  return true;
}

function walk(id) {
  walking = id;
  send("Walktowards", [id]);
}

// The same move a few times, a tick each.
function several(action, times = 1) {
  if (decide(action)) again = times > 1 ? [action, times - 1] : 0;
}

function goOn() {
  if (again) {
    const [action, times] = again;
    again = times > 1 ? [action, times - 1] : 0;
    return send(action);
  }
  if (walking === null) return false;
  const thing = state.things.get(walking);
  const stuck = state.mine?.last?.failure;
  if (state.over || stuck || arrived(thing) || !state.can("Walktowards", [walking])) walking = null;
  else return send("Walktowards", [walking]);
  return false;
}

// One has arrived at a room once one is in it, at a thing once one stands before it and no longer moves.
function arrived(thing) {
  if (thing.group === "rooms" && state.mine.room === thing.id) return true;
  const way = state.trails.get(state.me);
  const [last, before] = [way.at(-1), way.at(-2)];
  const still = before && Math.hypot(last[1] - before[1], last[2] - before[2]) < 0.01;
  return thing.close && Boolean(still);
}

function receive(message) {
  if (message.type === "picture") return view?.picture?.(message.data);
  if (message.type === "picked") return view?.picked?.(message.id);
  busy = false;
  latest = message;
  state.take(message);
  if (message.type === "begin") begin(message);
  plan.update(state);
  panels?.update(state);
  menu.update(state);
  show();
  view?.update?.(state, message);
  goOn();
}

function begin(message) {
  plan.begin(state);
  panels?.begin();
  banner.hidden = true;
  shown = "";
  if (root.dataset.interface !== "symbolic" && view === null) {
    view = {}; // until it has loaded
    const file = root.dataset.interface === "visual" ? "./first_person.js" : "./pictures.js";
    import(file).then(({ FirstPerson }) => {
      view = new FirstPerson(root.dataset.game, document.getElementById("view"), { choose, act: several, save, finish, send: (m) => connection.send(m) });
      view.update(state, latest);
      root.view = view; // for tests
    }).catch((fault) => tell("", `The home can't be shown: ${fault.message}`));
  }
}

function tell(kind, text, ...more) {
  banner.hidden = false;
  banner.className = kind || "note";
  banner.replaceChildren(text, ...more);
}

function show() {
  const left = state.limit - state.tick;
  root.dataset.tick = state.tick;
  document.getElementById("clock").textContent = `Tick ${state.tick} of ${state.limit}; ${left} left. Helper: ${state.helper}.`;
  showTime();
  showGoal();
  showHands();
  for (const button of document.querySelectorAll("[data-move]")) {
    const move = button.dataset.move;
    button.disabled = state.over || state.other === "awaited" || (move !== "" && !state.can(move));
    if (move === "StandUp") button.hidden = !state.can(move);
  }
  document.getElementById("finish").disabled = state.over;
  said.textContent = lastActions();
  if (state.over) showEnd();
  else if (state.port) tell("note", `Connect your program to port ${state.port} of this machine; it shows the token ${state.token}.`);
  else if (state.other) showOther();
}

// Of a game for two: whether the other person is there, said when it changes and until the next tick.
function showOther() {
  if (state.other === shown && state.tick === shownAt) return;
  if (state.other === "awaited") showInvitation();
  else if (state.other === "gone") tell("note", "The other person has left. You can go on: their character waits until they come back.");
  else if (state.other !== shown) tell("good", shown === "gone" ? "The other person is back." : "The other person is here. A tick passes once both of you have decided.");
  else banner.hidden = true;
  [shown, shownAt] = [state.other, state.tick];
}

// The time that is left, where there is a limit; the last minute is also said.
function showTime() {
  if (state.until === null || state.until === undefined || state.over) return;
  const left = Math.max(0, Math.ceil((state.until - performance.now()) / 1000));
  const clock = document.getElementById("time");
  clock.hidden = false;
  clock.textContent = `Time left: ${Math.floor(left / 60)}:${String(left % 60).padStart(2, "0")}`;
  clock.classList.toggle("short", left <= 60);
  if (left === 60) said.textContent = "One minute is left.";
}

function showGoal() {
  if (!state.goal.length) return;
  document.getElementById("goal").replaceChildren(...state.goal.map((each) => {
    const line = document.createElement("li");
    if (!each.wanted) { // all of a kind, of which none was seen
      line.append(`${each.text}: none seen yet`);
      return line;
    }
    line.className = each.count >= each.wanted ? "met" : "";
    const bar = document.createElement("progress");
    Object.assign(bar, { max: each.wanted, value: each.count });
    bar.setAttribute("aria-label", each.text);
    const count = document.createElement("span");
    count.className = "count";
    count.textContent = `${each.count}/${each.wanted}`;
    line.append(`${each.text}: `, count, " ", bar);
    return line;
  }));
}

function showHands() {
  const lines = state.agents.map((agent) => {
    const line = document.createElement("li");
    const who = agent.agent === state.me ? "You" : "The other";
    const posture = agent.posture === "standing" ? "" : ` (${agent.posture})`;
    line.className = agent.agent === state.me ? "me" : "other";
    line.append(`${who}${posture}: `);
    for (const id of agent.holding) line.append(agent.agent === state.me ? heldButton(id) : `${name(state.things, id)} `);
    if (!agent.holding.length) line.append("empty");
    return line;
  });
  document.getElementById("hands").replaceChildren(...lines);
}

function heldButton(id) {
  const button = document.createElement("button");
  Object.assign(button, { type: "button", className: "thing close", textContent: name(state.things, id) });
  button.dataset.id = id;
  button.addEventListener("click", () => choose(id));
  return button;
}

function lastActions() {
  if (state.decided.length && state.tick === 0) return whoDecided();
  if (state.tick === 0) return "Choose a thing to see what you can do with it.";
  const lines = state.agents.filter((agent) => agent.last).map((agent) => {
    const who = agent.agent === state.me ? "You" : "The other";
    const failure = agent.last.failure ? `: that failed (${agent.last.failure.message})` : "";
    return `${who}: ${retold(agent.last.instruction)}${failure}.`;
  });
  if (state.decided.length && !state.over) lines.push(whoDecided());
  return lines.join(" ");
}

const whoDecided = () => (state.decided.includes(state.me) ? "You have decided. Waiting for the other person …" : "The other person has decided. It is your turn.");

// Why it is over, in words.
function why() {
  const after = `after ${state.tick} ${state.tick === 1 ? "tick" : "ticks"}`;
  if (state.success) return `Done: the goal is reached ${after}.`;
  if (state.end === "FINISHED") return `${state.ended_by === state.me ? "You" : "The other person"} finished this task ${after}.`;
  if (state.end === "TIMED_OUT" && state.ended_by === 0) return `The time is over, ${after}.`;
  if (state.end) return `The helper could not go on, so this is over ${after}. That is no fault of yours.`;
  return `This is over ${after}: that is as many as there are.`;
}

function showEnd() {
  const text = `${why()} `;
  const studied = !state.go_on.startsWith("/play/"); // whose helper is not to be known
  const episode = studied ? [] : [link(`/play/game/${root.dataset.game}/episode.jsonl`, "The episode"), " · "];
  tell(state.success ? "good" : "note", text, ...episode, link(state.go_on, "Go on"));
}

function showInvitation() {
  if (!state.code) return tell("note", "The other person is not here yet. You begin together.");
  const address = `${location.origin}/play/join/${state.code}`;
  return tell("note", "Two people play this. It begins once the other has come, by this link: ", link(address, address));
}

function link(address, text) {
  const made = document.createElement("a");
  Object.assign(made, { href: address, textContent: text });
  return made;
}

function trouble(fault) {
  busy = false;
  walking = null;
  again = 0;
  if (fault.code === "LOCKED") {
    const button = document.createElement("button");
    Object.assign(button, { type: "button", textContent: "Go on here" });
    button.addEventListener("click", () => connection.takeOver());
    tell("note", "This session is open in another tab. ", button);
  } else said.textContent = refused(fault);
}

const KEYS = { ArrowLeft: "Turnleft", ArrowRight: "Turnright", ArrowUp: "Walkforward" };

document.addEventListener("keydown", (event) => {
  const typing = event.target.closest("input, select, textarea, #view, dialog");
  if (typing || event.ctrlKey || event.altKey || event.metaKey) return;
  if (event.key === ".") decide("");
  else if (event.key in KEYS && state.can(KEYS[event.key])) decide(KEYS[event.key]);
  else return;
  event.preventDefault();
});
for (const button of document.querySelectorAll("[data-move]")) {
  button.addEventListener("click", () => decide(button.dataset.move));
}
document.getElementById("save").addEventListener("click", save);
document.getElementById("finish").addEventListener("click", finish);

function save() {
  const kept = busy ? "Everything but what you just decided is saved." : "Everything up to here is saved. You can close the page and come back.";
  said.textContent = kept;
}

// Asks first: what is finished can't be gone on with.
function finish() {
  if (!state.over && !sure.open) sure.showModal();
}

sure.addEventListener("close", () => {
  if (sure.returnValue === "finish" && !connection.send({ type: "finish" })) trouble({ code: "DISCONNECTED" });
  sure.returnValue = "";
});

setInterval(showTime, 1000);
const connection = new Connection(root.dataset.game, receive, trouble);
