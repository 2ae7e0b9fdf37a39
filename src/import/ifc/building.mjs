// SPDX-License-Identifier: Apache-2.0
// Converts buildings from web-ifc to the nodes, meshes and materials of one glTF.
import { Glb } from "./glb.mjs";
import { determinant, identity, inverse, product, transformed } from "./matrix.mjs";
import { box, footprint } from "./rooms.mjs";
import { taken } from "./step.mjs";

// Products without a body: openings, spaces of air, drawings.
const NO_BODY = new Set(["IfcOpeningElement", "IfcOpeningStandardCase", "IfcVoidingFeature", "IfcSpace", "IfcSpatialZone",
  "IfcExternalSpatialElement", "IfcVirtualElement", "IfcAnnotation", "IfcGrid"]);
const DOORS = new Set(["IfcDoor", "IfcDoorStandardCase"]);

// Attribute with the long name of spaces and of the elements that contain them.
const LONG_NAME = new Map([["IfcProject", 5], ["IfcSite", 7], ["IfcBuilding", 7], ["IfcBuildingStorey", 7], ["IfcSpace", 7]]);

// Largest missing share of a solid's surface, for rounding.
const OPEN = 1e-4;

// One site, joined from several models.
export class Site {
  constructor() {
    this.glb = new Glb();
    this.nodes = [];
    this.meshes = [];
    this.materials = [];
    this.materialOf = new Map();  // by colour
    this.roots = [];
    this.notes = [];
    this.shown = new Set();       // GlobalIds of products with a shape
    this.shapes = new Map();      // mesh and place, by node
    this.extent = { min: [Infinity, Infinity, Infinity], max: [-Infinity, -Infinity, -Infinity] };
    this.crs = "";
    this.place = undefined;       // transform from the model to the map; null if the models have several
  }

  toGlb() {
    if (this.shapes.size === 0)
      throw new Error(`it holds no product with a shape${this.notes.length > 0 ? ` (${this.notes[0]})` : ""}; export the model with its geometry`);
    this.#addShapes();
    const glass = this.materials.some((material) => material.alphaMode);
    return this.glb.bytes({
      asset: {
        version: "2.0", generator: "vantage-import-ifc",
        extras: { vantage: { unit: "m", up: "y", ...(this.crs ? { crs: this.crs } : {}), ...(this.place === undefined ? {} : { model_in_site: this.place }) }, notes: this.notes },
      },
      ...(glass ? { extensionsUsed: ["KHR_materials_transmission"] } : {}),
      scene: 0, scenes: [{ nodes: this.roots }], nodes: this.nodes, meshes: this.meshes,
      ...(this.materials.length > 0 ? { materials: this.materials } : {}),
    });
  }

  // A whole passes no transform to its parts, so its own shape becomes a node below it.
  #addShapes() {
    for (const [index, shape] of this.shapes) {
      const node = this.nodes[index];
      if (node.children) node.children.push(this.nodes.push({ name: node.name, ...shape }) - 1);
      else Object.assign(node, shape);
    }
  }

  // Returns -1 if the product has no colour of its own, which web-ifc makes white.
  material(colour) {
    if (colour.every((value) => value === 1)) return -1;
    const key = colour.join(" ");
    if (this.materialOf.has(key)) return this.materialOf.get(key);
    const glass = colour[3] < 1;
    const index = this.materials.push({
      name: glass ? "glass" : "surface", doubleSided: true,
      pbrMetallicRoughness: { baseColorFactor: colour.map((value) => Math.min(Math.max(value, 0), 1)), metallicFactor: 0 },
      ...(glass ? { alphaMode: "BLEND", extensions: { KHR_materials_transmission: { transmissionFactor: 1 - colour[3] } } } : {}),
    }) - 1;
    this.materialOf.set(key, index);
    return index;
  }
}

// Adds one model to a site.
export class Building {
  // `opened`: products with openings. `place` transforms the model, in metres with Y up, to the site.
  constructor(site, step, opened, place = identity()) {
    Object.assign(this, { site, step, opened, place, ifc: step.ifc, api: step.api, model: step.model });
    this.nodeOf = new Map();    // by express id
    this.meshesOf = new Map();  // by their first geometry: meshes made so far
    this.parents = this.#parents();
    this.elsewhere = new Set(site.shown);  // products in earlier files
    this.twice = [];
  }

  hasBody(id) {
    return !NO_BODY.has(this.step.className(id));
  }

