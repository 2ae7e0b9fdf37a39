// SPDX-License-Identifier: Apache-2.0
// Runs the program that is tested, in a folder of its own: node SCRIPT PROGRAM.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';

export const program = process.argv[2];
assert.ok(program, 'which program? node SCRIPT PROGRAM');

export const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'vantage-clients-'));
process.on('exit', () => fs.rmSync(folder, { recursive: true, force: true }));

export const at = (name) => path.join(folder, name);
export const read = (name) => fs.readFileSync(at(name));

// Standard output of a command that must succeed; files are named within the folder.
export function run(command, args) {
  const done = spawnSync(command, args, { cwd: folder, encoding: 'utf8', maxBuffer: 1 << 28 });
  if (done.error) throw new Error(`${command} cannot be run: ${done.error.message}`);
  assert.equal(done.status, 0, `${command} ${args.join(' ')}\n${done.stderr}`);
  return done.stdout;
}
export const vantage = (...args) => run(program, args);
