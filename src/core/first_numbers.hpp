// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <numeric>
#include <vector>

namespace vantage {

// Returns `count` numbers, from `first` on.
template <class Number = std::size_t>
std::vector<Number> first_numbers(std::size_t count, Number first = 0) {
  std::vector<Number> numbers(count);
  std::iota(numbers.begin(), numbers.end(), first);
  return numbers;
}

}  // namespace vantage
