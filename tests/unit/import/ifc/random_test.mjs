// SPDX-License-Identifier: Apache-2.0
// What is read of random valid files equals the truth, or is told. VANTAGE_SEEDS=first..last chooses the files.
import assert from "node:assert/strict";
import { test } from "node:test";
import { random, randomSite } from "./random_site.mjs";
import { readBack } from "./read_back.mjs";

const CHORD_M = 0.005, CLOSE_M = 1e-3;

const [first, last] = (process.env.VANTAGE_SEEDS ?? "1..20").split("..").map(Number);
assert.ok(first <= last, "VANTAGE_SEEDS must be first..last");

for (let seed = first; seed <= last; ++seed)
  test(`random site ${seed}`, () => {
    const site = randomSite(seed), found = readBack(site.text);
    assert.equal(found.crs, site.crs);
    for (const [name, wanted] of site.products) {
      if (found.notes.some((note) => note.includes(` ${name} 0Made`))) continue;  // told
      const got = found.products.get(name);
      assert.ok(got, `${name} is lost in silence; notes: ${JSON.stringify(found.notes)}`);
      const size = Math.max(...wanted.max.map((v, i) => v - wanted.min[i])), off = CLOSE_M + CHORD_M * wanted.loose + 1e-6 * size;
      for (let i = 0; i < 3; ++i) {
        assert.ok(got.min[i] >= wanted.min[i] - CLOSE_M && got.min[i] <= wanted.min[i] + off + wanted.short, `${name} from ${"xyz"[i]} ${got.min[i]}, not ${wanted.min[i]}`);
        assert.ok(got.max[i] <= wanted.max[i] + CLOSE_M && got.max[i] >= wanted.max[i] - off - wanted.short, `${name} to ${"xyz"[i]} ${got.max[i]}, not ${wanted.max[i]}`);
      }
      assert.ok(Math.abs(got.volume / wanted.volume - 1) < 0.09, `${name} has ${got.volume} m³, not ${wanted.volume}`);
      assert.equal(got.glass > 0, wanted.glass, `${name} is glass`);
    }
  });

test("a seed gives the same file", () => {
  assert.equal(randomSite(7).text, randomSite(7).text);
  assert.notEqual(random(7).next(), random(8).next());
});
