// First person in 3D (figure C-8): the home is drawn here, the server says what is different after each tick.
import * as THREE from "/fetched/three/build/three.module.js";
import { NUMBERED, SHOWN, around, hide, inPicture, load, merged, model, seenFrom } from "./home_meshes.js";
import { viewKeys } from "./view_keys.js";
import { say, titled } from "./words.js";

const [WIDTH, HEIGHT] = [640, 480];
const GLIDE = 220; // milliseconds from one tick's eyes to the next
const SKY = 0xbfd4e6;

export class FirstPerson {
  constructor(game, element, { choose, send, act, save, finish }) {
    Object.assign(this, { game, element, choose });
    this.renderer = new THREE.WebGLRenderer({ antialias: false, powerPreference: "high-performance" });
    const fine = this.isSoftware() ? 1 : 2;
    this.renderer.setPixelRatio(fine);
    this.renderer.setSize(WIDTH, HEIGHT, false);
    this.renderer.outputColorSpace = THREE.LinearSRGBColorSpace; // colours are baked in sRGB
    this.scene = new THREE.Scene();
    this.scene.background = new THREE.Color().setHex(SKY, THREE.LinearSRGBColorSpace);
    this.world = new THREE.Group();
    this.world.scale.x = -1; // the home's axes are left-handed
    this.scene.add(this.world);
    this.world.updateMatrixWorld();
    this.camera = new THREE.PerspectiveCamera(82, WIDTH / HEIGHT, 0.02, 60);
    this.pixel = new THREE.WebGLRenderTarget(1, 1);
    this.models = new Map();
    this.placed = new Map();
    this.look = { pitch: 0, yaw: 0 };
    this.turned = 0;
    this.frames = 0;
    this.arrived = false; // the picture shows what one sees from where one stands now
    this.seen = { width: WIDTH / 8, height: HEIGHT / 8 };
    this.small = new THREE.WebGLRenderTarget(this.seen.width, this.seen.height);
    this.build();
    viewKeys(this, { act, save, finish });
    this.renderer.setAnimationLoop((time) => this.frame(time));
  }

  isSoftware() {
    const gl = this.renderer.getContext();
    const known = gl.getExtension("WEBGL_debug_renderer_info");
    return known !== null && /swiftshader|llvmpipe|software/i.test(gl.getParameter(known.UNMASKED_RENDERER_WEBGL));
  }

  build() {
    this.label = document.createElement("div");
    this.label.className = "label";
    this.label.textContent = say("loading");
    this.renderer.domElement.setAttribute("aria-hidden", "true");
    this.frameOf = document.createElement("div");
    Object.assign(this.frameOf, { className: "mark", hidden: true });
    this.element.replaceChildren(this.renderer.domElement, this.frameOf, this.label);
    const at = (event) => {
      const box = this.renderer.domElement.getBoundingClientRect();
      return [Math.floor((event.clientX - box.left) / box.width * WIDTH), Math.floor((event.clientY - box.top) / box.height * HEIGHT)];
    };
    let from = null;
    this.element.addEventListener("pointerdown", (event) => { from = [event.clientX, event.clientY, this.look.yaw, this.look.pitch, false]; });
    this.element.addEventListener("pointermove", (event) => {
      if (from && (event.buttons & 1)) this.drag(event, from);
      else this.point(...at(event));
    });
    this.element.addEventListener("pointerup", (event) => {
      if (from && !from[4]) this.click(this.pick(...at(event)));
      from = null;
    });
  }

  drag(event, from) {
    const [x, y, yaw, pitch] = from;
    if (Math.hypot(event.clientX - x, event.clientY - y) > 4) from[4] = true;
    this.look = { yaw: yaw - (event.clientX - x) * 0.2, pitch: Math.max(-75, Math.min(75, pitch + (event.clientY - y) * 0.2)) };
    this.lookAnew();
  }

  // One looks elsewhere: the picture is drawn anew, and what was marked in it is not any more.
  lookAnew() {
    this.frameOf.hidden = true;
    this.moved = true;
  }

  click(id) {
    if (id) this.choose(id, this.element);
  }

  point(x, y) {
    if (this.hovering) return;
    this.hovering = true;
    requestAnimationFrame(() => {
      this.hovering = false;
      this.show(this.pick(x, y));
    });
  }

  show(id) {
    this.label.hidden = !id;
    if (id && this.state) this.label.textContent = this.state.things.has(id) ? titled(this.state, id) : this.names.get(id) ?? "";
  }

  // Draws what is wanted last; what comes meanwhile waits, and only the last of it is drawn.
  async update(state, message) {
    this.state = state;
    if (!message.drawn) return;
    this.wanted = { tick: state.tick, ...message.drawn };
    if (this.drawing) return;
    this.drawing = true;
    try {
      while (this.wanted) {
        const drawn = this.wanted;
        this.wanted = null;
        await this.draw(drawn);
      }
    } catch (fault) {
      this.say(say("cannot_show"));
      console.warn(fault.message);
    } finally {
      this.drawing = false;
    }
  }

