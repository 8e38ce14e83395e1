// The page on which an activity is described: what is written is kept until it is handed in, and its length is said.
import PHRASES from "/phrases.js";

const fields = ["title", "description"].map((id) => document.getElementById(id));
const [title, description] = fields;
const count = document.getElementById("count");
const KEPT = `hearth description ${title.form.dataset.session}`; // another session does not see it

function counted() {
  const most = Number(count.dataset.most);
  const left = most - description.value.length;
  const said = PHRASES.annotate[left < 0 ? "too_long" : "characters"];
  count.textContent = said.replace("{count}", String(Math.abs(left))).replace("{most}", String(most));
  count.className = left < 0 ? "fault" : "small";
}

function keep() {
  const given = fields.map((field) => field.value);
  if (given.some(Boolean)) localStorage.setItem(KEPT, JSON.stringify(given));
  else localStorage.removeItem(KEPT);
}

if (document.getElementById("kept")) localStorage.removeItem(KEPT);
try {
  const given = JSON.parse(localStorage.getItem(KEPT) ?? "[]");
  fields.forEach((field, number) => { if (!field.value && given[number]) field.value = given[number]; });
} catch { localStorage.removeItem(KEPT); }
for (const field of fields) field.addEventListener("input", () => { keep(); counted(); });
title.form.addEventListener("submit", keep);
counted();
