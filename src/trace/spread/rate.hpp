// SPDX-License-Identifier: Apache-2.0
// How fast one has shown to be.
#pragma once

#include <cstddef>

namespace vantage {

class Rate {
 public:
  double items_a_second() const { return rate_; }  // 0: not seen yet

  // Large pieces tell more than small ones, of which most of the time may be what any piece takes: one of twice the
  // size that was learned from tells all, one of the same size half.
  void learn(std::size_t items, double seconds) {
    if (!(seconds > 0)) return;
    const auto size = static_cast<double>(items);
    const double weight = size >= 2 * size_ ? 1 : 0.5 * size / size_;
    rate_ += weight * (size / seconds - rate_);
    size_ += weight * (size - size_);
  }

 private:
  double rate_ = 0, size_ = 0;  // of the pieces learned from
};

}  // namespace vantage
