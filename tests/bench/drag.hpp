// SPDX-License-Identifier: Apache-2.0
// Time of the editor from the move of a station to new numbers and colours.
#pragma once

#include <cstdint>

#include "bench_site.hpp"

namespace vantage::bench {

struct DragOptions {
  SiteOptions site;
  std::size_t count = 8, moves = 60;
  std::uint64_t sample = 40'000, seed = 1;
  void add(CLI::App& command);
};

void run_drag(const DragOptions& options);

}  // namespace vantage::bench
