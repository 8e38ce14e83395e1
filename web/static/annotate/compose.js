// The page on which a program is written: one list of steps, shown as blocks and as a list with a form.
import PHRASES from "/phrases.js";
import { mount } from "./blocks.js";
import { byId, element, mark, phrased, tool } from "./pieces.js";
import { player } from "./player.js";

const [SAVE_AFTER, AGAIN] = [250, 1000];
const composer = byId("composer");
const base = composer.dataset.base;

const model = { version: 0, steps: [], actions: new Map(), things: [], found: [] };
let blocks = null;
let timer = 0;
let again = AGAIN; // milliseconds until a save that had no answer is tried again
let saving = Promise.resolve();
let changing = -1; // the number of the step that the form changes, or -1
let fromBlocks = false; // whether the form took that step from the blocks
const past = []; // steps before each change, for Undo
const ahead = []; // steps that were undone, for Redo

async function ask(path, body) {
  const options = body === undefined ? {} : {
    method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(body),
  };
  const answer = await fetch(base + path, options);
  const value = await answer.json();
  if (!answer.ok) {
    const { code } = value.error;
    throw Object.assign(new Error(value.words ?? PHRASES.refused[code] ?? PHRASES.refused.other), { value, code });
  }
  return value;
}

const words = (ref) => {
  const thing = ref && model.things.find((each) => each.name === ref[0] && each.instance === ref[1]);
  return thing ? thing.words : "…";
};

function phrase(step) {
  if ("special" in step) return `Special: ${step.special || "…"}`;
  return model.actions.get(step.action).words.replace(/\{(\d)\}/g, (_, slot) => words(step.things[Number(slot)]));
}

const fitting = (slot) => model.things.filter((thing) => thing.fits.includes(slot));

function say(text, bad) {
  byId("state").textContent = text;
  byId("state").className = bad ? "fault" : "small";
}

// ------------------------------------------------------------------ changes

function changed(steps, from) {
  if (from !== "undo") {
    past.push(model.steps);
    ahead.length = 0;
  }
  model.steps = steps;
  model.found = [];
  forgotten();
  leaveStep();
  draw();
  if (blocks && from !== "blocks") blocks.show(steps);
  clearTimeout(timer);
  say(phrased("saving"));
  timer = setTimeout(save, SAVE_AFTER);
}

// What was said about the program as it was.
function forgotten() {
  byId("undo").disabled = !past.length;
  byId("redo").disabled = !ahead.length;
  byId("refused").replaceChildren();
  byId("sure-row").hidden = true;
  byId("result").replaceChildren();
  byId("stage").hidden = true;
}

function back(from, to) {
  if (!from.length) return;
  to.push(model.steps);
  changed(from.pop(), "undo");
}

function keys(event) {
  const inText = event.target.closest("input, textarea, #blocks"); // these have an undo of their own
  if (inText || !(event.ctrlKey || event.metaKey) || event.key.toLowerCase() !== "z") return;
  event.preventDefault();
  if (event.shiftKey) back(ahead, past);
  else back(past, ahead);
}

// What the server refuses now and not later.
const LATER = ["TOO_FAST", "TIMED_OUT"];

function save() {
  clearTimeout(timer);
  timer = 0;
  saving = saving.then(async () => {
    const steps = model.steps;
    try {
      const { version, found } = await ask("/save", { version: model.version, steps });
      model.version = version;
      again = AGAIN;
      if (steps === model.steps) checked(found);
    } catch (error) {
      if (error.code === "LOCKED") await otherTab().catch(() => later());
      else if (error.code && !LATER.includes(error.code)) say(phrased("not_saved", { why: error.message }), true);
      else later();
    }
  });
  return saving;
}

// No answer, or too many questions: what is written stays here, and is saved as soon as that is possible.
function later() {
  say(phrased("no_answer"), true);
  clearTimeout(timer);
  timer = setTimeout(save, again);
  again = Math.min(2 * again, 30_000);
}

// Another tab has saved since: one chooses, and nothing is lost before.
async function otherTab() {
  const { version, steps, changes } = await ask("/work");
  if (!changes) {
    say(phrased("gone"), true);
    return;
  }
  say(phrased("other_tab"), true);
  const mine = tool(phrased("keep_mine"), phrased("keep_mine"), () => {
    model.version = version;
    save();
  });
  const other = tool(phrased("take_other"), phrased("take_other"), () => {
    model.version = version;
    changed(steps, "other tab");
  });
  byId("state").append(mine, " ", other);
}

const kept = () => phrased(composer.dataset.mode === "mend" ? "checked" : "saved");

function checked(found) {
  model.found = found;
  const faults = found.filter((each) => each.fault).length;
  say(`${kept()} ${faults ? phrased("faults", { count: faults }) : phrased("ready")}`);
  draw();
  if (blocks) blocks.mark(found);
}