  // Adds a product. `parts`: lists of geometries; of each list, one must have a surface. `isClosed` tells which must be closed.
  // Returns how many have no surface, and how many are open; null if the product is in the site already.
  add(id, parts, isClosed) {
    const guid = this.step.args(id)[0];
    let index = -1, place = null, shown = new Map();
    const take = ({ geometries }) => {
      const sound = [];
      for (const { geometryExpressID, color: { x, y, z, w }, flatTransformation } of taken(geometries))
        if (flatTransformation.every(Number.isFinite)) sound.push({ geometry: geometryExpressID, colour: [x, y, z, w], place: flatTransformation, turned: false });
      if (sound.length === 0) return;
      // Products share a mesh if their parts have the same places relative to the first part.
      const back = inverse(sound[0].place);
      place = back ? sound[0].place : [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, ...sound[0].place.slice(12)];
      const toFirst = back ?? inverse(place);
      // web-ifc flips a geometry's faces for each mirrored place of a product; all places then see the last state.
      const mirrored = new Map();
      for (const part of sound) if (determinant(part.place) < 0) mirrored.set(part.geometry, !mirrored.get(part.geometry));
      for (const part of sound) {
        part.turned = mirrored.get(part.geometry) ?? false;
        part.place = product(toFirst, part.place);
      }
      // web-ifc cuts openings out of the geometry itself, so only products without openings share it.
      const mesh = this.#mesh(sound, this.opened.size > 0 && this.#isOpened(id) ? id : 0, isClosed);
      ({ index, shown } = mesh);
      if (index >= 0) this.#extend(mesh.bounds, place);
    };
    try {
      this.api.StreamMeshes(this.model, [id], take);
    } catch {
      shown = new Map();  // web-ifc failed on the product
    }
    if (index >= 0) {
      if (guid && this.elsewhere.has(guid)) { this.twice.push(id); return null; }
      this.site.shown.add(guid);
      this.site.shapes.set(this.node(id), { mesh: index, matrix: product(this.place, place) });
    }
    return {
      empty: parts.filter((ids) => !ids.some((one) => shown.has(one))).length,
      open: [...shown.values()].filter((share) => share > OPEN).length,
    };
  }

  // Returns true if an opening is cut out of a product or of a whole that it belongs to.
  #isOpened(id) {
    for (let at = id, steps = 0; at !== undefined && steps < 100; at = this.parents.get(at), ++steps) if (this.opened.has(at)) return true;
    return false;
  }

  // Returns the parent of each element: its whole, storey or building.
  #parents() {
    const { step } = this, parents = new Map();
    const collect = (name, whole, parts) => {
      for (const id of step.ids(name)) {
        const args = step.args(id);
        for (const part of args[parts] ?? [])
          if (part?.ref && args[whole]?.ref && !parents.has(part.ref)) parents.set(part.ref, args[whole].ref);
      }
    };
    collect("IFCRELAGGREGATES", 4, 5);
    collect("IFCRELNESTS", 4, 5);
    collect("IFCRELCONTAINEDINSPATIALSTRUCTURE", 5, 4);
    return parents;
  }

  // Returns the node of an element, below those of its parents.
  node(id, visiting = new Set()) {
    if (this.nodeOf.has(id)) return this.nodeOf.get(id);
    visiting.add(id);
    const { nodes, roots } = this.site;
    const args = this.step.args(id), type = this.step.className(id), text = (value) => (typeof value === "string" ? value.replace(/\s+/g, " ").trim() : "");
    const key = text(args[0]), name = text(args[2]), longName = text(args[LONG_NAME.get(type)]);
    const vantage = { class: type, ...(name ? { name } : {}), ...(key ? { id: key } : {}) };
    if (DOORS.has(type)) vantage.door = true;
    if (longName) vantage.long_name = longName;
    const index = nodes.push({ name: [type, name, key].filter(Boolean).join(" "), extras: { vantage } }) - 1;
    this.nodeOf.set(id, index);
    const parent = this.parents.get(id);
    if (parent === undefined || visiting.has(parent)) {
      roots.push(index);
    } else {
      const above = nodes[this.node(parent, visiting)];
      (above.children ??= []).push(index);
    }
    return index;
  }

  // `own`: the product that the geometry is cut for, or 0. `shown`: the missing share of geometries that must be closed.
  #mesh(parts, own, isClosed) {
    const first = parts[0].geometry, alike = this.meshesOf.get(first) ?? [];
    const known = alike.find((one) => one.own === own && one.parts.length === parts.length && one.parts.every((part, i) => same(part, parts[i])));
    if (known) return known;
    const { glb, meshes } = this.site, byMaterial = new Map(), shown = new Map();
    for (const part of parts) {
      const geometry = this.#geometry(part.geometry, part.place, part.turned);
      if (geometry.indices.length === 0) continue;
      shown.set(part.geometry, isClosed(part.geometry) ? missing(geometry) : 0);
      const material = this.site.material(part.colour);
      if (!byMaterial.has(material)) byMaterial.set(material, []);
      byMaterial.get(material).push(geometry);
    }
    const bounds = { min: [Infinity, Infinity, Infinity], max: [-Infinity, -Infinity, -Infinity] };
    const primitives = [...byMaterial].map(([material, geometries]) => {
      const { positions, indices } = joined(geometries);
      const accessor = glb.positions(positions), { min, max } = glb.accessors[accessor];
      for (let c = 0; c < 3; ++c) bounds.min[c] = Math.min(bounds.min[c], min[c]), bounds.max[c] = Math.max(bounds.max[c], max[c]);
      return { attributes: { POSITION: accessor }, indices: glb.indices(indices), ...(material >= 0 ? { material } : {}) };
    });
    const made = { own, parts, index: primitives.length === 0 ? -1 : meshes.push({ primitives }) - 1, shown, bounds };
    alike.push(made);
    this.meshesOf.set(first, alike);
    return made;
  }

  #extend({ min, max }, place) {
    const { extent } = this.site, whole = product(this.place, place);
    for (let k = 0; k < 8; ++k) {
      const corner = transformed(whole, k & 1 ? max[0] : min[0], k & 2 ? max[1] : min[1], k & 4 ? max[2] : min[2]);
      for (let c = 0; c < 3; ++c) extent.min[c] = Math.min(extent.min[c], corner[c]), extent.max[c] = Math.max(extent.max[c], corner[c]);
    }
  }

  // Vertices come with one normal each, already placed.
  #geometry(id, m, turned = false) {
    const { api, model } = this, geometry = api.GetGeometry(model, id);
    const from = geometry.GetVertexData() / 4, count = Math.floor(geometry.GetVertexDataSize() / 6);
    const first = geometry.GetIndexData() / 4, size = geometry.GetIndexDataSize();
    const { HEAPF32, HEAPU32 } = api.wasmModule;  // read last: web-ifc's memory moves as it grows
    const positions = new Float64Array(3 * count), indices = HEAPU32.slice(first, first + size);
    let sound = true;
    for (let i = 0; i < indices.length; ++i) if (indices[i] >= count) sound = false;
    for (let v = 0; v < count; ++v) {
      const x = HEAPF32[from + 6 * v], y = HEAPF32[from + 6 * v + 1], z = HEAPF32[from + 6 * v + 2];
      for (let r = 0; r < 3; ++r) positions[3 * v + r] = m[r] * x + m[4 + r] * y + m[8 + r] * z + m[12 + r];
      sound &&= Number.isFinite(positions[3 * v] + positions[3 * v + 1] + positions[3 * v + 2]);
    }
    geometry.delete();
    if (!sound) return { positions: [], indices: [] };
    if (determinant(m) < 0 !== turned)  // faces keep their outside
      for (let i = 0; i + 2 < indices.length; i += 3) [indices[i + 1], indices[i + 2]] = [indices[i + 2], indices[i + 1]];
    return { positions, indices };
  }

  // Rooms are nodes without a mesh. Their extras hold a box and an outline, in metres, Y up.
  addRooms() {
    for (const id of this.step.ids("IFCSPACE")) {
      const guid = this.step.args(id)[0], triangles = [];
      if (guid && this.elsewhere.has(guid)) continue;  // it is also in another file
      this.site.shown.add(guid);
      for (const part of taken(this.api.GetFlatMesh(this.model, id).geometries)) {
        const { positions, indices } = this.#geometry(part.geometryExpressID, product(this.place, part.flatTransformation));
        for (let i = 0; i + 2 < indices.length; i += 3)
          triangles.push([0, 1, 2].map((k) => Array.from(positions.subarray(3 * indices[i + k], 3 * indices[i + k] + 3))));
      }
      const { vantage } = this.site.nodes[this.node(id)].extras;
      if (triangles.length > 0) Object.assign(vantage, { box: box(triangles), footprint: footprint(triangles) });
    }
  }
}

