// SPDX-License-Identifier: Apache-2.0
// Finds glass by the materials of a product or its type, of constituents by shape aspects, and by colour maps. web-ifc reads
// only styles of items and one colour a product, so the others become such styles. Must run before it makes any geometry.
import { enumeration } from "./step.mjs";

const CLEAR = 0.8;  // transparency of a glass material that has a category and no style

export class Materials {
  constructor(step) {
    this.step = step;
    this.guessed = [];   // products whose material is glass only by its category
    this.unsaid = [];    // products of glass and other materials that do not assign them to parts
    this.styleOf = new Map();
    for (const id of step.ids("IFCMATERIALDEFINITIONREPRESENTATION")) {
      const [, , representations, material] = step.args(id);
      for (const representation of representations)
        for (const item of step.args(representation.ref)[3] ?? [])
          for (const style of step.args(item.ref)[1] ?? []) this.styleOf.set(material.ref, style);
    }
  }

  apply() {
    const { step } = this;
    this.#colourMaps();
    this.glass = new Map();  // style by material
    for (const [material, style] of this.styleOf) if (this.#transparency(style) > 0) this.glass.set(material, style);
    this.byCategory = new Set();
    for (const id of step.ids("IFCMATERIAL")) {
      const category = step.args(id)[2];
      if (typeof category !== "string" || category.trim().toLowerCase() !== "glass" || this.styleOf.has(id)) continue;
      this.glass.set(id, this.#style(CLEAR));
      this.byCategory.add(id);
    }
    if (this.glass.size === 0) return;
    const materials = new Map(), types = new Map();
    for (const id of step.ids("IFCRELASSOCIATESMATERIAL")) {
      const [, , , , objects, material] = step.args(id);
      for (const object of objects) materials.set(object.ref, material);
    }
    for (const id of step.ids("IFCRELDEFINESBYTYPE")) {
      const [, , , , objects, type] = step.args(id);
      for (const object of objects) types.set(object.ref, type.ref);
    }
    const aspects = new Map();
    for (const id of step.ids("IFCSHAPEASPECT")) {
      const [, , , , whole] = step.args(id);
      if (whole) aspects.set(whole.ref, [...(aspects.get(whole.ref) ?? []), id]);
    }
    const styled = new Set(step.ids("IFCSTYLEDITEM").map((id) => step.args(id)[0]?.ref));
    for (const product of new Set([...materials.keys(), ...types.keys()])) {
      if (!step.api.IsIfcElement(step.api.GetLineType(step.model, product))) continue;
      const material = materials.get(product) ?? materials.get(types.get(product));
      const parts = material ? this.#parts(material.ref) : [];
      if (parts.some(({ id }) => this.glass.has(id))) this.#product(product, parts, aspects, styled);
    }
  }

  // Returns materials with the names of their parts.
  #parts(id) {
    const { step } = this, type = step.type(id), args = step.args(id), all = (list, more) => (list ?? []).flatMap((one) => this.#parts(one.ref).map((part) => ({ ...part, ...more?.(one) })));
    const named = (place) => (one) => ({ name: step.args(one.ref)[place] });
    switch (type) {
      case "IFCMATERIAL": return [{ id, name: args[0] }];
      case "IFCMATERIALLIST": return all(args[0]);
      case "IFCMATERIALLAYERSETUSAGE": case "IFCMATERIALPROFILESETUSAGE": case "IFCMATERIALPROFILESETUSAGETAPERING": return this.#parts(args[0].ref);
      case "IFCMATERIALLAYERSET": return all(args[0]);
      case "IFCMATERIALLAYER": case "IFCMATERIALLAYERWITHOFFSETS": return args[0] && args[2] !== true ? this.#parts(args[0].ref) : [];  // air is no part
      case "IFCMATERIALCONSTITUENTSET": return all(args[2], named(0));
      case "IFCMATERIALPROFILESET": return all(args[2], named(0));
      case "IFCMATERIALCONSTITUENT": case "IFCMATERIALPROFILE": case "IFCMATERIALPROFILEWITHOFFSETS": return args[2] ? this.#parts(args[2].ref) : [];
      default: return [];
    }
  }

  #product(product, parts, aspects, styled) {
    const { step } = this, shape = step.args(product)[6];
    if (!shape) return;
    const panes = parts.filter(({ id }) => this.glass.has(id)), same = (a, b) => String(a ?? "").trim().toLowerCase() === String(b ?? "").trim().toLowerCase();
    if (panes.some(({ id }) => this.byCategory.has(id))) this.guessed.push(product);
    const paint = (item, style) => {
      if (styled.has(item)) return;
      styled.add(item);
      step.add("IFCSTYLEDITEM", [{ ref: item }, [style], null]);
    };
    let pane = false;
    const items = this.#items(shape.ref);
    for (const whole of [shape.ref, ...items.maps])
      for (const aspect of aspects.get(whole) ?? []) {
        const [representations, name] = step.args(aspect);
        const part = parts.find((one) => same(one.name, name));
        if (!part) continue;
        for (const representation of representations)
          for (const item of step.args(representation.ref)[3] ?? []) {
            pane ||= this.glass.has(part.id) && items.all.includes(item.ref);
            paint(item.ref, this.glass.get(part.id) ?? this.#opaque(part.id));
          }
      }
    // The product's own style goes to its remaining items.
    if (panes.length === parts.length) return paint(product, this.glass.get(panes[0].id));
    paint(product, this.#opaque(parts.find(({ id }) => !this.glass.has(id)).id));
    if (!pane && !items.all.every((item) => styled.has(item))) this.unsaid.push(product);
  }

  // Returns the items of a product's shape, and the maps that it uses.
  #items(shape) {
    const { step } = this, all = [], maps = [];
    const collect = (representation) => {
      for (const item of step.args(representation)[3] ?? []) {
        if (step.type(item.ref) !== "IFCMAPPEDITEM") { all.push(item.ref); continue; }
        const [source] = step.args(item.ref);
        maps.push(source.ref);
        collect(step.args(source.ref)[1].ref);
      }
    };
    for (const representation of step.args(shape)[2] ?? []) collect(representation.ref);
    return { all, maps };
  }

  // Returns the transparency of a style, also inside wrappers.
  #transparency(style) {
    const { step } = this, type = step.type(style.ref), args = step.args(style.ref);
    const most = (list) => Math.max(0, ...(list ?? []).map((one) => this.#transparency(one)));
    if (type === "IFCPRESENTATIONSTYLEASSIGNMENT") return most(args[0].filter((one) => one.ref));
    if (type === "IFCSURFACESTYLE") return most(args[2]);
    return ["IFCSURFACESTYLERENDERING", "IFCSURFACESTYLESHADING"].includes(type) && typeof args[1] === "number" ? args[1] : 0;
  }

  #opaque(material) {
    const style = this.styleOf.get(material);
    return style && this.#transparency(style) === 0 ? style : (this.white ??= this.#style(0));
  }
  #style(transparency) {
    const { step } = this, colour = step.add("IFCCOLOURRGB", [null, 1, 1, 1]);
    const rendering = step.add("IFCSURFACESTYLERENDERING", [colour, transparency, null, null, null, null, null, null, enumeration("NOTDEFINED")]);
    return step.add("IFCSURFACESTYLE", [null, enumeration("BOTH"), [rendering]]);
  }

  #colourMaps() {
    for (const id of this.step.ids("IFCINDEXEDCOLOURMAP")) {
      const [item, opacity] = this.step.args(id);
      if (typeof opacity === "number" && opacity < 1) this.step.add("IFCSTYLEDITEM", [item, [this.#style(1 - opacity)], null]);
    }
  }
}
