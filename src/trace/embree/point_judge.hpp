// SPDX-License-Identifier: Apache-2.0
// Checks the limits of points, in double precision.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>

#include "core/philox.hpp"
#include "shared/noise_types.h"
#include "trace/embree/range_noise.hpp"
#include "trace/tracer.hpp"

namespace vantage {

class PointJudge {
 public:
  // `model` may be null.
  explicit PointJudge(std::shared_ptr<const LimitModel> model)
      : model_(std::move(model)), noise_(model_ ? model_->noise : nullptr) {}

  bool enabled() const { return model_ && model_->enabled(); }

  // Returns true if only echoes are limited.
  bool judges_echo_alone() const {
    return enabled() && model_->lost_below == 0 &&
           std::ranges::all_of(model_->meshes, [](const LimitModel::Limits& limits) {
             return limits == LimitModel::Limits{.largest_reach_square = limits.largest_reach_square};
           });
  }
  // Returns the squared distance at which an echo at normal incidence is just detected; 0: any. REQUIRES: enabled().
  double reach_square(std::uint32_t mesh) const {
    return static_cast<double>(model_->meshes[mesh].largest_reach_square);
  }
  static bool detected(double reach_square, double cosine, float t) {
    return static_cast<double>(t) * static_cast<double>(t) <= reach_square * std::abs(cosine);
  }

  bool loses_echoes() const { return model_ && model_->lost_below > 0; }
  // Returns true if the echo of this ray is lost at random.
  bool lost(std::uint64_t ray, std::uint32_t place) const {
    return loses_echoes() && random_bits(model_->seed, ray, place, dropout_stream) < model_->lost_below;
  }

  // Returns the limits of its mesh that a point misses; all 0 if it counts. `cosine`: between ray and normal, of either
  // sign; `t`: distance without noise; `passed`: share of the echo that passes glass. REQUIRES: enabled().
  DroppedPoints missed(std::uint32_t mesh, double cosine, float t, float reflectivity, double passed) const {
    const LimitModel::Limits& limits = model_->meshes[mesh];
    const double square = cosine * cosine;
    const double exit = static_cast<double>(model_->exit_diameter),
                 widened = static_cast<double>(model_->divergence) * static_cast<double>(t);
    DroppedPoints dropped;
    dropped.incidence = square < static_cast<double>(limits.least_cosine_square);
    dropped.footprint = limits.largest_footprint_square > 0 &&
                        exit * exit + widened * widened > static_cast<double>(limits.largest_footprint_square) * square;
    dropped.noise = limits.largest_sigma > 0 && noise_.sigma(t, reflectivity) > limits.largest_sigma;
    dropped.echo = limits.largest_reach_square > 0 && !detected(reach_square(mesh) * passed, cosine, t);
    dropped.points = dropped.incidence + dropped.footprint + dropped.noise + dropped.echo > 0;
    return dropped;
  }

 private:
  std::shared_ptr<const LimitModel> model_;
  RangeNoise noise_;
};

}  // namespace vantage
