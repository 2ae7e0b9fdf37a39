// SPDX-License-Identifier: Apache-2.0
// node records.mjs FILE FIRST COUNT FORMAT RECORD CHUNK: writes the records of a LAZ file to standard output,
// decompressed. Formats 6 to 10 become format 6, with only position, classification and flags. FIRST: byte of the
// points; RECORD: bytes of each; CHUNK: points of a chunk, or 4294967295. Exit codes of sysexits.h: 65 if the file is
// at fault, 69 if laz-perf is not installed, each with a line that says so.
import fs from "node:fs";
import { createRequire } from "node:module";
import { fileURLToPath } from "node:url";
import { chunkTable, DAMAGED } from "./chunk_table.mjs";

const [DATA, UNAVAILABLE, USAGE] = [65, 69, 64];
const LATE = { format: 6, record: 30, layers: 9 };
const LAYERS = { 6: 9, 7: 10, 8: 11, 9: 10, 10: 12 };  // of each late format, without extra bytes
const NEEDED_LAYERS = [0, 1, 2, 3];                    // returns with x and y, z, classification, flags

function fail(code, message) {
  fs.writeSync(2, `${message}\n`);
  process.exit(code);
}

const numbers = process.argv.slice(3).map(Number);
if (numbers.length !== 5 || !numbers.every(Number.isSafeInteger))
  fail(USAGE, "usage: node records.mjs FILE FIRST COUNT FORMAT RECORD CHUNK >records");
const [file, [first, count, format, record, chunk]] = [process.argv[2], numbers];
const late = format >= LATE.format;

let lazPerf;
try {
  const { createLazPerf } = createRequire(import.meta.url)("laz-perf");
  lazPerf = await createLazPerf({ print() {}, printErr() {} });
} catch {
  fail(UNAVAILABLE, `laz-perf is not there (npm ci in ${fileURLToPath(new URL(".", import.meta.url))})`);
}

const input = fs.openSync(file), size = fs.fstatSync(input).size;

function read(place, bytes) {
  if (!(place >= 0 && bytes >= 0 && place + bytes <= size)) throw new Error(DAMAGED);
  const buffer = Buffer.allocUnsafe(bytes);
  for (let at = 0; at < bytes;) {
    const got = fs.readSync(input, buffer, at, bytes - at, place + at);
    if (got === 0) throw new Error(DAMAGED);
    at += got;
  }
  return buffer;
}

function readChunks() {
  let place = Number(read(first, 8).readBigInt64LE());
  if (place < 0) place = Number(read(size - 8, 8).readBigInt64LE());  // file written in one pass
  const count_ = read(place, 8).readUInt32LE(4);
  if (count_ * (late ? LATE.record : record) > size) throw new Error(DAMAGED);  // a chunk begins with a raw point
  const bytes = Math.min(size - place - 8, 16 * count_ + 64);
  const chunks = count_ > 0 ? chunkTable(read(place + 8, bytes), count_, chunk) : [];
  if (chunks.reduce((sum, { bytes }) => sum + bytes, first + 8) > place) throw new Error(DAMAGED);  // it follows them
  return chunks;
}

// Memory of laz-perf for at least the requested bytes.
class Room {
  #pointer = 0;
  #bytes = 0;

  of(bytes) {
    if (bytes > this.#bytes) {
      if (this.#pointer) lazPerf._free(this.#pointer);
      this.#bytes = Math.ceil(1.5 * bytes);
      this.#pointer = lazPerf._malloc(this.#bytes);
      if (!this.#pointer) throw new Error("a chunk of its points does not fit into memory; decompress it to .las");
    }
    return this.#pointer;
  }
}

// Converts a chunk of a late format to one of format 6, with the needed layers.
function withNeededLayers(bytes) {
  const sizes = record + 4, extra = record - { 6: 30, 7: 36, 8: 38, 9: 59, 10: 67 }[format];
  const layers = LAYERS[format] + extra;
  const pieces = [bytes.subarray(0, LATE.record), bytes.subarray(record, sizes)];
  const table = Buffer.alloc(4 * LATE.layers), kept = [];
  for (let k = 0, at = sizes + 4 * layers; k < LATE.layers; ++k) {
    const length = bytes.readUInt32LE(sizes + 4 * k);
    if (at + length > bytes.length) throw new Error(DAMAGED);
    if (NEEDED_LAYERS.includes(k)) {
      table.writeUInt32LE(length, 4 * k);
      kept.push(bytes.subarray(at, at + length));
    }
    at += length;
  }
  return Buffer.concat([...pieces, table, ...kept]);
}

function write(bytes) {
  for (let at = 0; at < bytes.length;) {
    try {
      at += fs.writeSync(1, bytes, at);
    } catch (error) {
      if (error.code !== "EAGAIN") throw error;
    }
  }
}

const [AS, EACH] = late ? [LATE.format, LATE.record] : [format, record];
const MOST = 4096;

// Decodes a chunk, followed by bytes of `filler`, into which the decoder may read.
class Chunk {
  static SLACK = 64;
  #encoded = new Room();
  #decoded = new Room();
  #decoder;

  open(bytes, filler) {
    const pointer = this.#encoded.of(bytes.length + Chunk.SLACK);
    lazPerf.HEAPU8.set(bytes, pointer);
    lazPerf.HEAPU8.fill(filler, pointer + bytes.length, pointer + bytes.length + Chunk.SLACK);
    this.#decoder?.delete();
    this.#decoder = new lazPerf.ChunkDecoder();
    this.#decoder.open(AS, EACH, pointer);
  }

  next(points) {
    const to = this.#decoded.of(MOST * EACH);
    for (let k = 0; k < points; ++k) this.#decoder.getPoint(to + k * EACH);
    return lazPerf.HEAPU8.subarray(to, to + points * EACH);
  }
}

try {
  const chunks = readChunks(), chunk_ = new Chunk(), again = new Chunk();
  let left = count, place = first + 8;
  for (const { points, bytes } of chunks) {
    if (left === 0) break;
    const raw = read(place, bytes);
    place += bytes;
    // Late formats store the number of points of a chunk. The last chunk of an older format may have fewer than
    // announced; bytes behind it then decode to points.
    if (late && raw.readUInt32LE(record) < Math.min(points, left)) throw new Error(DAMAGED);
    const unsure = !late && points >= left;
    const encoded = late ? withNeededLayers(raw) : raw;
    chunk_.open(encoded, 0);
    if (unsure) again.open(encoded, 0xFF);
    for (let rest = Math.min(points, left); rest > 0;) {
      const now = Math.min(rest, MOST), records = chunk_.next(now);
      // Copies, as memory may move when the second one grows it.
      const copy = unsure ? Buffer.from(records) : records;
      if (unsure && !copy.equals(again.next(now))) throw new Error(DAMAGED);
      write(copy);
      rest -= now, left -= now;
    }
  }
  if (left > 0) throw new Error(DAMAGED);
} catch (error) {
  if (error.code === "EPIPE") process.exit(0);
  fail(DATA, error.constructor === Error ? error.message.split("\n")[0] : DAMAGED);
}
process.exit(0);
