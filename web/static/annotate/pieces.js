// The pieces of which the page of a program is made.
import PHRASES from "/phrases.js";

export const byId = (id) => document.getElementById(id);

export const phrased = (name, values = {}) => PHRASES.annotate[name].replace(/\{(\w+)\}/g, (_, key) => values[key] ?? "");

export function element(name, text, className) {
  const made = document.createElement(name);
  if (text !== undefined && text !== null) made.textContent = text;
  if (className) made.className = className;
  return made;
}

export function mark(each) {
  const shown = element("span", each.remedy ? `${each.message}: ${each.remedy}` : each.message, each.fault ? "fault" : "note");
  shown.dataset.code = each.code;
  return shown;
}

export function tool(text, label, work, disabled) {
  const button = element("button", text, "plain tool");
  button.type = "button";
  button.ariaLabel = label;
  button.disabled = Boolean(disabled);
  button.addEventListener("click", work);
  return button;
}
