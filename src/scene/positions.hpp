// SPDX-License-Identifier: Apache-2.0
// Positions and directions: stored in float, computed in double.
#pragma once

#include "core/glm.hpp"
#include "scene/scene_data.hpp"

namespace vantage {

inline glm::dvec3 to_glm(const Float3& v) { return {v.x, v.y, v.z}; }
inline Float3 to_float3(const glm::dvec3& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

// Turns −0 into 0, so that equal positions have equal bits.
inline Float3 without_minus_zero(const Float3& v) { return {v.x + 0.0F, v.y + 0.0F, v.z + 0.0F}; }

}  // namespace vantage
