// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "vantage/progress.hpp"

namespace vantage {

// Progress of the part that goes from one share of the whole to another. Keeps a reference to `whole`.
inline Progress between(const Progress& whole, double from, double to) {
  return {.report = [&whole, from, to](double done) { whole(from + (to - from) * done); }, .stop = whole.stop};
}

// Progress of one of several parts that take about equally long. Keeps a reference to `whole`.
inline Progress part_of(const Progress& whole, std::size_t part, std::size_t parts) {
  const auto all = static_cast<double>(parts);
  return between(whole, static_cast<double>(part) / all, static_cast<double>(part + 1) / all);
}

}  // namespace vantage
