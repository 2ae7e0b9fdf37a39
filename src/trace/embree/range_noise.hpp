// SPDX-License-Identifier: Apache-2.0
// Algorithm 1: how far noise moves a point along its ray.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>

#include "core/normal_table.hpp"
#include "core/philox.hpp"
#include "trace/noise_reach.hpp"
#include "trace/tracer.hpp"

namespace vantage {

class RangeNoise {
 public:
  explicit RangeNoise(std::shared_ptr<const NoiseModel> model) : model_(std::move(model)), rows_(normal_table()) {
    if (enabled()) reaches_ = noise_reaches(*model_);
  }

  bool enabled() const { return model_ && model_->enabled(); }
  float reach() const { return enabled() ? model_->reach : 0.0f; }
  // Upper bound on how far noise moves a hit nearer than t.
  float reach_within(float t) const { return enabled() ? vantage::reach_within(*model_, reaches_, t) : 0.0f; }

  // Bilinear in normalised distance and reflectivity, both clamped to [0, 1].
  float sigma(float t, float reflectivity) const {
    constexpr std::uint32_t cells = NoiseModel::side - 1;
    const auto place = [](float normalised, std::uint32_t& cell) {
      const float clamped = normalised > 0.0f ? (normalised < 1.0f ? normalised : 1.0f) : 0.0f;
      const float scaled = clamped * static_cast<float>(cells);
      cell = static_cast<std::uint32_t>(scaled);
      if (cell >= cells) cell = cells - 1;
      return scaled - static_cast<float>(cell);
    };
    std::uint32_t column, row;
    const float across = place((t - model_->min_range) * model_->inverse_span, column);
    const float down = place(reflectivity, row);
    const float* s = model_->sigma.data() + row * NoiseModel::side + column;
    const float upper = s[0] + (s[1] - s[0]) * across;
    const float lower = s[NoiseModel::side] + (s[NoiseModel::side + 1] - s[NoiseModel::side]) * across;
    return upper + (lower - upper) * down;
  }

  // Random bits of n rays, from the halves of their numbers. REQUIRES: enabled().
  template <unsigned n>
  [[gnu::always_inline]] void draw(const std::uint32_t* low, const std::uint32_t* high, std::uint32_t place,
                                   std::uint32_t* __restrict bits) const {
    const std::uint64_t seed = model_->seed;
    for (unsigned k = 0; k < n; ++k) bits[k] = philox4x32(seed, {low[k], high[k], place, noise_stream})[0];
  }
  // REQUIRES: enabled(). No scanner measures a range below 0. Noise larger than the range leaves the point at the head,
  // never behind it, where no list of rays would look for it.
  float displaced(float t, float reflectivity, std::uint32_t bits) const {
    return std::max(0.0f, t + normal_from_bits(bits, rows_) * sigma(t, reflectivity));
  }
  float displaced(float t, float reflectivity, std::uint64_t ray, std::uint32_t place) const {
    const std::uint32_t low = static_cast<std::uint32_t>(ray), high = static_cast<std::uint32_t>(ray >> 32);
    std::uint32_t bits;
    draw<1>(&low, &high, place, &bits);
    return displaced(t, reflectivity, bits);
  }

 private:
  std::shared_ptr<const NoiseModel> model_;
  std::span<const float> rows_;
  NoiseReaches reaches_{};
};

}  // namespace vantage
