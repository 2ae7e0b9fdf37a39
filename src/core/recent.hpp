// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <vector>

namespace vantage {

// The few of something dear to make that were used last: whoever takes turns with them makes each once.
template <class T>
class Recent {
 public:
  static constexpr std::size_t most = 4;

  // The one that fits, or else a new one in the place of that which was not used for longest. Valid until `most` others
  // were made.
  template <class Fits, class Make>
  T& get(const Fits& fits, const Make& make) {
    auto found = std::find_if(kept_.begin(), kept_.end(), [&](const std::unique_ptr<T>& one) { return fits(*one); });
    if (found == kept_.end()) {
      auto made = std::make_unique<T>(make());
      if (kept_.size() == most) kept_.pop_back();
      found = kept_.insert(kept_.end(), std::move(made));
    }
    std::rotate(kept_.begin(), found, found + 1);
    return *kept_.front();
  }

 private:
  std::vector<std::unique_ptr<T>> kept_;  // the latest first
};

}  // namespace vantage
