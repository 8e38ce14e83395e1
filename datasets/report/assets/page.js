"use strict";
// The page of one program. Everything that came from people is set as text, never as markup.
HEARTH.draw = (() => {
  const SVG = "http://www.w3.org/2000/svg";
  const { element } = HEARTH;
  const PAUSE = 900;
  let timer = 0;

  function card(title, ...inside) {
    const made = element("section", null, "card");
    made.append(element("h3", title), ...inside);
    return made;
  }

  function list(texts) {
    const made = element("ul");
    made.append(...texts.map((text) => element("li", text)));
    return made;
  }

  function shape(name, attributes, text) {
    const made = document.createElementNS(SVG, name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    if (text !== undefined) made.textContent = text;
    return made;
  }

  function graph(data) {
    const size = 420;
    const middle = size / 2;
    const about = "The things of the home and what they are on, in or close to";
    const drawn = shape("svg", { class: "graph", viewBox: `-90 10 ${size + 180} ${size - 20}`, role: "img", "aria-label": about });
    const place = new Map(data.nodes.map(([id], number) => {
      const turn = (2 * Math.PI * number) / data.nodes.length - Math.PI / 2;
      return [id, [middle + 150 * Math.cos(turn), middle + 150 * Math.sin(turn)]];
    }));
    for (const [from, relation, to] of data.edges) {
      const [x, y] = place.get(from);
      const [u, v] = place.get(to);
      drawn.append(shape("line", { x1: x, y1: y, x2: u, y2: v, "stroke-width": relation.startsWith("HOLDS") ? 3 : 1 }));
      drawn.append(shape("text", { class: "label", x: x + (u - x) * 0.4, y: y + (v - y) * 0.4 }, relation));
    }
    for (const [id, name, states] of data.nodes) {
      const [x, y] = place.get(id);
      drawn.append(shape("circle", { cx: x, cy: y, r: 6 }));
      const anchor = x < middle - 20 ? "end" : x > middle + 20 ? "start" : "middle";
      const dx = x < middle - 20 ? -9 : x > middle + 20 ? 9 : 0;
      drawn.append(shape("text", { x: x + dx, y: y + (y < middle ? -9 : 15), "text-anchor": anchor }, `${name} (${id})`));
      if (states.length) {
        drawn.append(shape("text", { class: "label", x: x + dx, y: y + (y < middle ? -20 : 26), "text-anchor": anchor },
          states.join(" ")));
      }
    }
    return drawn;
  }

  function described(failure) {
    const names = failure.names.length ? ` of ${failure.names.join(", ")}` : "";
    const found = failure.actual ? `, found ${failure.actual}` : "";
    return `${failure.code} at step ${failure.tick + 1}: ${failure.action}${names} expects ${failure.expected}${found}`;
  }

  function dialogue(repairs) {
    return repairs.flatMap((repair) => {
      const world = element("p", described(repair.failure), "bubble world");
      const handler = element("p", `${repair.handler}: `, "bubble handler");
      for (const [name, lines] of [["del", repair.removed], ["ins", repair.added]]) {
        for (const line of lines) {
          const change = element(name);
          change.append(element("code", `${name === "del" ? "− " : "+ "}${line}`));
          handler.append(element("br"), change);
        }
      }
      return [world, handler];
    });
  }

  function filmed(film) {
    const video = element("video", null, "frame");
    video.controls = true;
    video.muted = true;
    video.playsInline = true;
    video.preload = "metadata";
    for (const file of [film.file, film.file.replace(/\.webm$/, ".mp4")]) {
      const source = element("source");
      source.src = file.split("/").map(encodeURIComponent).join("/");
      video.append(source);
    }
    return video;
  }

  // Players may round the time to which they were sent down.
  const NEARLY = 0.001;

  function tickAt(film, seconds) {
    return Math.max(0, film.starts.findLastIndex((start) => start <= seconds + NEARLY));
  }

  function startOf(film, tick) {
    return film.starts[tick] ?? 0;
  }

  HEARTH.filming = { tickAt, startOf };

  function player(run, steps) {
    const controls = element("p", null, "controls");
    const button = element("button", "Play");
    button.type = "button";
    button.className = "play";
    const where = element("span", "", "quiet");
    const changes = element("div");
    const picture = element("img", null, "frame");
    picture.alt = "";
    picture.hidden = Boolean(run.film) || !run.frames.length;
    const film = run.film ? filmed(run.film) : null;
    const scene = element("div");
    let replay = null;
    let tick = 0;
    const stop = () => { clearInterval(timer); timer = 0; if (film) film.pause(); button.textContent = "Play"; };
    function draw() {
      const now = new Set(tick ? run.ticks[tick - 1].steps : []);
      steps.forEach((line, number) => line.classList.toggle("now", now.has(number)));
      where.textContent = `after step ${tick} of ${run.ticks.length}`;
      const lines = tick ? run.ticks[tick - 1].changes : [];
      changes.replaceChildren(lines.length ? list(lines) : element("p", tick ? "changes nothing" : "the start", "quiet"));
      const frame = run.frames.filter((each) => each.tick === tick).at(-1);
      if (frame) picture.src = frame.file.split("/").map(encodeURIComponent).join("/");
      if (replay) replay.go(tick);
    }
    function go(to) {
      tick = Math.max(0, Math.min(run.ticks.length, to));
      if (film) film.currentTime = startOf(run.film, tick);
      draw();
    }
    if (film) {
      film.ontimeupdate = () => {
        const shown = Math.min(run.ticks.length, tickAt(run.film, film.currentTime));
        if (shown !== tick) { tick = shown; draw(); }
      };
      film.onplay = () => { button.textContent = "Pause"; };
      film.onpause = () => { button.textContent = "Play"; };
    }
    button.onclick = () => {
      if (film) { if (film.paused) film.play(); else film.pause(); return; }
      if (timer) { stop(); return; }
      button.textContent = "Pause";
      if (tick === run.ticks.length) go(0);
      timer = setInterval(() => { go(tick + 1); if (tick === run.ticks.length) stop(); }, PAUSE);
    };
    const ways = [["‹", -1, "step back"], ["›", 1, "step on"]].map(([text, by, label]) => {
      const way = element("button", text);
      way.type = "button";
      way.ariaLabel = label;
      way.onclick = () => { stop(); go(tick + by); };
      return way;
    });
    controls.append(button, ...ways, where);
    const numbers = HEARTH.places[run.id];
    if (numbers) {
      const deep = element("button", "In 3D");
      deep.type = "button";
      deep.className = "deep";
      deep.onclick = async () => {
        deep.disabled = true;
        try {
          const [home, own] = await Promise.all([HEARTH.shape("home", numbers[0]), HEARTH.shape("replay", numbers[1])]);
          replay = await HEARTH_REPLAY(scene, home, own);
          if (replay) { deep.remove(); replay.go(tick); } else scene.textContent = "This browser has no WebGL.";
        } catch (error) { scene.textContent = error.message; }
      };
      controls.append(deep);
    }
    draw();
    return card("Playing", controls, film ?? picture, scene, changes);
  }

  function runCards(run, steps) {
    const end = run.failure ? element("p", described(run.failure), "bad") : element("p", "runs to its end", "good");
    const about = card(`In ${run.home}`, end, element("h3", "Preconditions"),
      run.conditions.length ? list(run.conditions) : element("p", "none", "quiet"));
    return [about, player(run, steps), card("Before", graph(run.start)), card("After", graph(run.final))];
  }

  return (page, program, known) => {
    clearInterval(timer);
    timer = 0;
    const head = [element("h2", program.title), element("p", program.description),
      element("p", `${program.id}; ${program.origin}, ${program.split}, activity ${program.activity}`, "quiet")];
    if (program.parent && known(program.parent)) {
      const line = element("p", "made from ");
      const link = element("a", program.parent);
      link.href = `#/program/${encodeURIComponent(program.parent)}`;
      line.append(link);
      head.push(line);
    }
    const steps = program.steps.map((text) => element("li", text));
    const lines = element("ol", null, "steps");
    lines.append(...steps);
    const columns = element("div", null, "columns");
    const first = [card("Steps", lines)];
    if (program.repairs.length) first.push(card("Repairs", ...dialogue(program.repairs)));
    const place = element("div", null, "columns");
    const choose = element("select");
    choose.ariaLabel = "home";
    choose.append(...program.runs.map((run, number) => new Option(run.home, number)));
    const open = () => {
      clearInterval(timer);
      timer = 0;
      const run = program.runs[Number(choose.value)];
      if (!run) { columns.replaceChildren(...first, element("p", "It was not run.", "quiet")); return; }
      const [about, played, before, after] = runCards(run, steps);
      const [left, right] = [element("div", null, "side"), element("div", null, "side")];
      left.append(first[0], about);
      right.append(played, ...first.slice(1));
      columns.replaceChildren(left, right);
      place.replaceChildren(before, after);
    };
    choose.onchange = open;
    const label = element("p", "Run in ", "controls");
    label.append(choose);
    page.replaceChildren(...head, label, columns, place);
    const seen = [(run) => run.film, (run) => run.frames.length, (run) => HEARTH.places[run.id]].map((test) => program.runs.findIndex(test));
    const pictured = seen.find((number) => number >= 0);
    if (pictured) choose.value = String(pictured);
    open();
  };
})();
