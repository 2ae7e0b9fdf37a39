// SPDX-License-Identifier: Apache-2.0
// Affine maps as 16 numbers, column by column.

export function transformed(m, x, y, z) {
  return [m[0] * x + m[4] * y + m[8] * z + m[12], m[1] * x + m[5] * y + m[9] * z + m[13],
    m[2] * x + m[6] * y + m[10] * z + m[14]];
}

export function product(a, b) {
  const out = [];
  for (let column = 0; column < 4; ++column)
    for (let row = 0; row < 4; ++row) {
      let sum = 0;
      for (let k = 0; k < 4; ++k) sum += a[4 * k + row] * b[4 * column + k];
      out.push(sum);
    }
  return out;
}

export const identity = () => [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];

// Returns a value below 0 if the map mirrors.
export const determinant = (m) => m[0] * (m[5] * m[10] - m[9] * m[6]) - m[4] * (m[1] * m[10] - m[9] * m[2]) + m[8] * (m[1] * m[6] - m[5] * m[2]);

const OTHERS = [[1, 2], [0, 2], [0, 1]];

// Returns null if the map is singular.
export function inverse(m) {
  const minor = (i, j) => {  // of the upper left 3 by 3, row i and column j
    const [a, b] = OTHERS[i], c = 4 * OTHERS[j][0], d = 4 * OTHERS[j][1];
    return ((i + j) % 2 ? -1 : 1) * (m[c + a] * m[d + b] - m[d + a] * m[c + b]);
  };
  const determinant = m[0] * minor(0, 0) + m[4] * minor(0, 1) + m[8] * minor(0, 2);
  if (!(Math.abs(determinant) > 1e-12)) return null;
  const out = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1];
  for (let row = 0; row < 3; ++row)
    for (let column = 0; column < 3; ++column) out[4 * column + row] = minor(column, row) / determinant;
  const [x, y, z] = transformed(out, m[12], m[13], m[14]);
  [out[12], out[13], out[14]] = [-x, -y, -z];
  return out;
}