// Returns true if two parts look the same, to a micrometre.
const same = (a, b) => a.geometry === b.geometry && a.turned === b.turned && a.colour.every((v, i) => v === b.colour[i]) &&
  a.place.every((v, i) => v === b.place[i] || (Math.abs(v - b.place[i]) < 2e-6 && v.toFixed(6) === b.place[i].toFixed(6)));

// Joins several lists of vertices and triangles to one.
function joined(geometries) {
  let vertices = 0, corners = 0;
  for (const one of geometries) vertices += one.positions.length, corners += one.indices.length;
  const positions = new Float32Array(vertices), indices = new Uint32Array(corners);
  let vertex = 0, index = 0;
  for (const one of geometries) {
    positions.set(one.positions, 3 * vertex);
    for (let i = 0; i < one.indices.length; ++i) indices[index++] = one.indices[i] + vertex;
    vertex += one.positions.length / 3;
  }
  return { positions, indices };
}

// Returns the share of area that a surface lacks to be closed: area vectors of a closed surface sum to zero.
function missing({ positions: p, indices }) {
  let x = 0, y = 0, z = 0, all = 0;
  for (let i = 0; i + 2 < indices.length; i += 3) {
    const a = 3 * indices[i], b = 3 * indices[i + 1], c = 3 * indices[i + 2];
    const ux = p[b] - p[a], uy = p[b + 1] - p[a + 1], uz = p[b + 2] - p[a + 2], vx = p[c] - p[a], vy = p[c + 1] - p[a + 1], vz = p[c + 2] - p[a + 2];
    const nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
    x += nx, y += ny, z += nz, all += Math.hypot(nx, ny, nz);
  }
  return all > 0 ? Math.hypot(x, y, z) / all : 0;
}