  say(text) {
    this.label.textContent = text;
    this.label.hidden = !text;
  }

  async draw(drawn) {
    if (!this.parts) {
      const rooms = this.state.plan.filter(([kind]) => kind === "room").map(([, , box]) => box);
      const { meshes, walls } = merged(await load(drawn.base), rooms);
      Object.assign(this, { parts: meshes, walls });
      for (const mesh of meshes) this.world.add(mesh);
      this.element.dataset.ready = "yes";
      this.say("");
    }
    const off = new Set(drawn.off);
    for (const mesh of this.parts) hide(mesh, off);
    await this.place(drawn.on);
    this.glide(drawn.camera);
    this.element.dataset.tick = drawn.tick;
  }

  async place(every) {
    const shapes = await Promise.all(every.map((each) => this.fetched(each[2], each[0])));
    const on = every.filter((each, number) => shapes[number]); // what did not come is asked for again with the next tick
    const now = new Map(on.map((each) => [`${each[0]} ${each[2]} ${each[1]}`, each]));
    const shape = new Map(every.map((each, number) => [each, shapes[number]]));
    for (const [key, meshes] of this.placed) {
      if (!now.has(key)) {
        this.world.remove(...meshes);
        this.placed.delete(key);
      }
    }
    for (const [key, each] of now) {
      const [id, , , x, y, z, yaw] = each;
      if (!this.placed.has(key)) {
        this.placed.set(key, shape.get(each).map((part) => new THREE.Mesh(part, SHOWN)));
        for (const mesh of this.placed.get(key)) mesh.userData.thing = id;
      }
      for (const mesh of this.placed.get(key)) {
        mesh.position.set(x, y, z);
        mesh.rotation.y = THREE.MathUtils.degToRad(yaw + (this.state.mine?.holding.includes(id) ? this.turned : 0));
        around(mesh);
        this.world.add(mesh);
      }
    }
    this.standing = "";
    this.names = new Map(on.map((each) => [each[0], each[1].replaceAll("_", " ")]));
    this.moved = true;
  }

  // A promise of the shapes of a thing; of null where they can't be had now.
  fetched(kind, id) {
    const key = `${kind} ${id}`;
    if (!this.models.has(key)) {
      const coming = load(`/play/game/${this.game}/models/${kind}.glb`).then((scene) => model(scene, id));
      this.models.set(key, coming.catch(() => {
        this.models.delete(key);
        return null;
      }));
    }
    return this.models.get(key);
  }

  glide({ eye, target, fov }) {
    const to = { eye: new THREE.Vector3(-eye[0], eye[1], eye[2]), target: new THREE.Vector3(-target[0], target[1], target[2]) };
    to.way = to.target.clone().sub(to.eye).normalize();
    this.from = this.to ? this.now() : to;
    this.to = to;
    this.since = performance.now();
    this.look.yaw = 0;
    this.arrived = false;
    if (this.camera.fov !== fov) {
      this.camera.fov = fov;
      this.camera.updateProjectionMatrix();
    }
    this.lookAnew();
  }

  // How far the eyes are on their way to where the character stands, 0 to 1.
  get share() {
    return Math.min(1, (performance.now() - this.since) / GLIDE);
  }

  now() {
    const { share } = this;
    const way = this.from.way.clone().lerp(this.to.way, share).normalize();
    return { eye: this.from.eye.clone().lerp(this.to.eye, share), way };
  }

  aim() {
    const { eye, way } = this.now();
    const [yaw, pitch] = [Math.atan2(way.x, way.z) + THREE.MathUtils.degToRad(this.look.yaw), Math.asin(way.y) + THREE.MathUtils.degToRad(this.look.pitch)];
    const high = Math.max(-1.5, Math.min(1.5, pitch));
    this.camera.position.copy(eye);
    this.camera.lookAt(eye.x + Math.sin(yaw) * Math.cos(high), eye.y + Math.sin(high), eye.z + Math.cos(yaw) * Math.cos(high));
    this.camera.updateMatrixWorld();
    this.leaveOut(-eye.x, eye.z);
  }

  // Draws only the parts of the home at which one looks: not what is behind walls, and not what is beside the picture.
  leaveOut(x, z) {
    const place = `${x.toFixed(2)} ${z.toFixed(2)}`;
    if (place !== this.standing) this.stand(x, z);
    this.standing = place;
    const shown = this.camera.projectionMatrix.clone().multiply(this.camera.matrixWorldInverse).multiply(this.world.matrixWorld);
    // One's own body is ahead of eyes that are still on their way: they would see its back.
    const own = this.share < 1 ? this.state.mine?.node : undefined;
    for (const mesh of this.drawn) {
      mesh.visible = mesh.userData.seen && (own === undefined || mesh.userData.thing !== own) && inPicture(mesh.userData.box, shown);
    }
  }

