// SPDX-License-Identifier: Apache-2.0
// Khronos' validator finds no error in the scenes that vantage writes, nor in those of the tests named behind the
// program.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import validator from 'gltf-validator';

import { read, vantage } from './vantage.mjs';

const files = process.argv.slice(3).map((file) => [file, fs.readFileSync(file)]);
for (const name of ['three-walls', 'four-walls', 'industrial']) {
  vantage('generate', name, '-o', `${name}.glb`);
  files.push([name, read(`${name}.glb`)]);
}
// One that is cut short, to see that the validator says so.
const cut = await validator.validateBytes(new Uint8Array(files.at(-1)[1].subarray(0, -8)));
assert.ok(cut.issues.numErrors > 0);

for (const [name, bytes] of files) {
  const { issues, info } = await validator.validateBytes(new Uint8Array(bytes), { maxIssues: 0 });
  const grave = issues.messages.filter((m) => m.severity <= 1);  // errors and warnings
  const found = grave.slice(0, 20).map((m) => `${m.code} ${m.pointer}: ${m.message}`).join('\n');
  assert.equal(issues.numErrors, 0, `${name}:\n${found}`);
  assert.ok(info.totalTriangleCount > 0);
  console.log(`${name}: ${info.totalTriangleCount} triangles, ${issues.numWarnings} warnings, ${issues.numInfos} infos`);
  if (found) console.log(found);
}
