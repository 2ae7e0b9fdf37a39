// SPDX-License-Identifier: Apache-2.0
// Algorithm 1: moves a point along its ray by noise.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>

#include "core/normal_table.hpp"
#include "core/philox.hpp"
#include "trace/embree/vectors.hpp"
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
  // Bounds how far noise moves a hit nearer than t, on a surface of at least this reflectivity.
  float reach_within(float t, float reflectivity = 0) const {
    return enabled() ? vantage::reach_within(*model_, *reaches_, t, reflectivity) : 0.0f;
  }

  // Interpolates bilinearly in normalised distance and reflectivity, both clamped to [0, 1].
  float sigma(float t, float reflectivity) const {
    constexpr std::uint32_t kCells = NoiseModel::kSide - 1;
    const auto place = [](float normalised, std::uint32_t& cell) {
      const float clamped = normalised > 0.0f ? (normalised < 1.0f ? normalised : 1.0f) : 0.0f;
      const float scaled = clamped * static_cast<float>(kCells);
      cell = static_cast<std::uint32_t>(scaled);
      if (cell >= kCells) cell = kCells - 1;
      return scaled - static_cast<float>(cell);
    };
    std::uint32_t column, row;
    const float across = place((t - model_->min_range) * model_->inverse_span, column);
    const float down = place(reflectivity, row);
    const float* s = model_->sigma.data() + row * NoiseModel::kSide + column;
    const float upper = s[0] + (s[1] - s[0]) * across;
    const float lower = s[NoiseModel::kSide] + (s[NoiseModel::kSide + 1] - s[NoiseModel::kSide]) * across;
    return upper + (lower - upper) * down;
  }

  // Draws random bits for n rays, from the halves of their numbers. REQUIRES: enabled().
  template <unsigned n>
  [[gnu::always_inline]] void draw(const std::uint32_t* low, const std::uint32_t* high, std::uint32_t place,
                                   std::uint32_t* __restrict bits) const {
    const std::uint64_t seed = model_->seed;
    for (unsigned k = 0; k < n; ++k) bits[k] = philox4x32(seed, {low[k], high[k], place, noise_stream})[0];
  }
  // Returns the noisy range. It is never below 0: noise larger than the range leaves the point at the head, not behind
  // it, where no list of rays would look for it. REQUIRES: enabled().
  float displaced(float t, float reflectivity, std::uint32_t bits) const {
    return std::max(0.0f, t + normal_from_bits(bits, rows_) * sigma(t, reflectivity));
  }
  // Computes sigma() of eight hits, to the bit. Inlined, to be compiled for the caller's target. REQUIRES: enabled().
  [[gnu::always_inline]] void find_sigmas(const float* t, const float* reflectivity, Floats8& sigmas) const {
    Floats8 ts, reflectivities, across, down;
    Ints8 column, row;
    load(ts, t);
    load(reflectivities, reflectivity);
    find_place((ts - model_->min_range) * model_->inverse_span, column, across);
    find_place(reflectivities, row, down);
    const Ints8 first = row * static_cast<std::int32_t>(NoiseModel::kSide) + column;
    Floats4 corners[8];
    for (int k = 0; k < 8; ++k) {
      const float* const s = model_->sigma.data() + first[k];
      corners[k] = Floats4{s[0], s[1], s[NoiseModel::kSide], s[NoiseModel::kSide + 1]};
    }
    Floats8 s[4];
    transpose(corners, s);
    const Floats8 upper = s[0] + (s[1] - s[0]) * across, lower = s[2] + (s[3] - s[2]) * across;
    sigmas = upper + (lower - upper) * down;
  }
  // Computes displaced() of eight hits with these deviations, to the bit. Inlined likewise. REQUIRES: enabled().
  [[gnu::always_inline]] void displace_eight(const float* t, const Floats8& sigmas, const std::uint32_t* bits,
                                             float* range) const {
    Floats8 ts, z;
    load(ts, t);
    find_normals(bits, z);
    const Floats8 moved = ts + z * sigmas;
    store(range, moved > 0.0f ? moved : Floats8{});
  }
  float displaced(float t, float reflectivity, std::uint64_t ray, std::uint32_t place) const {
    const std::uint32_t low = static_cast<std::uint32_t>(ray), high = static_cast<std::uint32_t>(ray >> 32);
    std::uint32_t bits;
    draw<1>(&low, &high, place, &bits);
    return displaced(t, reflectivity, bits);
  }

 private:
  // Finds the cell, and the position in it, at which sigma() interpolates, for eight values.
  [[gnu::always_inline]] static void find_place(const Floats8& normalised, Ints8& cell, Floats8& part) {
    constexpr std::int32_t kCells = NoiseModel::kSide - 1;
    const Floats8 below = normalised < 1.0f ? normalised : 1.0f - Floats8{};
    const Floats8 scaled = (normalised > 0.0f ? below : Floats8{}) * static_cast<float>(kCells);
    const Ints8 whole = __builtin_convertvector(scaled, Ints8);
    cell = whole >= kCells ? kCells - 1 - Ints8{} : whole;
    part = scaled - __builtin_convertvector(cell, Floats8);
  }
  // Computes normal_from_bits() of eight. As a double, m has its highest bit e in the exponent, the lower bits follow.
  [[gnu::always_inline]] void find_normals(const std::uint32_t* bits, Floats8& z) const {
    static_assert(normal_segments == 16);
    Ints8 u;
    load(u, bits);
    const Ints8 m = u & 0x7FFFFFFF;
    const Doubles4 low = __builtin_convertvector(__builtin_shufflevector(m, m, 0, 1, 2, 3), Doubles4),
                   high = __builtin_convertvector(__builtin_shufflevector(m, m, 4, 5, 6, 7), Doubles4);
    Longs4 low_bits, high_bits;
    load(low_bits, &low);
    load(high_bits, &high);
    Ints8 row, fraction;
    narrow(low_bits >> 48, high_bits >> 48, row);
    narrow(low_bits >> 24, high_bits >> 24, fraction);
    row = m == 0 ? static_cast<std::int32_t>(normal_octaves * normal_segments) - Ints8{} : row - (1023 << 4);
    const Floats8 f = __builtin_convertvector(fraction & 0xFFFFFF, Floats8) * 0x1p-24f;
    Floats4 cubic[8];
    for (int k = 0; k < 8; ++k) load(cubic[k], rows_.data() + 4 * row[k]);
    Floats8 c[4];
    transpose(cubic, c);
    const Floats8 size = ((c[3] * f + c[2]) * f + c[1]) * f + c[0];
    z = u < 0 ? -size : size;
  }

  std::shared_ptr<const NoiseModel> model_;
  std::span<const float> rows_;
  std::shared_ptr<const NoiseReaches> reaches_;
};

}  // namespace vantage
