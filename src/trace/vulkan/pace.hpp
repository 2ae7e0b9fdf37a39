// SPDX-License-Identifier: Apache-2.0
// How much work a submission takes: it follows the speed seen, and sizes submissions, never results.
#pragma once

#include <algorithm>

namespace vantage::vulkan {

class Pace {
 public:
  // Of submissions that take about `seconds`. It begins with `first` rays, and never asks for fewer than `least`.
  // Submissions of fewer rays than `telling`, and than half of what was asked for, do not tell the speed.
  Pace(double seconds, double first, double least, double telling)
      : seconds_(seconds), first_(first), least_(least), telling_(telling), rays_(first) {}

  double rays() const { return rays_; }
  void saw(double rays, double seconds) {
    if (!(seconds > 0)) return;
    if (rays >= std::min(telling_, 0.5 * rays_))
      // A few quick rays do not vouch for very many.
      rays_ = std::clamp(rays / seconds * seconds_, least_, std::min(most, step * std::max(rays_, rays)));
    else if (seconds > seconds_)
      rays_ = std::max(least_, rays_ * std::max(seconds_ / seconds, 1 / step));
    else if (seconds < seconds_ / step)
      rays_ = std::max(rays_, std::min(2 * rays_, first_));
  }

 private:
  static constexpr double step = 8, most = 1e12;
  double seconds_, first_, least_, telling_, rays_;
};

}  // namespace vantage::vulkan
