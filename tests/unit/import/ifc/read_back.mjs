// SPDX-License-Identifier: Apache-2.0
// Converts IFC text as the importer does, and measures what comes out.
import fs from "node:fs";
import os from "node:os";
import path from "node:path";
import { createRequire } from "node:module";

const importer = new URL("../../../../src/import/ifc/", import.meta.url);
const ifc = createRequire(new URL("import.mjs", importer))("web-ifc");
const { convert } = await import(new URL("convert.mjs", importer));
const api = new ifc.IfcAPI();
await api.Init();
api.SetLogLevel(ifc.LogLevel.LOG_LEVEL_OFF);

// {notes, crs, products}: by name {volume, area, min, max, glass}, lengths in metres, z up; glass is its area in m².
export function readBack(texts, unit) {
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), "ifc-"));
  try {
    const files = [texts].flat().map((text, k) => {
      const file = path.join(folder, `${"abcdef"[k]}.ifc`);
      fs.writeFileSync(file, text);
      return file;
    });
    return measure(convert(ifc, api, files, unit));
  } finally {
    fs.rmSync(folder, { recursive: true });
  }
}

function measure(glb) {
  const length = glb.readUInt32LE(12), json = JSON.parse(glb.subarray(20, 20 + length).toString()), bytes = glb.subarray(28 + length);
  const { notes, vantage } = json.asset.extras, products = new Map(), rooms = new Map();
  const array = (index) => {
    const { bufferView, count, componentType, type } = json.accessors[index], { byteOffset } = json.bufferViews[bufferView];
    const Type = componentType === 5126 ? Float32Array : Uint32Array, size = count * (type === "VEC3" ? 3 : 1);
    return new Type(bytes.buffer.slice(bytes.byteOffset + byteOffset, bytes.byteOffset + byteOffset + 4 * size));
  };
  for (const node of json.nodes) {
    const about = node.extras?.vantage ?? {}, name = about.name ?? node.name.split(" ")[1];
    if (about.box) rooms.set(name, about.box);
    if (node.mesh === undefined) continue;
    const m = node.matrix ?? [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];
    // Volumes are taken about the node's origin, which may be far away; what mirrors turns faces.
    const flip = Math.sign(m[0] * (m[5] * m[10] - m[9] * m[6]) - m[4] * (m[1] * m[10] - m[9] * m[2]) + m[8] * (m[1] * m[6] - m[5] * m[2]));
    const all = { volume: 0, area: 0, min: [Infinity, Infinity, Infinity], max: [-Infinity, -Infinity, -Infinity], glass: 0, id: about.id, class: about.class };
    for (const primitive of json.meshes[node.mesh].primitives) {
      const positions = array(primitive.attributes.POSITION), indices = array(primitive.indices), glass = json.materials?.[primitive.material]?.name === "glass";
      const corner = (i) => {
        const [x, y, z] = positions.subarray(3 * i, 3 * i + 3), p = [0, 1, 2].map((r) => m[r] * x + m[4 + r] * y + m[8 + r] * z);
        return [p[0], -p[2], p[1]];
      };
      for (let t = 0; t < indices.length; t += 3) {
        const [a, b, c] = [0, 1, 2].map((k) => corner(indices[t + k]));
        const n = [0, 1, 2].map((i) => (b[(i + 1) % 3] - a[(i + 1) % 3]) * (c[(i + 2) % 3] - a[(i + 2) % 3]) - (b[(i + 2) % 3] - a[(i + 2) % 3]) * (c[(i + 1) % 3] - a[(i + 1) % 3]));
        all.volume += flip * (a[0] * n[0] + a[1] * n[1] + a[2] * n[2]) / 6;
        all.area += Math.hypot(...n) / 2;
        if (glass) all.glass += Math.hypot(...n) / 2;
        for (const p of [a, b, c]) for (let i = 0; i < 3; ++i) {
          const v = p[i] + [m[12], -m[14], m[13]][i];
          all.min[i] = Math.min(all.min[i], v), all.max[i] = Math.max(all.max[i], v);
        }
      }
    }
    products.set(name, all);
  }
  return { notes, crs: vantage.crs ?? "", place: vantage.model_in_site, products, rooms };
}
