// Put into every page of a test: reports each control that the page shows, each that somebody uses, and each button
// that was pressed and changed nothing.
(() => {
  const CONTROLS = "a[href], button, input:not([type=hidden]), select, textarea, summary, video[controls], [role=application][id], #game #plan .piece, #game #plan .room, #game #plan .door";
  const PATIENCE = 4_000; // milliseconds within which a button must have changed something
  const folded = (path) => path.split("?")[0].split("/").map((part) => (/\d/.test(part) || part.length > 20 ? "*" : part)).join("/");
  const words = (text) => text.replace(/[▴▾]/g, "").replace(/[0-9a-f]{12,}|\d+/g, "*").replace(/\s+/g, " ").trim().slice(0, 60);

  function named(control) {
    const { localName: tag, dataset } = control;
    if (control.closest("#plan")) return `plan ${control.classList[0]}`;
    if (control.matches("button.thing")) return "button thing";
    if (control.matches("button.play")) return "button play or pause";
    if (dataset.instruction) return `button ${dataset.instruction.split(" ")[0]}`;
    if (dataset.move !== undefined) return `button ${dataset.move || "Wait"}`;
    if (tag === "a") return `a ${folded(control.getAttribute("href").replace(location.origin, ""))}`;
    if (control.closest(".tools")) return `button step ${control.textContent}`;
    if (["radio", "checkbox"].includes(control.type)) return `input ${words(control.name)}`;
    const of = control.form?.getAttribute("aria-labelledby") ?? "";
    if (control.id) return `${tag} ${words(control.id.replace(/^(room|prop)-.*/, "$1"))}`;
    return `${tag} ${of} ${words(control.textContent)}`.replace("  ", " ");
  }

  function told(control) {
    const inHead = control.matches("a.skip") || control.closest("header.top");
    const page = folded(location.pathname).replace(/\/new$/, "/") // a form that was refused is shown again
      .replace("/review/*/mend", "/task/*/compose"); // the same page, with the program of somebody else
    return { page: inHead ? "every page" : page, control: named(control) };
  }

  const DEVELOPERS = /\b[A-Z]{2,}_[A-Z_]+\b|\b[A-Za-z]+_[a-z_]+\b|\[[A-Z][a-z]+\]|<[a-z_]+> \(/g;
  const read = new Set();
  function readAll() {
    const text = document.querySelector("main")?.innerText ?? "";
    for (const [word] of location.pathname.startsWith("/desk") ? [] : text.matchAll(DEVELOPERS)) {
      if (!read.has(word)) window.hearthRead(folded(location.pathname), word);
      read.add(word);
    }
  }

  const seen = new Set();
  function look() {
    readAll();
    for (const control of document.querySelectorAll(CONTROLS)) {
      const [{ page, control: name }, shown] = [told(control), control.checkVisibility() || control.matches("a.skip")];
      if (!shown || control.disabled || seen.has(`${page} ${name}`)) continue;
      seen.add(`${page} ${name}`);
      window.hearthSaw(page, name);
    }
  }
  window.hearthLook = look;

  let [changes, waits] = [0, 0];
  function begin() {
    new MutationObserver(() => {
      changes += 1;
      clearTimeout(waits);
      waits = setTimeout(look, 100);
    }).observe(document, { subtree: true, childList: true, attributes: true, characterData: true });
    look();
  }
  if (document.readyState === "loading") addEventListener("DOMContentLoaded", begin);
  else begin();

  function used(event) {
    const control = event.target.closest?.(CONTROLS);
    // Playwright chooses an option by events of its own.
    if (!control || control.disabled || !(event.isTrusted || control.localName === "select")) return;
    const { page, control: name } = told(control);
    window.hearthUsed(page, name);
    if (event.type !== "click" || control.localName !== "button") return;
    const before = changes;
    setTimeout(() => { if (changes === before) window.hearthDead(page, name); }, PATIENCE);
  }
  addEventListener("submit", () => { changes += 1; }, { capture: true }); // its answer may take a while
  for (const kind of ["click", "input", "change", "keydown"]) addEventListener(kind, used, { capture: true });
})();
