"use strict";
// The list of programs, with search and sorting. Only visible rows are in the page, so that 30,000 programs open fast.
const HEARTH = (() => {
  const COLUMNS = ["title", "program", "origin", "split", "steps", "homes", "repairs", "failure"];
  const PLACE = [1, 0, 2, 3, 4, 5, 6, 7];
  const NUMBERS = new Set([4, 5, 6]);
  const KEPT = new Set([0, 4, 6]);
  const [PICTURE, LOOKS] = [8, 9];
  const STRIP = 12;
  const state = { all: [], shown: [], text: [], sorted: 1, down: false, height: 36 };
  const at = (id) => document.getElementById(id);

  function element(name, text, kind) {
    const made = document.createElement(name);
    if (text !== undefined && text !== null) made.textContent = text;
    if (kind) made.className = kind;
    return made;
  }

  function kindOf(column) {
    return [NUMBERS.has(PLACE[column]) ? "number" : "", KEPT.has(column) ? "keep" : ""].join(" ").trim();
  }

  function drawHead() {
    at("head").replaceChildren(...COLUMNS.map((name, column) => {
      const cell = element("span", null, kindOf(column));
      const mark = state.sorted === PLACE[column] ? (state.down ? " ▾" : " ▴") : "";
      const button = element("button", name + mark);
      button.type = "button";
      button.dataset.column = name;
      button.onclick = () => {
        state.down = state.sorted === PLACE[column] ? !state.down : NUMBERS.has(PLACE[column]);
        state.sorted = PLACE[column];
        drawHead();
        find();
      };
      cell.append(button);
      return cell;
    }));
  }

  function find() {
    const words = at("search").value.toLowerCase().split(/\s+/).filter(Boolean);
    const found = [];
    const pictured = at("pictured").checked;
    for (let i = 0; i < state.all.length; i += 1) {
      if (pictured && !state.all[i][LOOKS]) continue;
      if (words.every((word) => state.text[i].includes(word))) found.push(state.all[i]);
    }
    const place = state.sorted;
    const sign = state.down ? -1 : 1;
    const compare = NUMBERS.has(place) ? (a, b) => a[place] - b[place]
      : (a, b) => (a[place] < b[place] ? -1 : a[place] > b[place] ? 1 : 0);
    state.shown = found.sort((a, b) => sign * compare(a, b) || (a[0] < b[0] ? -1 : 1));
    at("found").textContent = `${found.length.toLocaleString("en")} of ${state.all.length.toLocaleString("en")}`;
    at("scroll").scrollTop = 0;
    drawRows();
  }

  function drawRows() {
    state.height = matchMedia("(max-width: 42rem)").matches ? 44 : 36;
    const box = at("scroll");
    const first = Math.max(0, Math.floor(box.scrollTop / state.height) - 8);
    const last = Math.min(state.shown.length, first + Math.ceil(box.clientHeight / state.height) + 16);
    at("space").style.height = `${state.shown.length * state.height}px`;
    at("rows").style.top = `${first * state.height}px`;
    at("rows").replaceChildren(...state.shown.slice(first, last).map((row) => {
      const line = element("a", null, "row");
      line.href = `#/program/${encodeURIComponent(row[0])}`;
      line.append(...PLACE.map((place, column) => {
        const cell = element("span", row[place], kindOf(column));
        if (place === 7 && row[7]) cell.classList.add("bad");
        if (column === 0 && row[LOOKS]) cell.prepend(row[PICTURE] ? thumbnail(row) : element("span", "▶", "film"));
        return cell;
      }));
      return line;
    }));
  }

  function thumbnail(row) {
    const picture = element("img", null, "thumb");
    picture.src = row[PICTURE].split("/").map(encodeURIComponent).join("/");
    picture.alt = "";
    picture.loading = "lazy";
    return picture;
  }

  // Pictures of programs spread over the whole list, at the start page's head.
  function drawStrip() {
    const found = state.all.filter((row) => row[PICTURE]);
    const step = Math.max(1, found.length / STRIP);
    at("strip").hidden = !found.length;
    at("strip").replaceChildren(...Array.from({ length: Math.min(STRIP, found.length) }, (_, number) => {
      const row = found[Math.floor(number * step)];
      const link = element("a", null, "look");
      link.href = `#/program/${encodeURIComponent(row[0])}`;
      link.append(thumbnail(row), element("span", row[1]));
      return link;
    }));
    const looks = state.all.filter((row) => row[LOOKS]).length;
    at("pictured").disabled = !looks;
    at("looks").textContent = looks.toLocaleString("en");
  }

  const waiting = new Map();
  function story(id) {
    const number = Math.floor(state.order.get(id) / Number(document.body.dataset.shard));
    if (!waiting.has(number)) {
      waiting.set(number, new Promise((resolve, reject) => {
        const script = element("script");
        script.src = `data/stories-${number}.js`;
        script.onload = () => resolve(new Map(HEARTH.arrived.map((each) => [each.id, each])));
        script.onerror = () => reject(new Error(`data/stories-${number}.js is missing`));
        document.head.append(script);
      }));
    }
    return waiting.get(number).then((stories) => stories.get(id));
  }

  // What a run looks like in 3D: the shapes of its home and its own, by the numbers of their files.
  const shapes = new Map();
  function shape(kind, number) {
    const name = `${kind}-${number}`;
    if (!shapes.has(name)) {
      shapes.set(name, new Promise((resolve, reject) => {
        const script = element("script");
        script.src = `data/${name}.js`;
        script.onload = () => resolve(HEARTH.came.get(name));
        script.onerror = () => reject(new Error(`data/${name}.js is missing`));
        document.head.append(script);
      }));
    }
    return shapes.get(name);
  }

  function show() {
    const hash = location.hash.replace(/^#\/?/, "");
    const [view, id] = hash.startsWith("program/") ? ["page", decodeURIComponent(hash.slice(8))] : [hash || "list", ""];
    for (const section of document.querySelectorAll(".view")) section.hidden = section.id !== view;
    if (view === "list") drawRows();
    if (view === "page") openPage(id);
    else document.title = "Hearth";
    scrollTo(0, 0);
  }

  function openPage(id) {
    const page = at("page");
    document.title = `${id} - Hearth`;
    if (!state.order.has(id)) {
      page.replaceChildren(element("p", `This dataset has no program ${id}.`));
      return;
    }
    page.replaceChildren(element("p", "Opening ...", "quiet"));
    story(id).then((program) => HEARTH.draw(page, program, (other) => state.order.has(other)))
      .catch((error) => page.replaceChildren(element("p", error.message, "bad")));
  }

  return {
    element,
    shape,
    arrived: [],
    came: new Map(),
    places: {},
    played(places) { HEARTH.places = places; },
    replays(kind, number, data) { HEARTH.came.set(`${kind}-${number}`, data); },
    stories(list) { HEARTH.arrived = list; },
    programs(rows) {
      state.all = rows;
      state.text = rows.map((row) => `${row[1]} ${row[0]} ${row[2]} ${row[3]} ${row[7]}`.toLowerCase());
      state.order = new Map(rows.map((row, place) => [row[0], place]));
      drawHead();
      at("search").oninput = find;
      at("pictured").onchange = find;
      drawStrip();
      at("scroll").onscroll = drawRows;
      addEventListener("hashchange", show);
      addEventListener("resize", drawRows);
      show();
      find();
    },
  };
})();