  stand(x, z) {
    this.drawn = [...this.parts, ...[...this.placed.values()].flat()];
    const seen = seenFrom(x, z, this.walls, this.drawn.map(({ userData: { box } }) => [box.min.x, box.min.z, box.max.x, box.max.z]));
    this.drawn.forEach((mesh, number) => {
      const { box, room } = mesh.userData;
      mesh.userData.seen = seen[number];
      // What is near is drawn first, so that what it hides costs nothing; walls stand behind everything.
      mesh.renderOrder = room < 0 ? 1000 : Math.hypot((box.min.x + box.max.x) / 2 - x, (box.min.z + box.max.z) / 2 - z);
    });
  }

  frame(time) {
    if (!this.to) return;
    if (this.arrived && !this.moved && !this.spinning) return;
    this.arrived = this.share === 1; // of slow frames, the one after the eyes have arrived is drawn too
    this.moved = false;
    if (this.spinning) this.look.yaw += 1.5;
    this.aim();
    this.renderer.render(this.scene, this.camera);
    this.frames += 1;
    this.last = time;
  }

  // The id of the thing at a pixel of the picture; 0 where there is none.
  pick(x, y) {
    if (!this.to) return 0;
    this.aim();
    this.camera.setViewOffset(WIDTH, HEIGHT, x, y, 1, 1);
    const [found] = this.numbers(this.pixel, 1, 1);
    this.camera.clearViewOffset();
    return found;
  }

  // The ids of the things at the pixels of a target, row by row from below.
  numbers(target, width, height) {
    const [background, found] = [this.scene.background, new Uint8Array(4 * width * height)];
    this.scene.background = null;
    this.scene.overrideMaterial = NUMBERED;
    this.renderer.setRenderTarget(target);
    this.renderer.setClearColor(0, 1);
    this.renderer.clear();
    this.renderer.render(this.scene, this.camera);
    this.renderer.readRenderTargetPixels(target, 0, 0, width, height, found);
    this.renderer.setRenderTarget(null);
    this.scene.overrideMaterial = null;
    this.scene.background = background;
    return Array.from({ length: width * height }, (_, n) => found[4 * n] + (found[4 * n + 1] << 8) + (found[4 * n + 2] << 16));
  }

  // The things in the picture: id -> left, top, right and bottom edge, as shares of the picture.
  inSight() {
    const boxes = new Map();
    if (!this.to) return boxes;
    this.aim();
    const { width, height } = this.seen;
    this.numbers(this.small, width, height).forEach((id, n) => {
      const [x, y] = [n % width, height - 1 - Math.floor(n / width)];
      const [left, top, right, bottom] = boxes.get(id) ?? [1, 1, 0, 0];
      boxes.set(id, [Math.min(left, x / width), Math.min(top, y / height), Math.max(right, (x + 1) / width), Math.max(bottom, (y + 1) / height)]);
    });
    return boxes;
  }

  // Puts a frame around a thing in the picture.
  mark(id) {
    const box = this.inSight().get(id);
    this.frameOf.hidden = !box;
    if (!box) return;
    const { offsetWidth, offsetHeight } = this.renderer.domElement;
    const [left, top, right, bottom] = box;
    Object.assign(this.frameOf.style, { left: `${left * offsetWidth}px`, top: `${top * offsetHeight}px` });
    Object.assign(this.frameOf.style, { width: `${(right - left) * offsetWidth}px`, height: `${(bottom - top) * offsetHeight}px` });
  }

  // Looks around for some seconds and gives the pictures a second.
  async measure(seconds) {
    const [frames, since] = [this.frames, performance.now()];
    this.spinning = true;
    await new Promise((done) => { setTimeout(done, seconds * 1000); });
    this.spinning = false;
    return (this.frames - frames) / (performance.now() - since) * 1000;
  }

  lookUp(degrees) {
    this.look.pitch = Math.max(-75, Math.min(75, this.look.pitch + degrees));
    this.lookAnew();
  }

  turnHeld(degrees) {
    this.turned += degrees;
    const held = this.state.mine.holding;
    this.say(held.length ? say("turned_held", { thing: titled(this.state, held[0]) }) : say("nothing_to_turn"));
    for (const [key, meshes] of this.placed) {
      if (!this.state.mine.holding.includes(Number(key.split(" ")[0]))) continue;
      for (const mesh of meshes) {
        mesh.rotation.y += THREE.MathUtils.degToRad(degrees);
        around(mesh);
      }
    }
    this.moved = true;
  }
}
