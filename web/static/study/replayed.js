// A run that is judged, in 3D: it is played, or looked at step by step, from wherever one likes.
/* global HEARTH_REPLAY */
const PAUSE = 900; // milliseconds from one step to the next
const byId = (id) => document.getElementById(id);
const [stage, deep, play, back, on] = ["stage", "deep", "play", "back", "on"].map(byId);
let [timer, now, last, replay] = [0, 0, 0, null];

function go(to) {
  now = Math.max(0, Math.min(last, to));
  replay.go(now);
  byId("tick").textContent = `Step ${now} of ${last}`;
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
  if (!answer.ok) throw new Error(`The server answered ${answer.status}.`);
  const { home, run } = await answer.json();
  replay = await HEARTH_REPLAY(deep, home, run);
  if (!replay) throw new Error("This browser has no WebGL.");
  last = run.ticks.length - 1;
  for (const button of [play, back, on]) button.disabled = false;
  go(0);
} catch (error) {
  deep.textContent = `It can't be shown. ${error.message}`;
}
