// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "vantage/progress.hpp"

namespace vantage {

// Progress of one of several parts that take about equally long. Keeps a reference to `whole`.
inline Progress part_of(const Progress& whole, std::size_t part, std::size_t parts) {
  return {.report = [&whole, part,
                     parts](double done) { whole((static_cast<double>(part) + done) / static_cast<double>(parts)); },
          .stop = whole.stop};
}

}  // namespace vantage
