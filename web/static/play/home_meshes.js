// A home for fast drawing: one mesh for each room, colours and light baked into its corners, and the id of each corner's thing.
import * as THREE from "/fetched/three/build/three.module.js";
import { GLTFLoader } from "/fetched/three/examples/jsm/loaders/GLTFLoader.js";

const SUN = new THREE.Vector3(0.35, 0.85, -0.4).normalize();
const loader = new GLTFLoader();

export const load = (address) => loader.loadAsync(address).then(({ scene }) => scene);

// The baked colour of a corner: base colour times sky and sun, plus its own glow.
function shade(normal, base, glow, out, at) {
  const sun = Math.max(0, normal.dot(SUN));
  const light = 0.52 + 0.16 * normal.y + 0.36 * sun + 0.06 * normal.x;
  for (const [n, channel] of ["r", "g", "b"].entries()) {
    const value = Math.min(1, base[channel] * light + glow[channel]);
    out[at + n] = 255 * (value <= 0.0031308 ? value * 12.92 : 1.055 * value ** (1 / 2.4) - 0.055);
  }
}

// Numbers of one kind, in an array that grows.
class Growing {
  constructor(kind) {
    this.array = new kind(1024);
    this.length = 0;
  }

  push(...values) {
    if (this.length + values.length > this.array.length) {
      const larger = new this.array.constructor(this.array.length * 2);
      larger.set(this.array);
      this.array = larger;
    }
    for (const value of values) this.array[this.length++] = value;
  }

  get all() {
    return this.array.slice(0, this.length);
  }
}

class Pile {
  constructor() {
    this.positions = new Growing(Float32Array);
    this.shades = new Growing(Uint8Array);
    this.things = new Growing(Uint8Array);
    this.index = new Growing(Uint32Array);
    this.ranges = new Map();
  }

  add(mesh, id, name, transform) {
    const { position, normal } = mesh.geometry.attributes;
    const turn = new THREE.Matrix3().getNormalMatrix(transform);
    const [point, face, colour] = [new THREE.Vector3(), new THREE.Vector3(), [0, 0, 0]];
    const [start, first] = [this.index.length, this.positions.length / 3];
    for (let n = 0; n < position.count; n += 1) {
      point.fromBufferAttribute(position, n).applyMatrix4(transform);
      face.fromBufferAttribute(normal, n).applyMatrix3(turn).normalize();
      shade(face, mesh.material.color, mesh.material.emissive, colour, 0);
      this.positions.push(point.x, point.y, point.z);
      this.shades.push(...colour, 255);
      this.things.push(id & 255, (id >> 8) & 255, (id >> 16) & 255, 255);
    }
    const corners = mesh.geometry.index.array;
    for (let n = 0; n < corners.length; n += 1) this.index.push(first + corners[n]);
    if (!this.ranges.has(name)) this.ranges.set(name, []);
    this.ranges.get(name).push([start, corners.length]);
  }

  mesh() {
    const made = new THREE.BufferGeometry();
    made.setAttribute("position", new THREE.BufferAttribute(this.positions.all, 3));
    made.setAttribute("shade", new THREE.BufferAttribute(this.shades.all, 4, true));
    made.setAttribute("thing", new THREE.BufferAttribute(this.things.all, 4, true));
    made.setIndex(new THREE.BufferAttribute(this.index.all, 1));
    made.computeBoundingSphere();
    made.computeBoundingBox();
    const mesh = new THREE.Mesh(made, SHOWN);
    mesh.userData = { box: made.boundingBox, ranges: this.ranges, whole: made.index.array.slice(), hidden: new Set() };
    return mesh;
  }
}

const shader = (attribute, between) => new THREE.RawShaderMaterial({
  glslVersion: THREE.GLSL3,
  side: THREE.FrontSide,
  vertexShader: `in vec3 position; in vec3 ${attribute}; uniform mat4 modelViewMatrix; uniform mat4 projectionMatrix; ${between} out lowp vec3 value;
    void main() { value = ${attribute}; gl_Position = projectionMatrix * (modelViewMatrix * vec4(position, 1.0)); }`,
  fragmentShader: `precision lowp float; ${between} in lowp vec3 value; out vec4 colour; void main() { colour = vec4(value, 1.0); }`,
});

export const SHOWN = shader("shade", "smooth"); // what one sees
export const NUMBERED = shader("thing", "flat"); // ids as colours, for what is under the cursor

const own = (node) => {
  for (let each = node; each; each = each.parent) if (each.userData.id !== undefined) return each;
  return null;
};

const CELL = 1.5; // metres of a part of a room

const within = ([x0, z0, x1, z1], x, z) => x0 <= x && x <= x1 && z0 <= z && z <= z1;

