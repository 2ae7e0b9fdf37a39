// SPDX-License-Identifier: Apache-2.0
// Affine maps in double precision: node transforms are composed with these before anything is rounded to float.
#pragma once

#include <cmath>

#include "vantage/types.hpp"

namespace vantage {

// Rows of a 3 × 4 matrix; y = linear · x + translation.
struct Affine {
  double m[3][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};

  Vec3 point(const Vec3& p) const {
    return {m[0][0] * p.x + m[0][1] * p.y + m[0][2] * p.z + m[0][3],
            m[1][0] * p.x + m[1][1] * p.y + m[1][2] * p.z + m[1][3],
            m[2][0] * p.x + m[2][1] * p.y + m[2][2] * p.z + m[2][3]};
  }
  Vec3 vector(const Vec3& v) const {
    return {m[0][0] * v.x + m[0][1] * v.y + m[0][2] * v.z, m[1][0] * v.x + m[1][1] * v.y + m[1][2] * v.z,
            m[2][0] * v.x + m[2][1] * v.y + m[2][2] * v.z};
  }
  Vec3 column(int c) const { return {m[0][c], m[1][c], m[2][c]}; }
  double determinant() const { return dot(column(0), cross(column(1), column(2))); }
  bool finite() const {
    for (const auto& row : m)
      for (const double value : row)
        if (!std::isfinite(value)) return false;
    return true;
  }
  // Maps normals as the inverse transpose does, up to a positive length: the cofactors, signed by the determinant,
  // which stay defined where the matrix flattens space.
  Affine normal_map() const {
    const double sign = determinant() < 0 ? -1.0 : 1.0;
    const Vec3 a = cross(column(1), column(2)) * sign, b = cross(column(2), column(0)) * sign,
               c = cross(column(0), column(1)) * sign;
    return {{{a.x, b.x, c.x, 0}, {a.y, b.y, c.y, 0}, {a.z, b.z, c.z, 0}}};
  }

  // c_from_a = c_from_b * b_from_a
  friend Affine operator*(const Affine& l, const Affine& r) {
    Affine out;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 4; ++j)
        out.m[i][j] =
            l.m[i][0] * r.m[0][j] + l.m[i][1] * r.m[1][j] + l.m[i][2] * r.m[2][j] + (j == 3 ? l.m[i][3] : 0.0);
    return out;
  }

  // (x, y, z) ↦ (x, −z, y): glTF's Y up becomes the survey frame's Z up.
  static Affine survey_from_gltf() { return {{{1, 0, 0, 0}, {0, 0, -1, 0}, {0, 1, 0, 0}}}; }
  // Translation · rotation (a unit quaternion x, y, z, w) · scale.
  static Affine from_trs(const Vec3& t, const double (&q)[4], const Vec3& s) {
    const double x = q[0], y = q[1], z = q[2], w = q[3];
    return {{{(1 - 2 * (y * y + z * z)) * s.x, 2 * (x * y - w * z) * s.y, 2 * (x * z + w * y) * s.z, t.x},
             {2 * (x * y + w * z) * s.x, (1 - 2 * (x * x + z * z)) * s.y, 2 * (y * z - w * x) * s.z, t.y},
             {2 * (x * z - w * y) * s.x, 2 * (y * z + w * x) * s.y, (1 - 2 * (x * x + y * y)) * s.z, t.z}}};
  }
};

}  // namespace vantage
