// SPDX-License-Identifier: Apache-2.0
// Which of a product's representations are its body: what of it stands on the site.

const FALLBACKS = ["body-fallback", "facetation", "tessellation", "surface", "model"];
const NO_BODY = ["axis", "footprint", "foot print", "box", "annotation", "clearance", "cog", "reference", "profile", "plan", "lighting", "surveypoints", "survey", "mappedrepresentation axis"];
const NO_SURFACE = ["curve2d", "curve3d", "curve", "annotation2d", "point", "pointcloud", "geometriccurveset", "text", "boundingbox", "lightsource"];

// {body, left}: references, and the names of those that are none.
export function bodies(step, representations) {
  const named = representations.map((ref) => {
    const [context, identifier, type] = step.args(ref.ref);
    const about = context ? step.args(context.ref) : [], of = context ? step.type(context.ref) : "";
    const text = (value) => (typeof value === "string" ? value.trim() : "");
    // A subcontext is named as what it is for: ContextIdentifier.
    const name = text(identifier) || (of === "IFCGEOMETRICREPRESENTATIONSUBCONTEXT" ? text(about[0]) : "");
    return { ref, name, key: name.toLowerCase(), type: text(type).toLowerCase(), plan: /plan|sketch|annotation/i.test(text(about[1])) };
  });
  const drawn = named.filter(({ key, type, plan }) => !NO_BODY.includes(key) && !NO_SURFACE.includes(type) && (!plan || key === "body"));
  let body = drawn.filter(({ key }) => key === "body");
  for (const fallback of FALLBACKS) if (body.length === 0) body = drawn.filter(({ key }) => key === fallback);
  if (body.length === 0) body = drawn;
  return { body: body.map(({ ref }) => ref), left: named.filter((one) => !body.includes(one)).map(({ name, type }) => name || type || "nameless") };
}
