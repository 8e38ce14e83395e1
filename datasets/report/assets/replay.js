"use strict";
// Plays an execution in 3D, from above, by WebGL alone: `HEARTH_REPLAY(place, home, run)` of what rendering/film/replay_3d.py
// gives. Drag or use the arrow keys to turn, the wheel or + and - to come closer. Who acts stays in the middle.
// eslint-disable-next-line no-unused-vars
const HEARTH_REPLAY = (() => {
  const GLIDE = 600; // milliseconds from one tick to the next
  const CUT = 1.15; // metres above which walls are left out
  const VERTEX = `#version 300 es
    in vec3 position; in vec3 colour; uniform mat4 camera; uniform vec4 place; uniform float unit;
    out vec3 shown; out float height;
    void main() {
      vec3 p = position * unit; float c = cos(place.w), s = sin(place.w);
      vec3 q = vec3(c * p.x + s * p.z, p.y, c * p.z - s * p.x) + place.xyz;
      shown = colour; height = q.y; gl_Position = camera * vec4(q, 1.0);
    }`;
  const FRAGMENT = `#version 300 es
    precision mediump float; in vec3 shown; in float height; uniform float most; out vec4 colour;
    void main() { if (height > most) discard; colour = vec4(shown, 1.0); }`;

  async function unpacked(shapes) {
    const bytes = Uint8Array.from(atob(shapes.data), (letter) => letter.charCodeAt(0));
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
    return new Response(stream).arrayBuffer();
  }

  function compiled(gl) {
    const program = gl.createProgram();
    for (const [kind, text] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, FRAGMENT]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    gl.useProgram(program);
    return program;
  }

  const filled = (gl, kind, data) => {
    const buffer = gl.createBuffer();
    gl.bindBuffer(kind, buffer);
    gl.bufferData(kind, data, gl.STATIC_DRAW);
  };

  // What draws a shape: its arrays on the graphics card, and how many corners its triangles have.
  function uploaded(gl, program, shapes, data, [pattern, positionsAt, lightAt]) {
    const [corners, drawn, indexAt, coloursAt] = shapes.patterns[pattern];
    const [rows, light] = [new Int16Array(data, positionsAt, 3 * corners), new Uint8Array(data, lightAt, corners)];
    const base = new Uint8Array(data, coloursAt, 3 * corners);
    const [positions, colours] = [new Int16Array(4 * corners), new Uint8Array(4 * corners)];
    for (let corner = 0; corner < corners; corner += 1) {
      for (let n = 0; n < 3; n += 1) {
        positions[4 * corner + n] = rows[n * corners + corner];
        colours[4 * corner + n] = Math.min(255, (base[n * corners + corner] * light[corner]) / 200);
      }
    }
    const kept = gl.createVertexArray();
    gl.bindVertexArray(kept);
    for (const [name, array, kind, whole] of [["position", positions, gl.SHORT, false], ["colour", colours, gl.UNSIGNED_BYTE, true]]) {
      filled(gl, gl.ARRAY_BUFFER, array);
      const at = gl.getAttribLocation(program, name);
      gl.enableVertexAttribArray(at);
      gl.vertexAttribPointer(at, 3, kind, whole, array.BYTES_PER_ELEMENT * 4, 0);
    }
    const long = corners > 65536;
    filled(gl, gl.ELEMENT_ARRAY_BUFFER, long ? new Uint32Array(data, indexAt, drawn) : new Uint16Array(data, indexAt, drawn));
    return { kept, drawn, kind: long ? gl.UNSIGNED_INT : gl.UNSIGNED_SHORT };
  }

  const minus = (a, b) => a.map((value, n) => value - b[n]);
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const unit = (a) => a.map((value) => value / Math.hypot(...a));

  // Axes are the home's: x east, y up, z north, so that what is at the right of the plan is at the right here.
  function matrix(eye, target, aspect) {
    const [near, far, zoom] = [0.1, 80, 1 / Math.tan(Math.PI / 8)];
    const ahead = unit(minus(target, eye));
    const right = unit(cross([0, 1, 0], ahead));
    const up = cross(ahead, right);
    const row = (axis, by) => [...axis.map((value) => value * by), -dot(axis, eye) * by];
    const [x, y, z] = [row(right, zoom / aspect), row(up, zoom), row(ahead, 1)];
    const [a, b] = [(far + near) / (far - near), (-2 * far * near) / (far - near)];
    return new Float32Array([0, 1, 2, 3].flatMap((n) => [x[n], y[n], a * z[n] + (n === 3 ? b : 0), z[n]]));
  }

  const between = (a, b, share) => a + (b - a) * share;
  const turned = (a, b, share) => a + (((b - a + 540) % 360) - 180) * share;

  class Replay {
    constructor(canvas, gl, home, run) {
      Object.assign(this, { canvas, gl, home, run, now: 0, before: 0, since: -GLIDE, turn: -25, tilt: 50, far: 8.5 });
      this.program = compiled(gl);
      this.at = Object.fromEntries(["camera", "place", "unit", "most"].map((name) => [name, gl.getUniformLocation(this.program, name)]));
      gl.enable(gl.DEPTH_TEST);
      this.listen();
    }

    async fill() {
      const { gl, program } = this;
      const [homes, runs] = await Promise.all([unpacked(this.home.shapes), unpacked(this.run.shapes)]);
      this.fixed = this.home.shapes.shapes.map((shape) => uploaded(gl, program, this.home.shapes, homes, shape));
      this.other = this.run.shapes.shapes.map((shape) => uploaded(gl, program, this.run.shapes, runs, shape));
      this.draw();
      this.canvas.dataset.ready = "yes";
    }

    listen() {
      const { canvas } = this;
      canvas.addEventListener("pointermove", (event) => {
        if (event.buttons & 1) this.look(event.movementX * 0.4, event.movementY * 0.3, 1);
      });
      canvas.addEventListener("wheel", (event) => {
        event.preventDefault();
        this.look(0, 0, event.deltaY > 0 ? 1.1 : 0.9);
      }, { passive: false });
      const keys = { ArrowLeft: [-10, 0, 1], ArrowRight: [10, 0, 1], ArrowUp: [0, 6, 1], ArrowDown: [0, -6, 1], "+": [0, 0, 0.85], "-": [0, 0, 1.18] };
      canvas.addEventListener("keydown", (event) => {
        if (!(event.key in keys)) return;
        event.preventDefault();
        this.look(...keys[event.key]);
      });
      new ResizeObserver(() => this.ask()).observe(canvas);
    }

    look(turn, tilt, far) {
      this.turn += turn;
      this.tilt = Math.max(12, Math.min(88, this.tilt + tilt));
      this.far = Math.max(2.5, Math.min(30, this.far * far));
      this.ask();
    }

    // Shows a tick, gliding there from the one before it.
    go(tick) {
      this.before = Math.abs(tick - this.now) === 1 ? this.now : tick;
      this.now = tick;
      this.since = performance.now();
      this.canvas.dataset.tick = tick;
      this.ask();
    }

    ask() {
      if (this.asked) return;
      this.asked = true;
      requestAnimationFrame(() => { this.asked = false; this.draw(); });
    }

    draw() {
      if (!this.fixed) return;
      const { gl, canvas, at } = this;
      const share = Math.min(1, (performance.now() - this.since) / GLIDE);
      const [last, tick] = [this.run.ticks[this.before], this.run.ticks[this.now]];
      const sharp = Math.min(devicePixelRatio, 2);
      [canvas.width, canvas.height] = [canvas.clientWidth * sharp, canvas.clientHeight * sharp].map(Math.round);
      gl.viewport(0, 0, canvas.width, canvas.height);
      gl.clearColor(0.8, 0.82, 0.84, 1);
      gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
      const target = tick.at.map((value, n) => between(last.at[n], value, share) + (n === 1 ? 0.8 : 0));
      const [turn, tilt] = [this.turn, this.tilt].map((angle) => (angle * Math.PI) / 180);
      const flat = this.far * Math.cos(tilt);
      const eye = [target[0] - flat * Math.sin(turn), target[1] + this.far * Math.sin(tilt), target[2] - flat * Math.cos(turn)];
      gl.uniformMatrix4fv(at.camera, false, matrix(eye, target, canvas.width / Math.max(1, canvas.height)));
      const off = new Set(tick.off);
      gl.uniform1f(at.unit, this.home.shapes.unit);
      this.home.things.forEach(([shape, x, y, z, yaw, building], number) => {
        if (!off.has(number)) this.thing(this.fixed[shape], [x, y, z], yaw, building ? CUT : 100);
      });
      gl.uniform1f(at.unit, this.run.shapes.unit);
      const from = new Map(last.on.map((row) => [row[5], row]));
      for (const row of tick.on) {
        const old = from.get(row[5]) ?? row;
        const where = [1, 2, 3].map((n) => between(old[n], row[n], share));
        this.thing(this.other[row[0]], where, turned(old[4], row[4], share), 100);
      }
      if (share < 1) this.ask();
    }

    thing({ kept, drawn, kind }, where, yaw, most) {
      const { gl, at } = this;
      gl.uniform1f(at.most, most);
      gl.uniform4f(at.place, ...where, (yaw * Math.PI) / 180);
      gl.bindVertexArray(kept);
      gl.drawElements(gl.TRIANGLES, drawn, kind, 0);
    }
  }

  // A player in an element: a promise of what has `go(tick)`; null where the browser has no WebGL.
  return async (place, home, run) => {
    const canvas = document.createElement("canvas");
    canvas.className = "replay";
    canvas.tabIndex = 0;
    canvas.setAttribute("role", "img");
    canvas.ariaLabel = "The run in 3D; arrow keys turn the view, plus and minus come closer and go away";
    const gl = canvas.getContext("webgl2", { antialias: true });
    if (!gl) return null;
    place.replaceChildren(canvas);
    const made = new Replay(canvas, gl, home, run);
    await made.fill();
    return made;
  };
})();