// A loaded glTF as meshes, each of a part of a room; and the walls that nobody sees through, as rectangles.
// `userData.box` holds all of a mesh; `userData.room` is its room, -1 between rooms.
export function merged(scene, rooms) {
  scene.updateMatrixWorld(true);
  const [piles, walls, box] = [new Map(), [], new THREE.Box3()];
  scene.traverse((node) => {
    if (!node.isMesh) return;
    const thing = own(node);
    node.geometry.computeBoundingBox();
    box.copy(node.geometry.boundingBox).applyMatrix4(node.matrixWorld);
    if (thing.userData.class === "wall" && box.min.y < 0.2 && box.max.y > 2) walls.push([box.min.x, box.min.z, box.max.x, box.max.z]);
    const [x, z] = [(box.min.x + box.max.x) / 2, (box.min.z + box.max.z) / 2];
    const room = rooms.findIndex((each) => within(each, x, z));
    const key = room < 0 ? "between" : `${room} ${Math.floor(x / CELL)} ${Math.floor(z / CELL)}`;
    if (!piles.has(key)) piles.set(key, [room, new Pile()]);
    piles.get(key)[1].add(node, thing.userData.id, thing.userData.name ?? thing.name, node.matrixWorld);
  });
  const meshes = [...piles.values()].map(([room, pile]) => {
    const mesh = pile.mesh();
    mesh.userData.room = room;
    return mesh;
  });
  return { meshes, walls };
}

const RAYS = 720;

// Which of some rectangles of the floor plan one can look at from a place: those that rays meet before a wall.
export function seenFrom(x, z, walls, rectangles) {
  const seen = rectangles.map((each) => within(each, x, z));
  const closing = walls.filter((each) => !within(each, x, z));
  for (let n = 0; n < RAYS; n += 1) {
    const angle = (n / RAYS) * 2 * Math.PI;
    const [dx, dz] = [Math.sin(angle), Math.cos(angle)];
    let far = 60;
    for (const wall of closing) far = Math.min(far, entry(wall, x, z, dx, dz));
    rectangles.forEach((each, number) => {
      if (!seen[number] && entry(each, x, z, dx, dz) < far + 0.1) seen[number] = true;
    });
  }
  return seen;
}

// How far along a ray a rectangle begins; infinite where it is not met.
function entry([x0, z0, x1, z1], x, z, dx, dz) {
  const [a, b] = [(x0 - x) / dx, (x1 - x) / dx];
  const [c, d] = [(z0 - z) / dz, (z1 - z) / dz];
  const near = Math.max(Math.min(a, b), Math.min(c, d));
  const far = Math.min(Math.max(a, b), Math.max(c, d));
  return near <= far && far >= 0 ? Math.max(near, 0) : Infinity;
}

// The box in which a mesh is, where it stands and as it is turned now.
export function around(mesh) {
  mesh.updateMatrix();
  mesh.userData.box = mesh.geometry.boundingBox.clone().applyMatrix4(mesh.matrix);
}

// Whether a box may be in the picture: it is not all beyond one edge of it, or behind. `shown` leads to clip space.
export function inPicture({ min, max }, { elements: m }) {
  const beyond = [0, 0, 0, 0, 0];
  for (let n = 0; n < 8; n += 1) {
    const [x, y, z] = [n & 1 ? min.x : max.x, n & 2 ? min.y : max.y, n & 4 ? min.z : max.z];
    const [across, up, depth] = [0, 1, 3].map((row) => m[row] * x + m[row + 4] * y + m[row + 8] * z + m[row + 12]);
    [across < -depth, across > depth, up < -depth, up > depth, depth < 0].forEach((is, side) => { beyond[side] += is; });
  }
  return !beyond.includes(8);
}

// Leaves out some things of a merged mesh: their triangles shrink to nothing.
export function hide(mesh, names) {
  const { ranges, whole, hidden } = mesh.userData;
  const index = mesh.geometry.index;
  for (const name of [...hidden].filter((each) => !names.has(each))) {
    for (const [start, count] of ranges.get(name)) index.array.set(whole.subarray(start, start + count), start);
    hidden.delete(name);
    index.needsUpdate = true;
  }
  for (const name of [...names].filter((each) => ranges.has(each) && !hidden.has(each))) {
    for (const [start, count] of ranges.get(name)) index.array.fill(0, start, start + count);
    hidden.add(name);
    index.needsUpdate = true;
  }
}

const FINE = 3000; // corners above which a model is drawn by pieces
const PIECE = 0.25; // metres of a piece

// One model as geometries, all with its thing's id; a large one, such as one's own body, in pieces to be left out.
export function model(scene, id) {
  scene.updateMatrixWorld(true);
  const pile = new Pile();
  scene.traverse((node) => node.isMesh && pile.add(node, id, "model", node.matrixWorld));
  const { geometry } = pile.mesh();
  return geometry.index.count > FINE ? pieces(geometry) : [geometry];
}

// The triangles of a geometry by where they are; the pieces share its corners.
function pieces(geometry) {
  const [{ array }, corners] = [geometry.attributes.position, geometry.index.array];
  const found = new Map();
  for (let n = 0; n < corners.length; n += 3) {
    const place = [0, 1, 2].map((axis) => Math.floor(array[3 * corners[n] + axis] / PIECE)).join(" ");
    if (!found.has(place)) found.set(place, []);
    found.get(place).push(...corners.subarray(n, n + 3));
  }
  return [...found.values()].map((some) => {
    const piece = new THREE.BufferGeometry();
    for (const name of ["position", "shade", "thing"]) piece.setAttribute(name, geometry.attributes[name]);
    piece.setIndex(some);
    const points = some.map((corner) => new THREE.Vector3().fromArray(array, 3 * corner));
    piece.boundingBox = new THREE.Box3().setFromPoints(points);
    piece.boundingSphere = piece.boundingBox.getBoundingSphere(new THREE.Sphere());
    return piece;
  });
}