// ------------------------------------------------------------------ the list

function moved(from, to) {
  const steps = [...model.steps];
  steps.splice(to, 0, ...steps.splice(from, 1));
  changed(steps, "list");
  focusOn(to, from < to ? 1 : 0);
}

function removed(number) {
  changed(model.steps.filter((_, other) => other !== number), "list");
  if (model.steps.length) focusOn(Math.min(number, model.steps.length - 1), -1);
  else byId("action").focus();
}

function focusOn(number, which) {
  const tools = byId("steps").children[number].querySelectorAll("button");
  const wanted = which < 0 ? tools[tools.length - 1] : tools[which];
  (wanted.disabled ? tools[1 - which] ?? wanted : wanted).focus();
}

function row(step, number) {
  const line = element("li");
  const text = phrase(step);
  line.append(element("span", text, "words"));
  const tools = element("span", null, "tools");
  tools.append(
    tool("↑", `Move step ${number + 1} up: ${text}`, () => moved(number, number - 1), number === 0),
    tool("↓", `Move step ${number + 1} down: ${text}`, () => moved(number, number + 1), number === model.steps.length - 1),
    ...("special" in step ? [] : [tool("✎", phrased("change_step", { number: number + 1, step: text }), () => changeStep(number))]),
    tool("×", `Take step ${number + 1} out: ${text}`, () => removed(number)),
  );
  line.append(tools, ...model.found.filter((each) => each.step === number).map(mark));
  line.classList.toggle("faulty", model.found.some((each) => each.step === number && each.fault));
  return line;
}

function draw() {
  const focused = document.activeElement?.getAttribute("aria-label");
  byId("steps").replaceChildren(...model.steps.map(row));
  byId("empty").hidden = model.steps.length > 0;
  byId("whole").replaceChildren(...model.found.filter((each) => each.step < 0).map((each) => {
    const line = element("p");
    line.append(mark(each));
    return line;
  }));
  if (focused) document.querySelector(`#steps [aria-label="${CSS.escape(focused)}"]`)?.focus();
}

// ------------------------------------------------------------------ the form

function fillActions() {
  const drawers = new Map();
  const cannot = [];
  for (const action of model.actions.values()) {
    const possible = action.slots.every((slot) => fitting(slot).length) && distinct(action);
    if (!possible) {
      if (action.runs) cannot.push(action.words.replace(/\s*\{\d\}/g, " …"));
      continue;
    }
    if (!drawers.has(action.drawer)) drawers.set(action.drawer, element("optgroup"));
    const option = element("option", action.words.replace(/\{\d\}/g, "…") + (action.runs ? "" : ` ${phrased("cannot_run")}`));
    option.value = action.name;
    drawers.get(action.drawer).append(option);
  }
  for (const [name, group] of drawers) group.label = name;
  byId("action").replaceChildren(...drawers.values());
  byId("cannot").textContent = cannot.length
    ? phrased("cannot", { acts: cannot.join(", ") }) : "";
  fillSlots();
}

// Two slots need two things.
function distinct(action) {
  return new Set(action.slots.flatMap((slot) => fitting(slot))).size >= action.slots.length;
}

// “Put … in …”, with the slot that is meant.
function slotLabel(action, number) {
  return action.words.replace(/\{(\d)\}/g, (_, slot) => (Number(slot) === number ? "▢" : "…"));
}

function fillSlots() {
  const action = model.actions.get(byId("action").value);
  byId("slots").replaceChildren(...(action ? action.slots : []).map((slot, number) => {
    const line = element("p");
    const label = element("label", slotLabel(action, number));
    const select = element("select");
    select.id = `slot-${number}`;
    label.htmlFor = select.id;
    select.replaceChildren(...fitting(slot).map((thing) => {
      const option = element("option", thing.words);
      option.value = JSON.stringify([thing.name, thing.instance]);
      return option;
    }));
    line.append(label, select);
    return line;
  }));
}

function added(event) {
  event.preventDefault();
  const action = byId("action").value;
  if (!action) return;
  const things = [...byId("slots").querySelectorAll("select")].map((select) => JSON.parse(select.value));
  if (new Set(things.map(String)).size < things.length) {
    say(phrased("different"), true);
    return;
  }
  const made = { action, things };
  changed(changing < 0 ? [...model.steps, made] : model.steps.map((step, number) => (number === changing ? made : step)), "form");
}

// Take a step into the form, to change it.
function changeStep(number) {
  const { action, things } = model.steps[number];
  if (![...byId("action").options].some((option) => option.value === action)) return; // no thing of the scene fits it now
  fromBlocks = !byId("blocks-view").hidden;
  show("list");
  changing = number;
  byId("action").value = action;
  fillSlots();
  things.forEach((ref, slot) => { if (ref) byId(`slot-${slot}`).value = JSON.stringify(ref); });
  formFor(number);
  byId("action").focus();
}

