// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench_site.hpp"

namespace vantage::bench {

struct PopulationOptions {
  SiteOptions site;
  std::uint32_t networks = 250;
  std::uint32_t against = 20;  // networks that are also evaluated exactly
  double spread_m = 3;
  std::vector<std::uint64_t> sizes{20'000, 100'000};

  void add(CLI::App& command);
};

// A population of networks around the given stations, each station moved by up to spread_m and clear of every mesh by
// half a metre: milliseconds a candidate, from positions to objectives, and the error against exact evaluation.
void run_population(const PopulationOptions& options);

}  // namespace vantage::bench
