// A run on the floor plan: where the character is after each step, and what the step changed.

import { phrased } from "./pieces.js";

const SVG = "http://www.w3.org/2000/svg";
const PAUSE = 900;
let timer = 0;

async function planOf(home) {
  const answer = await fetch(`/annotate/plan/${encodeURIComponent(home)}`);
  const text = (await answer.text()).replace("<svg ", `<svg xmlns="${SVG}" `);
  return document.importNode(new DOMParser().parseFromString(text, "image/svg+xml").documentElement, true);
}

function shape(name, attributes) {
  const made = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  return made;
}

/* global HEARTH_REPLAY */
// Show a run in an element that has a `#plan`, a `#deep` and the buttons `#play`, `#back`, `#on` and `#in-3d`; `inDepth`
// promises the same run in 3D.
export async function player(stage, result, phrase, inDepth) {
  clearInterval(timer);
  timer = 0;
  const plan = await planOf(result.home);
  plan.setAttribute("aria-label", `Floor plan of ${result.home}`);
  const path = shape("polyline", { class: "path", points: "" });
  const person = shape("g", { class: "person" });
  person.append(shape("circle", { r: 0.22 }), shape("line", { x1: 0, y1: 0, x2: 0, y2: -0.42 }));
  plan.append(path, person);
  const list = document.createElement("ol");
  list.className = "ticks";
  const row = (step, said) => { // a step keeps its number in the program
    const line = document.createElement("li");
    line.value = step + 1;
    line.append(phrase(step), document.createElement("br"));
    const small = document.createElement("span");
    small.className = "small";
    small.textContent = said;
    line.append(small);
    return line;
  };
  const lines = result.ticks.map((tick) => row(tick.step, tick.changes));
  const left = result.left.map((step) => row(step, phrased("left_out")));
  list.append(...[...lines, ...left].sort((one, other) => one.value - other.value));
  stage.querySelector("#plan").replaceChildren(plan, list);
  stage.hidden = false;

  const places = [result.start, ...result.ticks.map((tick) => tick.at)];
  let now = 0;
  let replay = null;
  function go(to) {
    now = Math.max(0, Math.min(result.ticks.length, to));
    const at = places[now];
    person.toggleAttribute("hidden", !at);
    if (at) person.setAttribute("transform", `translate(${at[0]} ${-at[1]}) rotate(${at[2]})`);
    path.setAttribute("points", places.slice(0, now + 1).filter(Boolean).map(([x, z]) => `${x},${-z}`).join(" "));
    lines.forEach((line, number) => line.toggleAttribute("aria-current", number === now - 1));
    lines[now - 1]?.scrollIntoView({ block: "nearest" });
    replay?.go(now);
  }
  const play = stage.querySelector("#play");
  function stop() { clearInterval(timer); timer = 0; play.textContent = "Play"; }
  play.onclick = () => {
    if (timer) { stop(); return; }
    if (now === result.ticks.length) go(0);
    play.textContent = "Pause";
    timer = setInterval(() => { go(now + 1); if (now === result.ticks.length) stop(); }, PAUSE);
  };
  const [deep, button] = [stage.querySelector("#deep"), stage.querySelector("#in-3d")];
  deep.replaceChildren();
  button.hidden = false;
  button.disabled = false;
  button.onclick = async () => {
    button.disabled = true;
    deep.textContent = "Drawing …";
    try {
      const found = await inDepth();
      const home = await (await fetch(found.home)).json();
      replay = await HEARTH_REPLAY(deep, home, found.run);
      if (replay) { button.hidden = true; replay.go(now); } else deep.textContent = "This browser has no WebGL.";
    } catch (error) {
      button.disabled = false;
      deep.textContent = `It can't be drawn. ${error.message}`;
    }
  };
  stage.querySelector("#back").onclick = () => { stop(); go(now - 1); };
  stage.querySelector("#on").onclick = () => { stop(); go(now + 1); };
  go(0);
}
