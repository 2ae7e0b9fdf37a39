// SPDX-License-Identifier: Apache-2.0
// Selects the representations of a product that are its body, the part of it that stands on the site.

const FALLBACKS = ["body-fallback", "facetation", "tessellation", "surface", "model"];
const NO_BODY = ["axis", "footprint", "foot print", "box", "annotation", "clearance", "cog", "reference", "profile", "plan", "lighting", "surveypoints", "survey", "mappedrepresentation axis"];
const NO_SURFACE = ["curve2d", "curve3d", "curve", "annotation2d", "point", "pointcloud", "geometriccurveset", "text", "boundingbox", "lightsource"];

const text = (value) => (typeof value === "string" ? value.trim() : "");

export class Bodies {
  #kinds = new Map();  // of representations, by their description: most products share the same ones

  constructor(step) {
    this.step = step;
  }

  // Returns {body, left}: references to bodies, and the names of other representations.
  of(representations) {
    if (representations.length === 1) {
      const { drawn, label } = this.#kind(representations[0].ref);
      return drawn ? { body: representations, left: [] } : { body: [], left: [label] };
    }
    const all = representations.map((ref) => ({ ref, kind: this.#kind(ref.ref) })), drawn = all.filter(({ kind }) => kind.drawn);
    let body = drawn.filter(({ kind }) => kind.key === "body");
    for (const fallback of FALLBACKS) if (body.length === 0) body = drawn.filter(({ kind }) => kind.key === fallback);
    if (body.length === 0) body = drawn;
    // Prefers a body of the model to one of drawings.
    if (body.some(({ kind }) => !kind.plan)) body = body.filter(({ kind }) => !kind.plan);
    return { body: body.map(({ ref }) => ref), left: all.filter((one) => !body.includes(one)).map(({ kind }) => kind.label) };
  }

  // Returns {key, label, drawn, plan}: drawn if it may be a body, plan if its context is one of drawings.
  #kind(id) {
    const [context, identifier, type] = this.step.args(id), told = JSON.stringify([context, text(identifier), text(type)]);
    let kind = this.#kinds.get(told);
    if (!kind) this.#kinds.set(told, kind = this.#judged(context, text(identifier), text(type).toLowerCase()));
    return kind;
  }
  #judged(context, identifier, type) {
    const { step } = this, about = context ? step.args(context.ref) : [], of = context ? step.type(context.ref) : "";
    // The ContextIdentifier of a subcontext names its purpose.
    const name = identifier || (of === "IFCGEOMETRICREPRESENTATIONSUBCONTEXT" ? text(about[0]) : ""), key = name.toLowerCase();
    const plan = /plan|sketch|annotation/i.test(text(about[1]));
    const drawn = !NO_BODY.includes(key) && !NO_SURFACE.includes(type) && (!plan || key === "body");
    return { key, label: name || type || "nameless", drawn, plan };
  }
}
