// SPDX-License-Identifier: Apache-2.0
// Vertices of a binary little-endian PLY file, an array of numbers a property.
export function readPly(bytes) {
  const end = bytes.indexOf('end_header\n') + 'end_header\n'.length;
  const lines = bytes.subarray(0, end).toString('latin1').split('\n');
  const kinds = {
    double: [8, (o) => bytes.readDoubleLE(o)],
    float: [4, (o) => bytes.readFloatLE(o)],
    uint: [4, (o) => bytes.readUInt32LE(o)],
    int: [4, (o) => bytes.readInt32LE(o)],
    ushort: [2, (o) => bytes.readUInt16LE(o)],
    uchar: [1, (o) => bytes.readUInt8(o)],
  };
  let count = 0;
  const properties = [];
  for (const words of lines.map((line) => line.split(' '))) {
    if (words[0] === 'element') count = Number(words[2]);
    if (words[0] === 'property') properties.push({ name: words[2], kind: kinds[words[1]], values: [] });
  }
  let offset = end;
  for (let k = 0; k < count; ++k)
    for (const { kind, values } of properties) {
      values.push(kind[1](offset));
      offset += kind[0];
    }
  if (offset !== bytes.length) throw new Error('the PLY file has another length than its header says');
  return Object.fromEntries(properties.map(({ name, values }) => [name, values]));
}
