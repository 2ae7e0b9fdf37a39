// SPDX-License-Identifier: Apache-2.0
// GLM with one set of settings; no other file includes it. Public headers use Vec3 instead, converted by to_glm and
// to_vec3.
//
// Results are compared bit for bit, so GLM's rounding matters. dot, cross, length and a 3 × 3 matrix times a vector sum
// from x to z, each product rounded; normalize multiplies by 1 / length. A dmat4 times a vector sums in pairs, so
// points are transformed by transformed(). mix(a, b, t) is a·(1 − t) + b·t, not a + (b − a)·t.
#pragma once

#ifdef GLM_VERSION
#error "include core/glm.hpp instead of GLM's own headers"
#endif
#define GLM_FORCE_PURE           // no intrinsics, which sum in another order
#define GLM_FORCE_XYZW_ONLY      // plain members x, y, z, w
#define GLM_FORCE_EXPLICIT_CTOR  // no implicit rounding from double to float

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "vantage/types.hpp"

namespace vantage {

inline glm::dvec3 to_glm(const Vec3& v) { return {v.x, v.y, v.z}; }
inline Vec3 to_vec3(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

// Applies an affine transform to a point.
inline glm::dvec3 transformed(const glm::dmat4& b_from_a, const glm::dvec3& a) {
  return glm::dmat3(b_from_a) * a + glm::dvec3(b_from_a[3]);
}

}  // namespace vantage
