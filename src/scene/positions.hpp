// SPDX-License-Identifier: Apache-2.0
// Positions and directions: stored in float, computed in double.
#pragma once

#include <array>
#include <cstdint>

#include "core/glm.hpp"
#include "scene/scene_data.hpp"

namespace vantage {

inline glm::dvec3 to_glm(const Float3& v) { return {v.x, v.y, v.z}; }
inline Float3 to_float3(const glm::dvec3& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

// Returns the corners of a triangle of the scene, local frame.
inline std::array<glm::dvec3, 3> corners_of(const SceneData& scene, std::uint32_t triangle) {
  const auto p = scene.corners(triangle);
  return {to_glm(p[0]), to_glm(p[1]), to_glm(p[2])};
}

// Returns the box around two others, of which either may be empty.
inline Box united(Box a, const Box& b) {
  if (!b.empty()) a.extend(b.min), a.extend(b.max);
  return a;
}

// Returns the survey frame's (x, y, z) of a vector that was read by glTF's rule (Y up), if another axis of the file is
// up. X up is as in COLLADA: −y is to the right, z towards the viewer.
inline glm::dvec3 with_up(UpAxis up, const glm::dvec3& v) {
  switch (up) {
    case UpAxis::x: return {-v.z, v.y, v.x};
    case UpAxis::y: return v;
    case UpAxis::z: return {v.x, v.z, -v.y};
  }
  return v;
}

// Turns −0 into 0, so that equal positions have equal bits.
inline Float3 without_minus_zero(const Float3& v) { return {v.x + 0.0F, v.y + 0.0F, v.z + 0.0F}; }

}  // namespace vantage
