// The page of a game: takes the server's messages, shows them, sends what the person decides.
import { Connection } from "./connection.js";
import { FloorPlan } from "./floor_plan.js";
import { Menu } from "./menu.js";
import { ObjectPanels } from "./object_panels.js";
import { State } from "./state.js";
import { name, refused, retold, say, spoken, written } from "./words.js";

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
  if (busy) said.textContent = action ? say("acting", { act: spoken(action, ids, state.things) }) : say("waiting");
  return busy;
}

// Whether it is for the other of two people to come or to decide; then that is said.
function waits() {
  const decided = state.decided.includes(state.me);
  if (state.other !== "awaited" && !decided) return false;
  said.textContent = decided ? say("decided") : say("not_here");
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
  if (state.over || stuck || state.at(thing) || !state.can("Walktowards", [walking])) walking = null;
  else return send("Walktowards", [walking]);
  return false;
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
    }).catch(() => tell("fault", say("cannot_show")));
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
  document.getElementById("clock").textContent = say("clock", { tick: state.tick, limit: state.limit, left, helper: say(state.helper === "none" ? "helper_none" : "helper_some") });
  showTime();
  showGoal();
  showHands();
  for (const button of document.querySelectorAll("[data-move]")) {
    const move = button.dataset.move;
    button.disabled = state.over || state.other === "awaited" || (move !== "" && !state.can(move));
    if (move === "StandUp") button.hidden = !state.can(move);
  }
  for (const name of ["finish", "save"]) document.getElementById(name).disabled = state.over;
  said.textContent = lastActions();
  if (state.over) showEnd();
  else if (state.port) tell("note", say("port", { port: state.port, token: state.token }));
  else if (state.other) showOther();
  if (!state.over) showLost();
}

// Of a game for two: whether the other person is there, said when it changes and until the next tick.
function showOther() {
  if (state.other === shown && state.tick === shownAt) return;
  if (state.other === "awaited") showInvitation();
  else if (state.other === "gone") tell("note", say("other_left"));
  else if (state.other !== shown) tell("good", say(shown === "gone" ? "other_back" : "other_here"));
  else banner.hidden = true;
  [shown, shownAt] = [state.other, state.tick];
}

// The time that is left, where there is a limit; the last minute is also said.
function showTime() {
  if (state.until === null || state.until === undefined || state.over) return;
  const left = Math.max(0, Math.ceil((state.until - performance.now()) / 1000));
  const clock = document.getElementById("time");
  clock.hidden = false;
  clock.textContent = say("left_time", { time: `${Math.floor(left / 60)}:${String(left % 60).padStart(2, "0")}` });
  clock.classList.toggle("short", left <= 60);
  if (left === 60) said.textContent = say("one_minute");
}

function showGoal() {
  if (!state.goal.length) return;
  document.getElementById("goal").replaceChildren(...state.goal.map((each) => {
    const line = document.createElement("li");
    if ("holds" in each) return joinedLine(line, each);
    if (!each.wanted) { // all of a kind, of which none was seen
      line.append(say("none_seen", { text: each.text }));
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

// A part of the goal that is not counted: a ban, which is kept or broken, or one that is reached or not.
function joinedLine(line, { text, ban, holds, lost }) {
  line.className = lost ? "lost" : holds && !ban ? "met" : "";
  const now = say(lost ? (ban ? "broken" : "too_late") : ban ? (holds ? "kept" : "not_so") : (holds ? "done" : "not_yet"));
  const mark = document.createElement("span");
  Object.assign(mark, { className: "count", textContent: now });
  line.append(`${text}: `, mark);
  return line;
}

// Once a ban was broken, the goal is out of reach; what one may still do is said as long as the game goes on.
function showLost() {
  const broken = state.goal.filter((each) => each.lost);
  if (!broken.length) return false;
  const what = broken.map((each) => `“${each.text}”`).join(" and ");
  tell("fault", say("lost", { what }));
  return true;
}

function showHands() {
  const lines = state.agents.map((agent) => {
    const line = document.createElement("li");
    const who = say(agent.agent === state.me ? "you" : "the_other");
    const posture = agent.posture === "standing" ? "" : ` (${agent.posture})`;
    line.className = agent.agent === state.me ? "me" : "other";
    line.append(`${who}${posture}: `);
    for (const id of agent.holding) line.append(agent.agent === state.me ? heldButton(id) : `${name(state.things, id)} `);
    if (!agent.holding.length) line.append(say("empty"));
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
  if (state.tick === 0) return say("begin");
  const lines = state.agents.filter((agent) => agent.last).map((agent) => {
    const who = say(agent.agent === state.me ? "you" : "the_other");
    const failure = agent.last.failure;
    return say(failure ? "failed" : "did", { who, act: retold(agent.last.instruction, state.things), why: failure?.words });
  });
  if (state.decided.length && !state.over) lines.push(whoDecided());
  return lines.join(" ");
}

const whoDecided = () => say(state.decided.includes(state.me) ? "decided" : "your_turn");

function ending() {
  if (state.success) return "reached";
  if (state.goal.some((each) => each.lost)) return "lost";
  if (state.end === "FINISHED") return state.ended_by === state.me ? "you" : "other";
  if (state.end === "TIMED_OUT" && state.ended_by === 0) return "time";
  return state.end ? "helper" : "ticks";
}

// Why it is over, in words.
function why() {
  const after = say(state.tick === 1 ? "after_one" : "after", { tick: state.tick });
  return say(`end_${ending()}`, { after });
}

const isStudied = () => !state.go_on.startsWith("/play/"); // whose helper is not to be known

function showEnd() {
  const text = `${why()} `;
  const episode = isStudied() ? [] : [link(`/play/game/${root.dataset.game}/episode.jsonl`, say("episode")), " · "];
  tell(state.success ? "good" : "note", text, ...episode, link(state.go_on, say("go_on")));
}

function showInvitation() {
  if (!state.code) return tell("note", `${say("wait_for")} `, ...(isStudied() ? [] : [link("/play/pair", say("wait_again"))]));
  const address = `${location.origin}/play/join/${state.code}`;
  return tell("note", `${say("invite")} `, link(address, address));
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
    Object.assign(button, { type: "button", textContent: say("here") });
    button.addEventListener("click", () => connection.takeOver());
    tell("note", `${say("other_tab")} `, button);
  } else said.textContent = refused(fault);
  view?.trouble?.(fault);
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
  said.textContent = say(busy ? "saving" : "saved");
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
