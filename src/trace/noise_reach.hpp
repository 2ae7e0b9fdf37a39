// SPDX-License-Identifier: Apache-2.0
// How far noise can move points, by how far away they are: what sampled evaluation must look beyond a voxel's cube.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "core/normal_table.hpp"
#include "trace/tracer.hpp"

namespace vantage {

// Column c of the noise table: no hit up to there is moved further than this. REQUIRES: model.enabled().
using NoiseReaches = std::array<float, NoiseModel::side>;
inline NoiseReaches noise_reaches(const NoiseModel& model) {
  NoiseReaches reaches{};
  for (std::uint32_t c = 0; c < NoiseModel::side; ++c) {
    float most = c > 0 ? reaches[c - 1] : 0.0f;
    for (std::uint32_t r = 0; r < NoiseModel::side; ++r)
      most = std::max(most, model.sigma[r * NoiseModel::side + c] * (static_cast<float>(normal_limit) * (1 + 0x1p-20f)));
    reaches[c] = most;
  }
  return reaches;
}

// No point of a hit nearer than t is moved further than this. `reach_within` in shaders/sample_list.comp is the same.
inline float reach_within(const NoiseModel& model, const NoiseReaches& reaches, float t) {
  const float scaled = (t - model.min_range) * model.inverse_span * static_cast<float>(NoiseModel::side - 1) + 1.01f;
  return reaches[scaled > 0 ? std::min(NoiseModel::side - 1, static_cast<std::uint32_t>(std::min(scaled, 1e6f))) : 0];
}

}  // namespace vantage