function leaveStep() {
  if (changing >= 0) formFor(-1);
  if (changing >= 0 && fromBlocks) show("blocks");
  changing = -1;
}

function formFor(number) {
  byId("form-title").textContent = number < 0 ? phrased("new_step") : phrased("changing", { number: number + 1 });
  byId("add-step").querySelector("button").hidden = number >= 0;
  byId("keep-step").hidden = number < 0;
  byId("leave-step").hidden = number < 0;
}

function addedSpecial(event) {
  event.preventDefault();
  const special = byId("special").value.trim();
  if (!special) return;
  byId("special").value = "";
  changed([...model.steps, { special }], "form");
}

// ------------------------------------------------------------------ running and handing in

async function run() {
  await (timer ? save() : saving);
  byId("result").replaceChildren(element("p", phrased("running")));
  byId("stage").hidden = true;
  try {
    const result = await ask("/run", { steps: model.steps, home: byId("home").value });
    const number = result.step + 1;
    const left = result.left.map((step) => step + 1).join(", ");
    const words = result.ran ? phrased(left ? "ran_but" : "ran", { ...result, left })
      : phrased(number ? "stopped_at" : "stopped", { ...result, number });
    byId("result").replaceChildren(element("p", words, result.ran ? "good" : "fault"));
    if (result.added) byId("result").append(element("p", result.added, "note"));
    model.found = model.found.filter((each) => each.code !== "RUN");
    if (!result.ran && number) {
      model.found.push({ step: result.step, fault: true, code: "RUN", message: phrased("stops_here", result), remedy: "" });
      say(`${kept()} ${phrased("run_stopped", { number })}`, true);
    }
    draw();
    if (blocks) blocks.mark(model.found);
    const sent = { steps: model.steps, home: byId("home").value };
    if (result.ticks.length) await player(byId("stage"), result, (number) => phrase(model.steps[number]), () => ask("/replay", sent));
  } catch (error) {
    byId("result").replaceChildren(element("p", phrased("no_run", { why: error.message }), "fault"));
  }
}

async function submit(sure) {
  await (timer ? save() : saving);
  byId("sure-row").hidden = true;
  byId("refused").replaceChildren();
  try {
    const sent = { version: model.version, steps: model.steps, home: byId("home").value, sure };
    const answer = await ask("/submit", sent);
    if (answer.go) location.assign(answer.go);
    else byId("refused").replaceChildren(element("p", answer.ask, "note"));
    byId("sure-row").hidden = Boolean(answer.go);
  } catch (error) {
    byId("refused").replaceChildren(element("p", phrased("no_hand_in", { why: error.message }), "fault"));
    if (error.value?.found) checked(error.value.found);
  }
}

// ------------------------------------------------------------------ beginning

function show(view) {
  const inBlocks = view === "blocks";
  byId("blocks-view").hidden = !inBlocks;
  byId("form-view").hidden = inBlocks;
  byId("show-blocks").ariaPressed = String(inBlocks);
  byId("show-list").ariaPressed = String(!inBlocks);
  if (inBlocks && !blocks) {
    blocks = mount(byId("blocks"), model, (steps) => changed(steps, "blocks"), (count) => {
      byId("loose").textContent = count ? `Blocks that hang on nothing and are not part of the program: ${count}.` : "";
    });
    blocks.show(model.steps);
    blocks.mark(model.found);
  }
  if (inBlocks) blocks.fit();
}

async function begin() {
  const work = await ask("/work");
  model.version = work.version;
  model.things = work.things;
  model.actions = new Map(work.actions.map((action) => [action.name, action]));
  model.steps = work.steps;
  fillActions();
  draw();
  byId("action").addEventListener("change", fillSlots);
  byId("add-step").addEventListener("submit", added);
  byId("add-special").addEventListener("submit", addedSpecial);
  byId("run").addEventListener("click", run);
  byId("submit").addEventListener("click", () => submit(false));
  byId("sure").addEventListener("click", () => submit(true));
  byId("undo").addEventListener("click", () => back(past, ahead));
  byId("redo").addEventListener("click", () => back(ahead, past));
  byId("keep-step").addEventListener("click", added);
  byId("leave-step").addEventListener("click", leaveStep);
  document.addEventListener("keydown", keys);
  byId("show-blocks").addEventListener("click", () => show("blocks"));
  byId("show-list").addEventListener("click", () => show("list"));
  if (!window.Blockly) {
    byId("show-blocks").disabled = true;
    byId("show-blocks").textContent = "Blocks (not installed here)";
  } else if (innerWidth >= 700) {
    show("blocks");
  }
  if (model.steps.length) save();
  else say("Add the first step.");
}

begin().catch((error) => say(`The page could not be set up. ${error.message}`, true));
