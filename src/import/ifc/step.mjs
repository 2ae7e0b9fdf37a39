// SPDX-License-Identifier: Apache-2.0
// Entities of an open IFC model as plain values: references are {ref}, typed values {typed}, numbers are numbers,
// enumerations and strings are strings, and omitted attributes null.

const [STRING, TYPED, ENUM, REAL, REF, INTEGER] = [1, 2, 3, 4, 5, 10];

const MOST = 100_000;

// Returns the values of a list of web-ifc, and frees it: lists left in its memory slow down later requests.
export function taken(list) {
  const all = [];
  for (let i = 0, size = list.size(); i < size; ++i) all.push(list.get(i));
  list.delete();
  return all;
}

// Replaces lists by their values, in place.
const decode = (token) => {
  if (token === null || token === undefined) return null;
  if (Array.isArray(token)) {
    for (let i = 0; i < token.length; ++i) token[i] = decode(token[i]);
    return token;
  }
  switch (token.type) {
    case REF: return { ref: token.value };
    case REAL: return Number(token.value);
    case TYPED: {
      const number = typeof token.value === "string" ? Number(token.value) : NaN;
      return { typed: token.typecode, value: Array.isArray(token.value) ? decode(token.value) : Number.isNaN(number) ? token.value : number };
    }
    default: return token.value ?? null;
  }
};

// Numbers are written as reals; these mark the others.
export const integer = (value) => ({ type: INTEGER, value });
export const enumeration = (value) => ({ type: ENUM, value });
export const measure = (label, internalValue) => ({ type: TYPED, label, valueType: REAL, internalValue });
const encode = (value) => {
  if (value === null || value === undefined) return null;
  if (Array.isArray(value)) return value.map(encode);
  if (typeof value === "object" && value.ref) return { type: REF, value: value.ref };
  return typeof value === "string" ? { type: STRING, value } : value;
};

export class Step {
  #names = new Map();
  #read = new Map();  // attributes of entities, at most MOST

  constructor(ifc, api, model) {
    Object.assign(this, { ifc, api, model });
  }

  // Returns the numbers of all entities of these types, named in capitals; none for types that the schema lacks.
  ids(...names) {
    return names.flatMap((name) => {
      const code = this.ifc[name];
      return taken(this.api.GetLineIDsWithType(this.model, code)).filter((id) => this.api.GetLineType(this.model, id) === code);
    });
  }
  // Returns the numbers of a type and of all its subtypes.
  kinds(name) {
    return taken(this.api.GetLineIDsWithType(this.model, this.ifc[name], true));
  }

  // Returns the type's name in capitals; "" if there is no such entity.
  type(id) {
    return this.#name(id).capitals;
  }
  // Returns the type's name as people write it: IfcWall.
  className(id) {
    return this.#name(id).name;
  }
  #name(id) {
    const code = this.api.GetLineType(this.model, id);
    const known = this.#names.get(code);
    if (known) return known;
    const name = code ? this.api.GetNameFromTypeCode(code) : "", both = { name, capitals: name.toUpperCase() };
    this.#names.set(code, both);
    return both;
  }

  // Returns attributes in the order of the schema, which the caller must not change; [] if there is no such entity.
  args(id) {
    const known = this.#read.get(id);
    if (known) return known;
    const args = decode(this.api.GetRawLineData(this.model, id)?.arguments ?? []);
    if (this.#read.size >= MOST) this.#read.clear();
    this.#read.set(id, args);
    return args;
  }

  // Replaces or creates an entity.
  write(id, name, args) {
    const is = this.type(id);
    this.#read.delete(id);
    if (is && is !== name) this.api.DeleteLine(this.model, id);
    this.api.WriteRawLineData(this.model, { ID: id, type: this.ifc[name], arguments: args.map(encode) });
  }
  add(name, args) {
    const id = this.api.GetMaxExpressID(this.model) + 1;
    this.write(id, name, args);
    return { ref: id };
  }
  // Changes some attributes of an entity, given by position.
  change(id, changes) {
    this.#read.delete(id);
    const { type, arguments: raw } = this.api.GetRawLineData(this.model, id);
    this.api.WriteRawLineData(this.model, { ID: id, type, arguments: raw.map((token, i) => (i in changes ? encode(changes[i]) : this.#kept(token))) });
  }
  // Copies an entity over another.
  copy(from, to) {
    this.#read.delete(to);
    const { type, arguments: raw } = this.api.GetRawLineData(this.model, from);
    if (this.type(to)) this.api.DeleteLine(this.model, to);
    this.api.WriteRawLineData(this.model, { ID: to, type, arguments: raw.map((token) => this.#kept(token)) });
  }
  // Converts a token that was read to the form for writing.
  #kept(token) {
    if (Array.isArray(token)) return token.map((one) => this.#kept(one));
    if (token?.type === REAL) return Number(token.value);
    if (token?.type !== TYPED) return token ?? null;
    const { typecode, value } = token, number = typeof value === "string" ? Number(value) : NaN;
    const label = this.api.GetNameFromTypeCode(typecode).toUpperCase();
    if (typeof value === "number") return { type: TYPED, label, valueType: INTEGER, value };
    return Number.isNaN(number) ? { type: TYPED, label, valueType: STRING, value } : measure(label, number);
  }

  // Returns a product's name in messages: class, name and GlobalId.
  label(id) {
    const [guid, , name] = this.args(id);
    return [this.className(id), (typeof name === "string" ? name : "").replace(/\s+/g, " ").trim(), guid].filter(Boolean).join(" ");
  }
}
