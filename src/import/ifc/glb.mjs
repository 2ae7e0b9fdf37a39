// SPDX-License-Identifier: Apache-2.0
// Collects the content of a GLB and returns its bytes.

const FLOAT = 5126, UNSIGNED_INT = 5125;

export class Glb {
  constructor() {
    this.parts = [];
    this.size = 0;
    this.views = [];
    this.accessors = [];
  }

  #add(array, count, componentType, type, more = {}) {
    const bytes = Buffer.from(array.buffer, array.byteOffset, array.byteLength);  // four-byte numbers keep it aligned
    this.views.push({ buffer: 0, byteOffset: this.size, byteLength: bytes.length });
    this.parts.push(bytes);
    this.size += bytes.length;
    return this.accessors.push({ bufferView: this.views.length - 1, componentType, count, type, ...more }) - 1;
  }

  positions(xyz) {
    const min = [Infinity, Infinity, Infinity], max = [-Infinity, -Infinity, -Infinity];
    for (let c = 0; c < 3; ++c)
      for (let i = c; i < xyz.length; i += 3) {
        if (xyz[i] < min[c]) min[c] = xyz[i];
        if (xyz[i] > max[c]) max[c] = xyz[i];
      }
    return this.#add(xyz, xyz.length / 3, FLOAT, "VEC3", { min, max });
  }

  indices(values) {
    return this.#add(values, values.length, UNSIGNED_INT, "SCALAR");
  }

  bytes(document) {
    let text = Buffer.from(JSON.stringify({
      ...document, accessors: this.accessors, bufferViews: this.views, buffers: [{ byteLength: this.size }],
    }));
    text = Buffer.concat([text, Buffer.alloc((4 - text.length % 4) % 4, " ")]);
    const total = 12 + 8 + text.length + 8 + this.size;
    if (total >= 2 ** 32) throw new Error("as glTF the model would take more than the 4 GiB that a GLB holds; export parts of it");
    const words = (...values) => Buffer.from(Uint32Array.from(values).buffer);
    return Buffer.concat([words(0x46546c67, 2, total, text.length, 0x4e4f534a), text, words(this.size, 0x004e4942), ...this.parts]);
  }
}
