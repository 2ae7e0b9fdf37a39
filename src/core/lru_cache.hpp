// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <vector>

namespace vantage {

// Least-recently-used cache of a few expensive objects.
template <class T>
class LruCache {
 public:
  static constexpr std::size_t kMostKept = 4;

  // Returns the object that fits, or makes one in place of the least recently used. Valid until `kMostKept` others were
  // made.
  template <class Fits, class Make>
  T& get(const Fits& fits, const Make& make) {
    auto found = std::find_if(kept_.begin(), kept_.end(), [&](const std::unique_ptr<T>& one) { return fits(*one); });
    if (found == kept_.end()) {
      auto made = std::make_unique<T>(make());
      if (kept_.size() == kMostKept) kept_.pop_back();
      found = kept_.insert(kept_.end(), std::move(made));
    }
    std::rotate(kept_.begin(), found, found + 1);
    return *kept_.front();
  }

 private:
  std::vector<std::unique_ptr<T>> kept_;  // latest first
};

}  // namespace vantage
