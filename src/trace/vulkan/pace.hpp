// SPDX-License-Identifier: Apache-2.0
// How much work a submission takes: it follows the speed seen, and sizes submissions, never results.
#pragma once

#include <algorithm>

namespace vantage::vulkan {

class Pace {
 public:
  // Of submissions that take about `seconds`. It begins with `first` rays, and never asks for fewer than `least`.
  // Submissions of fewer rays than `telling` tell nothing of the speed.
  Pace(double seconds, double first, double least, double telling)
      : seconds_(seconds), least_(least), telling_(telling), rays_(first) {}

  double rays() const { return rays_; }
  void saw(double rays, double seconds) {
    constexpr double most = 1e12;
    if (rays < telling_ || !(seconds > 0)) return;
    rays_ = std::clamp(rays / seconds * seconds_, least_, most);
  }

 private:
  double seconds_, least_, telling_, rays_;
};

}  // namespace vantage::vulkan
