// SPDX-License-Identifier: Apache-2.0
// Share of the 95 % intervals of a sampled evaluation that hold the value by every ray.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bench_site.hpp"

namespace vantage::bench {

struct IntervalsOptions {
  SiteOptions site;
  std::string front;  // a plan's front.json, whose networks take turns; empty: random ones
  std::uint32_t networks = 200;
  std::uint32_t stations = 15;  // at most; at least three
  std::uint32_t draws = 40;     // samples drawn; the networks take turns
  std::vector<std::uint64_t> sizes{5'000, 20'000, 100'000};
  void add(CLI::App& command);
};

void run_intervals(const IntervalsOptions& options);

}  // namespace vantage::bench
