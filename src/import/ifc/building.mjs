// SPDX-License-Identifier: Apache-2.0
// Converts a building from web-ifc to the nodes, meshes and materials of a glTF.
import { Glb } from "./glb.mjs";
import { inverse, product, transformed } from "./matrix.mjs";
import { box, footprint } from "./rooms.mjs";

// Products without a body: openings, air, drawings.
const NO_BODY = new Set(["IfcOpeningElement", "IfcOpeningStandardCase", "IfcVoidingFeature", "IfcSpace", "IfcSpatialZone",
  "IfcExternalSpatialElement", "IfcVirtualElement", "IfcAnnotation", "IfcGrid"]);
const DOORS = new Set(["IfcDoor", "IfcDoorStandardCase"]);

const each = (ids, visit) => { for (let i = 0; i < ids.size(); ++i) visit(ids.get(i)); };

export class Building {
  constructor(ifc, api, model) {
    Object.assign(this, { ifc, api, model });
    this.glb = new Glb();
    this.nodes = [];
    this.meshes = [];
    this.materials = [];
    this.nodeOf = new Map();      // by express id
    this.shapes = new Map();      // mesh and place, by node
    this.meshOf = new Map();      // by content
    this.materialOf = new Map();  // by colour
    this.roots = [];
    this.parents = this.#parents();
  }

