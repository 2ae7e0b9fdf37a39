// SPDX-License-Identifier: Apache-2.0
// Bound and achieved coverage, over the number of candidates.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bench_site.hpp"

namespace vantage::bench {

struct GapOptions {
  SiteOptions site;
  std::vector<std::size_t> counts{8, 12, 16}, candidates{64, 128, 256, 512, 1024};
  std::uint64_t sample = 5'000;
  std::string picture;
  void add(CLI::App& command);
};

void run_gap(const GapOptions& options);

}  // namespace vantage::bench
