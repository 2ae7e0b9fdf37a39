// SPDX-License-Identifier: Apache-2.0
// Puts a GLB's scene elsewhere: all root nodes below one that moves them, by (x, y, z) of the survey frame.
const pad = (buffer, fill) => Buffer.concat([buffer, Buffer.alloc((4 - (buffer.length % 4)) % 4, fill)]);

export function moved(glb, [x, y, z]) {
  const jsonBytes = glb.readUInt32LE(12);
  const json = JSON.parse(glb.subarray(20, 20 + jsonBytes).toString());
  const rest = glb.subarray(20 + jsonBytes);
  const scene = json.scenes[json.scene ?? 0];
  // glTF has Y up: east, up, south.
  json.nodes.push({ name: 'site', translation: [x, z, -y], children: scene.nodes });
  scene.nodes = [json.nodes.length - 1];
  const text = pad(Buffer.from(JSON.stringify(json)), ' ');
  const head = Buffer.alloc(20);
  glb.copy(head, 0, 0, 20);
  head.writeUInt32LE(20 + text.length + rest.length, 8);
  head.writeUInt32LE(text.length, 12);
  return Buffer.concat([head, text, rest]);
}
