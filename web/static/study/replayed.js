// A run in 3D, for judges and at the desk: it is played, or looked at step by step, from wherever one likes.
import PHRASES from "/phrases.js";

/* global HEARTH_REPLAY */
const PAUSE = 900; // milliseconds from one step to the next
const byId = (id) => document.getElementById(id);
const say = (name, values = {}) => PHRASES.study[name].replace(/\{(\w+)\}/g, (_, key) => values[key] ?? "");
const [stage, deep, play, back, on] = ["stage", "deep", "play", "back", "on"].map(byId);
const scrubber = byId("scrubber"); // at the desk alone, as the rows of ticks
const rows = document.querySelectorAll("tr[data-shown]");
let [timer, now, last, replay] = [0, 0, 0, null];

function go(to) {
  now = Math.max(0, Math.min(last, to));
  replay.go(now);
  if (scrubber) scrubber.value = now;
  for (const row of rows) row.classList.toggle("now", Number(row.dataset.shown) === now);
  byId("tick").textContent = say("step_of", { number: now, total: last });
}

function stop() {
  clearInterval(timer);
  timer = 0;
  play.textContent = play.dataset.play;
}

play.onclick = () => {
  if (timer) { stop(); return; }
  if (now === last) go(0);
  play.textContent = play.dataset.pause;
  timer = setInterval(() => { go(now + 1); if (now === last) stop(); }, PAUSE);
};
back.onclick = () => { stop(); go(now - 1); };
on.onclick = () => { stop(); go(now + 1); };

try {
  const answer = await fetch(stage.dataset.replay);
  if (!answer.ok) throw new Error(PHRASES.refused.other);
  const { home, run } = await answer.json();
  replay = await HEARTH_REPLAY(deep, home, run);
  if (!replay) throw new Error(say("no_3d"));
  last = run.ticks.length - 1;
  for (const button of [play, back, on]) button.disabled = false;
  if (scrubber) {
    Object.assign(scrubber, { disabled: false, max: last });
    scrubber.oninput = () => { stop(); go(Number(scrubber.value)); };
  }
  for (const button of document.querySelectorAll("button[data-go]")) {
    button.disabled = false;
    button.onclick = () => { stop(); go(Number(button.dataset.go)); };
  }
  go(0);
} catch (error) {
  deep.textContent = `${say("not_shown")} ${error.message}`;
}
