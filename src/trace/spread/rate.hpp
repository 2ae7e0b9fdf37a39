// SPDX-License-Identifier: Apache-2.0
// Measured rate of one worker.
#pragma once

#include <cstddef>

namespace vantage {

class Rate {
 public:
  double items_a_second() const { return rate_; }  // 0: not measured yet

  // Updates the rate. Large chunks weigh more, since a fixed cost may dominate small ones: a chunk of twice the size
  // learned from replaces the rate; one of the same size counts half.
  void learn(std::size_t items, double seconds) {
    if (!(seconds > 0)) return;
    const auto size = static_cast<double>(items);
    const double weight = size >= 2 * size_ ? 1 : 0.5 * size / size_;
    rate_ += weight * (size / seconds - rate_);
    size_ += weight * (size - size_);
  }

 private:
  double rate_ = 0, size_ = 0;  // of the chunks learned from
};

}  // namespace vantage
