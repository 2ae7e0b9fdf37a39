// SPDX-License-Identifier: Apache-2.0
// Bounds on how far noise moves points, by distance. A sampled evaluation must search this far beyond a voxel's cube.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>

#include "core/normal_table.hpp"
#include "shared/noise_types.h"
#include "trace/tracer.hpp"

namespace vantage {

// Entry of row r and column c of the noise table: the farthest that noise moves a hit up to that distance, on a surface
// of at least that reflectivity. REQUIRES: model.enabled().
using NoiseReaches = std::array<std::array<float, NoiseModel::kSide>, NoiseModel::kSide>;
inline std::unique_ptr<const NoiseReaches> noise_reaches(const NoiseModel& model) {
  auto reaches = std::make_unique<NoiseReaches>();
  for (std::uint32_t r = NoiseModel::kSide; r-- > 0;)
    for (std::uint32_t c = 0; c < NoiseModel::kSide; ++c)
      (*reaches)[r][c] =
          std::max({model.sigma[r * NoiseModel::kSide + c] * (static_cast<float>(kNormalLimit) * (1 + 0x1p-20f)),
                    c > 0 ? (*reaches)[r][c - 1] : 0.0f, r + 1 < NoiseModel::kSide ? (*reaches)[r + 1][c] : 0.0f});
  return reaches;
}

// Bounds how far noise moves a hit nearer than t, on a surface of at least this reflectivity.
inline float reach_within(const NoiseModel& model, const NoiseReaches& reaches, float t, float reflectivity = 0) {
  constexpr auto kLast = static_cast<float>(NoiseModel::kSide - 1);
  const float column = (t - model.min_range) * model.inverse_span * kLast + 1.01f, row = reflectivity * kLast - 0.01f;
  return reaches[static_cast<std::size_t>(std::clamp(row, 0.0f, kLast))]
                [static_cast<std::size_t>(std::clamp(column, 0.0f, kLast))];
}

}  // namespace vantage
