// SPDX-License-Identifier: Apache-2.0
// Reads the chunk table of LAZ, which laz-perf reads only if the whole file is in memory. Its numbers are coded
// arithmetically (Said: Introduction to Arithmetic Coding, 2004; Isenburg: LASzip: lossless compression of LiDAR data,
// 2013): the difference to the number before, as its length in bits and the bits.

export const DAMAGED = "it is truncated, or its chunks of compressed points are damaged; copy or export it again";
const LEAST_LENGTH = 2 ** 24;

// Frequencies of `count` symbols.
class Symbols {
  static BITS = 15;

  constructor(count) {
    this.counts = new Array(count).fill(1);
    this.starts = new Array(count);
    this.total = 0;
    this.cycle = count;
    this.#update();
    this.cycle = this.left = (count + 6) >> 1;
  }

  seen(symbol) {
    ++this.counts[symbol];
    if (--this.left === 0) this.#update();
  }

  #update() {
    this.total += this.cycle;
    if (this.total > 2 ** Symbols.BITS) {
      this.counts = this.counts.map((count) => (count + 1) >> 1);
      this.total = this.counts.reduce((sum, count) => sum + count, 0);
    }
    const scale = Math.floor(2 ** 31 / this.total);
    let sum = 0;
    this.counts.forEach((count, symbol) => {
      this.starts[symbol] = Math.floor((scale * sum) / 2 ** (31 - Symbols.BITS));
      sum += count;
    });
    this.cycle = Math.min((5 * this.cycle) >> 2, (this.counts.length + 6) << 3);
    this.left = this.cycle;
  }
}

// Frequency of a bit being 0.
class Bit {
  static BITS = 13;

  constructor() {
    Object.assign(this, { zeros: 1, total: 2, zero: 2 ** (Bit.BITS - 1), cycle: 4, left: 4 });
  }

  seen(bit) {
    if (bit === 0) ++this.zeros;
    if (--this.left > 0) return;
    this.total += this.cycle;
    if (this.total > 2 ** Bit.BITS) {
      this.total = (this.total + 1) >> 1;
      this.zeros = (this.zeros + 1) >> 1;
      if (this.zeros === this.total) ++this.total;
    }
    this.zero = Math.floor((this.zeros * Math.floor(2 ** 31 / this.total)) / 2 ** (31 - Bit.BITS));
    this.cycle = Math.min((5 * this.cycle) >> 2, 64);
    this.left = this.cycle;
  }
}

class Decoder {
  constructor(bytes) {
    this.bytes = bytes;
    this.at = 0;
    this.length = 2 ** 32 - 1;
    this.value = 0;
    for (let k = 0; k < 4; ++k) this.value = this.value * 256 + this.#byte();
  }

  symbol(model) {
    const unit = Math.floor(this.length / 2 ** Symbols.BITS);
    let symbol = model.starts.length - 1;
    while (symbol > 0 && model.starts[symbol] * unit > this.value) --symbol;
    const start = model.starts[symbol] * unit;
    const end = symbol + 1 < model.starts.length ? model.starts[symbol + 1] * unit : this.length;
    this.#take(start, end - start);
    model.seen(symbol);
    return symbol;
  }

  bit(model) {
    const end = model.zero * Math.floor(this.length / 2 ** Bit.BITS), bit = this.value < end ? 0 : 1;
    if (bit === 0) this.#take(0, end);
    else this.#take(end, this.length - end);
    model.seen(bit);
    return bit;
  }

  bits(count) {
    if (count > 19) return this.bits(16) + this.bits(count - 16) * 2 ** 16;
    const unit = Math.floor(this.length / 2 ** count), bits = Math.floor(this.value / unit);
    this.#take(bits * unit, unit);
    return bits;
  }

  // Writers append as many bytes as readers request.
  #byte() {
    if (this.at >= this.bytes.length) throw new Error(DAMAGED);
    return this.bytes[this.at++];
  }

  #take(start, length) {
    this.value -= start;
    this.length = length;
    while (this.length < LEAST_LENGTH) {
      this.value = this.value * 256 + this.#byte();
      this.length *= 256;
      if (this.length <= 0) throw new Error(DAMAGED);
    }
  }
}

// 32-bit integers, each near the previous one in its context.
class Numbers {
  static CODED_BITS = 8;

  constructor(decoder, contexts) {
    this.decoder = decoder;
    this.lengths = Array.from({ length: contexts }, () => new Symbols(33));
    this.ones = new Bit();
    this.high = Array.from({ length: 33 }, (_, k) => (k > 0 ? new Symbols(2 ** Math.min(k, Numbers.CODED_BITS)) : null));
  }

  next(before, context) {
    const { decoder } = this, length = decoder.symbol(this.lengths[context]);
    let difference;
    if (length === 0) {
      difference = decoder.bit(this.ones);
    } else if (length === 32) {
      difference = -(2 ** 31);
    } else {
      const low = Math.max(0, length - Numbers.CODED_BITS);
      difference = decoder.symbol(this.high[length]) * 2 ** low + (low > 0 ? decoder.bits(low) : 0);
      difference += difference >= 2 ** (length - 1) ? 1 : 1 - 2 ** length;
    }
    return (before + difference) >>> 0;
  }
}

// Returns points and bytes of each of `count` chunks, from the bytes behind the table's head. `points`: of each chunk;
// 2^32 - 1 if the table tells them.
export function chunkTable(bytes, count, points) {
  const decoder = new Decoder(bytes), numbers = new Numbers(decoder, 2), chunks = [];
  for (let k = 0, size = 0, told = 0; k < count; ++k) {
    if (points === 2 ** 32 - 1) told = numbers.next(told, 0);
    size = numbers.next(size, 1);
    chunks.push({ points: points === 2 ** 32 - 1 ? told : points, bytes: size });
  }
  return chunks;
}
