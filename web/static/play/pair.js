// The waiting room: asks again and again whether somebody has come, says how long one has waited, and begins the game.
import PHRASES from "/phrases.js";

const EVERY = 1_500; // milliseconds
const title = document.getElementById("waiting-title");
const nobody = document.getElementById("nobody");
const waited = document.getElementById("waited");

const say = (name, values = {}) => PHRASES.pair[name].replace(/\{(\w+)\}/g, (_, key) => values[key] ?? "");
const clock = (seconds) => `${Math.floor(seconds / 60)}:${String(seconds % 60).padStart(2, "0")}`;

function put(element, text) {
  if (element.textContent !== text) element.textContent = text; // said once, not at every look
}

async function look() {
  try {
    const answer = await fetch("/play/pair/look", { method: "POST", headers: { Accept: "application/json" } });
    if (!answer.ok) throw new Error(answer.status);
    const found = await answer.json();
    if (found.go) {
      put(title, say("found"));
      return location.replace(found.go);
    }
    put(title, say("waiting"));
    put(waited, say("waited", { time: clock(found.waited) }));
    nobody.hidden = found.waited < found.patience;
  } catch {
    put(title, say("lost"));
  }
  return setTimeout(look, EVERY);
}

look();
