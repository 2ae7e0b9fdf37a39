// SPDX-License-Identifier: Apache-2.0
// Sizes submissions by measured speed; never affects results.
#pragma once

#include <algorithm>

namespace vantage::vulkan {

class DispatchSizer {
 public:
  // Aims at submissions of about `seconds`. It begins with `first` rays, and never asks for fewer than `least`.
  // Submissions below `telling` rays, and below half of what was asked for, are too small to measure the speed.
  DispatchSizer(double seconds, double first, double least, double telling)
      : seconds_(seconds), first_(first), least_(least), telling_(telling), rays_(first) {}

  double rays() const { return rays_; }
  void observe(double rays, double seconds) {
    if (!(seconds > 0)) return;
    if (rays >= std::min(telling_, 0.5 * rays_))
      // A fast small submission allows only a limited step.
      rays_ = std::clamp(rays / seconds * seconds_, least_, std::min(kMost, kStep * std::max(rays_, rays)));
    else if (seconds > seconds_)
      rays_ = std::max(least_, rays_ * std::max(seconds_ / seconds, 1 / kStep));
    else if (seconds < seconds_ / kStep)
      rays_ = std::max(rays_, std::min(2 * rays_, first_));
  }

 private:
  static constexpr double kStep = 8, kMost = 1e12;
  double seconds_, first_, least_, telling_, rays_;
};

}  // namespace vantage::vulkan
