// SPDX-License-Identifier: Apache-2.0
// Bounds on how far noise moves points, by distance. Sampled evaluation must look that far beyond a voxel's cube.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "core/normal_table.hpp"
#include "shared/noise_types.h"
#include "trace/tracer.hpp"

namespace vantage {

// Column c of the noise table: noise moves no hit up to that distance further than this. REQUIRES: model.enabled().
using NoiseReaches = std::array<float, NoiseModel::side>;
inline NoiseReaches noise_reaches(const NoiseModel& model) {
  NoiseReaches reaches{};
  for (std::uint32_t c = 0; c < NoiseModel::side; ++c) {
    float most = c > 0 ? reaches[c - 1] : 0.0f;
    for (std::uint32_t r = 0; r < NoiseModel::side; ++r)
      most =
          std::max(most, model.sigma[r * NoiseModel::side + c] * (static_cast<float>(normal_limit) * (1 + 0x1p-20f)));
    reaches[c] = most;
  }
  return reaches;
}

// Upper bound on how far noise moves a hit nearer than t.
inline float reach_within(const NoiseModel& model, const NoiseReaches& reaches, float t) {
  constexpr auto last = static_cast<float>(NoiseModel::side - 1);
  const float column = (t - model.min_range) * model.inverse_span * last + 1.01f;
  return reaches[static_cast<std::size_t>(std::clamp(column, 0.0f, last))];
}

}  // namespace vantage