  toGlb() {
    const shown = new Set();
    this.api.StreamAllMeshes(this.model, (mesh) => { if (this.#addProduct(mesh)) shown.add(mesh.expressID); });
    if (shown.size === 0) throw new Error("it holds no product with a shape; export the model with its geometry");
    this.#addRooms();
    this.#addShapes();
    const glass = this.materials.some((material) => material.alphaMode);
    return this.glb.bytes({
      asset: {
        version: "2.0", generator: "vantage-import-ifc",
        extras: { vantage: { unit: "m", up: "y" }, notes: this.#notes(shown) },
      },
      ...(glass ? { extensionsUsed: ["KHR_materials_transmission"] } : {}),
      scene: 0, scenes: [{ nodes: this.roots }], nodes: this.nodes, meshes: this.meshes,
      ...(this.materials.length > 0 ? { materials: this.materials } : {}),
    });
  }

  // Parent of each element: its whole, storey or building.
  #parents() {
    const { ifc, api, model } = this, parents = new Map();
    const collect = (type, whole, parts) => each(api.GetLineIDsWithType(model, type), (id) => {
      const relation = api.GetLine(model, id);
      for (const part of relation[parts] ?? [])
        if (part && relation[whole] && !parents.has(part.value)) parents.set(part.value, relation[whole].value);
    });
    collect(ifc.IFCRELAGGREGATES, "RelatingObject", "RelatedObjects");
    collect(ifc.IFCRELNESTS, "RelatingObject", "RelatedObjects");
    collect(ifc.IFCRELCONTAINEDINSPATIALSTRUCTURE, "RelatingStructure", "RelatedElements");
    return parents;
  }

  #className(id) {
    return this.api.GetNameFromTypeCode(this.api.GetLineType(this.model, id));
  }

  // Node of an element, below those of its parents.
  #node(id, visiting = new Set()) {
    if (this.nodeOf.has(id)) return this.nodeOf.get(id);
    visiting.add(id);
    const line = this.api.GetLine(this.model, id) ?? {}, type = this.#className(id);
    const name = (line.Name?.value ?? "").replace(/\s+/g, " ").trim(), key = line.GlobalId?.value ?? "";
    const vantage = { class: type, ...(name ? { name } : {}), ...(key ? { id: key } : {}) };
    if (DOORS.has(type)) vantage.door = true;
    const longName = line.LongName?.value?.trim();
    if (longName) vantage.long_name = longName;
    const index = this.nodes.push({ name: [type, name, key].filter(Boolean).join(" "), extras: { vantage } }) - 1;
    this.nodeOf.set(id, index);
    const parent = this.parents.get(id);
    if (parent === undefined || visiting.has(parent)) {
      this.roots.push(index);
    } else {
      const above = this.nodes[this.#node(parent, visiting)];
      (above.children ??= []).push(index);
    }
    return index;
  }

  #addProduct(mesh) {
    const { expressID: id, geometries } = mesh;
    if (NO_BODY.has(this.#className(id))) return false;
    const parts = [];
    each(geometries, (part) => parts.push({
      geometry: part.geometryExpressID, colour: [part.color.x, part.color.y, part.color.z, part.color.w],
      place: Array.from(part.flatTransformation),
    }));
    if (parts.length === 0 || !parts.every((part) => part.place.every(Number.isFinite))) return false;
    // Equal products share a mesh if their parts lie equally to the first.
    const back = inverse(parts[0].place);
    const place = back ? parts[0].place : [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, ...parts[0].place.slice(12)];
    const toFirst = back ?? inverse(place);
    for (const part of parts) part.place = product(toFirst, part.place);
    const index = this.#mesh(parts);
    if (index < 0) return false;
    this.shapes.set(this.#node(id), { mesh: index, matrix: place });
    return true;
  }

  // A whole passes no transform to its parts: its own shape, if any, is a node below it.
  #addShapes() {
    for (const [index, shape] of this.shapes) {
      const node = this.nodes[index];
      if (node.children) node.children.push(this.nodes.push({ name: node.name, ...shape }) - 1);
      else Object.assign(node, shape);
    }
  }

  #mesh(parts) {
    const key = parts.map((part) => [part.geometry, ...part.colour, ...part.place.map((v) => v.toFixed(6))].join(" ")).join();
    if (this.meshOf.has(key)) return this.meshOf.get(key);
    const byMaterial = new Map();
    for (const part of parts) {
      const { positions, indices } = this.#geometry(part.geometry, part.place);
      if (indices.length === 0) continue;
      const material = this.#material(part.colour);
      if (!byMaterial.has(material)) byMaterial.set(material, { positions: [], indices: [] });
      const all = byMaterial.get(material), first = all.positions.length / 3;
      for (const value of positions) all.positions.push(value);
      for (const value of indices) all.indices.push(value + first);
    }
    const primitives = [...byMaterial].map(([material, { positions, indices }]) => ({
      attributes: { POSITION: this.glb.positions(Float32Array.from(positions)) },
      indices: this.glb.indices(Uint32Array.from(indices)), ...(material >= 0 ? { material } : {}),
    }));
    const index = primitives.length === 0 ? -1 : this.meshes.push({ primitives }) - 1;
    this.meshOf.set(key, index);
    return index;
  }

  // Vertices come with a normal each, already placed.
  #geometry(id, place) {
    const { api, model } = this, geometry = api.GetGeometry(model, id);
    const vertices = api.GetVertexArray(geometry.GetVertexData(), geometry.GetVertexDataSize());
    const indices = Uint32Array.from(api.GetIndexArray(geometry.GetIndexData(), geometry.GetIndexDataSize()));
    const positions = [];
    for (let v = 0; v + 5 < vertices.length; v += 6) positions.push(...transformed(place, ...vertices.subarray(v, v + 3)));
    geometry.delete();
    const sound = positions.every(Number.isFinite) && indices.every((index) => index < positions.length / 3);
    return sound ? { positions, indices } : { positions: [], indices: [] };
  }

  // -1 if the product has no colour of its own: web-ifc makes that white.
  #material(colour) {
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

  // Rooms are nodes without a mesh: the extras have their box and outline, in metres, Y up.
  #addRooms() {
    const { ifc, api, model } = this;
    each(api.GetLineIDsWithType(model, ifc.IFCSPACE), (id) => {
      const triangles = [];
      each(api.GetFlatMesh(model, id).geometries, (part) => {
        const { positions, indices } = this.#geometry(part.geometryExpressID, part.flatTransformation);
        for (let i = 0; i + 2 < indices.length; i += 3)
          triangles.push([0, 1, 2].map((k) => positions.slice(3 * indices[i + k], 3 * indices[i + k] + 3)));
      });
      const { vantage } = this.nodes[this.#node(id)].extras;
      if (triangles.length > 0) Object.assign(vantage, { box: box(triangles), footprint: footprint(triangles) });
    });
  }

  // Notes on parts that were lost.
  #notes(shown) {
    const { ifc, api, model } = this, lost = [];
    each(api.GetLineIDsWithType(model, ifc.IFCELEMENT, true), (id) => {
      if (shown.has(id) || NO_BODY.has(this.#className(id))) return;
      const line = api.GetLine(model, id);
      if (line?.Representation) lost.push(this.nodes[this.#node(id)].name);
    });
    if (lost.length === 0) return [];
    return [`${lost.length} products have a shape of which no surface could be made, and are left out: ` +
      lost.slice(0, 3).join(", ") + (lost.length > 3 ? ", …" : "")];
  }
}
