// The page of a game: takes the server's messages, shows them, sends what the person decides.
import { Connection } from "./connection.js";
import { FloorPlan } from "./floor_plan.js";
import { Menu } from "./menu.js";
import { ObjectPanels } from "./object_panels.js";
import { State } from "./state.js";
import { clockTime, ending, happened, left, name, refused, say, spoken, written } from "./words.js";

const root = document.getElementById("game");
const state = new State();
const said = document.getElementById("said");
const banner = document.getElementById("banner");
const sure = document.getElementById("sure");
const clock = document.getElementById("time");
let busy = false; // a decision is on its way
let walking = null; // the thing that one goes all the way to
let view = null; // first person
let again = 0; // how often the same move is still wanted
let [shown, shownAt] = ["", -1]; // what was said last of the other person, and at which tick
let latest = null; // the last message about the game
let sentAt = -1; // the tick in which one decided last, on this page
let late = false; // one waited in the last tick, because one took too long
let ended = false; // the end was shown

const choose = (id, from) => !state.over && state.things.get(id)?.seen && menu.open(id, state, from);
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
  if (busy) sentAt = state.tick;
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
  if (action && !state.over && !state.can(action)) {
    said.textContent = say(action === "Walkforward" ? "blocked" : "not_now");
    return;
  }
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
  late = Boolean(state.other) && message.type === "tick" && message.tick === state.tick + 1 && sentAt !== state.tick;
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

// What is fixed at the bottom of the window says how high it is, so that the page leaves room for it.
for (const id of ["news", "menu"]) {
  const fixed = document.getElementById(id);
  new ResizeObserver(() => document.documentElement.style.setProperty(`--${id}`, `${fixed.offsetHeight}px`)).observe(fixed);
}

function show() {
  root.dataset.tick = state.tick;
  document.getElementById("clock").textContent = say("clock", { tick: state.tick, limit: state.limit, left: state.limit - state.tick, helper: company() });
  showTime();
  showGoal();
  showHands();
  for (const button of document.querySelectorAll("[data-look]")) {
  button.addEventListener("click", () => view?.lookUp?.(Number(button.dataset.look)));
}
for (const button of document.querySelectorAll("[data-move]")) {
    const move = button.dataset.move;
    button.disabled = state.over || state.other === "awaited" || (move !== "" && !state.can(move));
    if (move === "StandUp") button.hidden = !state.can(move);
  }
  for (const name of ["finish", "save"]) document.getElementById(name).disabled = state.over;
  for (const button of document.querySelectorAll("[data-look]")) button.disabled = state.over;
  said.textContent = lastActions();
  if (state.over) showEnd();
  else if (state.port) tell("note", say("port", { port: state.port, token: state.token }));
  else if (state.other) showOther();
  if (!state.over) showLost();
}

// The company of the player: none, a helper, or another person, who counts from the moment of joining.
function company() {
  if (state.helper !== "person") return say(state.helper === "none" ? "helper_none" : "helper_some");
  if (state.other !== "here") return say(state.other === "gone" ? "helper_left" : "not_here");
  return say(state.me === 0 ? "helper_person" : "helper_you");
}

// Of a game for two: whether the other person is there, said when it changes and until the next tick.
function showOther() {
  if (state.other === shown && state.tick === shownAt) return;
  if (state.other === "awaited") showInvitation();
  else if (state.other === "gone" || state.other !== shown) {
    const news = state.other === "gone" ? "other_left" : shown === "gone" ? "other_back" : "other_here";
    const text = say(news, { seconds: state.patience });
    tell(news === "other_left" ? "note" : "good", text);
    if (state.other !== shown) said.textContent = text;
  } else banner.hidden = true;
  [shown, shownAt] = [state.other, state.tick];
}

// The time that is left, where there is a limit; the last minute is also said.
function showTime() {
  if (state.over) return;
  const limited = state.until !== null && state.until !== undefined;
  const turn = state.decideUntil ? left(state.decideUntil) : null;
  clock.hidden = !limited && turn === null;
  if (clock.hidden) return;
  const all = limited ? left(state.until) : Infinity;
  const lines = [turn === null ? "" : say("decide_within", { time: clockTime(turn) }), limited ? say("left_time", { time: clockTime(all) }) : ""];
  clock.textContent = lines.filter(Boolean).join(" ");
  clock.classList.toggle("short", all <= 60 || turn !== null);
  if (all === 60) said.textContent = say("one_minute");
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
  for (const [agent, held] of state.held) if (!state.agents.some((each) => each.agent === agent)) lines.push(lastHeld(held));
  document.getElementById("hands").replaceChildren(...lines);
}

// What the other held when one saw it last.
function lastHeld(held) {
  const line = document.createElement("li");
  line.className = "other";
  line.textContent = say("held_last", { things: held.map((id) => name(state.things, id)).join(", ") || say("nothing_held") });
  return line;
}

function heldButton(id) {
  const button = document.createElement("button");
  Object.assign(button, { type: "button", className: "thing close", textContent: name(state.things, id), disabled: state.over });
  button.dataset.id = id;
  button.addEventListener("click", () => choose(id));
  return button;
}

function lastActions() {
  if (state.decided.length && state.tick === 0) return whoDecided();
  if (state.tick === 0) return say("begin");
  const lines = state.agents.map((agent) => happened(agent, state, late)).filter(Boolean);
  if (state.decided.length && !state.over) lines.push(whoDecided());
  return lines.join(" ");
}

const whoDecided = () => say(state.decided.includes(state.me) ? "decided" : "your_turn");


const isStudied = () => !state.go_on.startsWith("/play/"); // whose helper is not to be known

// The end is also said in the line at the bottom, and comes into view once.
function showEnd() {
  const text = ending(state);
  const episode = isStudied() ? [] : [" · ", link(`/play/game/${root.dataset.game}/episode.jsonl`, say("episode"))];
  tell(state.success ? "good" : "note", `${text} `, link(state.go_on, say(isStudied() ? "go_on" : "another")), ...episode);
  said.textContent = text;
  clock.hidden = true;
  if (sure.open) sure.close();
  if (ended) return;
  ended = true;
  banner.scrollIntoView({ block: "center" });
  banner.focus({ preventScroll: true });
}

function showInvitation() {
  if (!state.code) return tell("note", `${say("wait_for")} `, ...(isStudied() ? [] : [link("/play/pair", say("wait_again"))]));
  const address = `${location.origin}/play/join/${state.code}`;
  return tell("note", `${say("invite")} `, link(address, address), " ", copying(address));
}

// A button that copies the invitation; where a browser does not allow that, it marks the link to copy by hand.
function copying(address) {
  const button = document.createElement("button");
  Object.assign(button, { type: "button", id: "copy", className: "plain", textContent: say("copy") });
  button.addEventListener("click", () => {
    const marked = () => getSelection().selectAllChildren(banner.querySelector("a"));
    const copied = navigator.clipboard?.writeText(address) ?? Promise.reject(new Error("no clipboard"));
    copied.then(() => { button.textContent = say("copied"); }, () => { marked(); button.textContent = say("marked"); });
  });
  return button;
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
  const typing = event.target.closest("input, select, textarea, dialog");
  if (typing || view?.element || event.ctrlKey || event.altKey || event.metaKey) return; // a view has keys of its own
  if (event.key === ".") decide("");
  else if (event.key in KEYS) several(KEYS[event.key]);
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
