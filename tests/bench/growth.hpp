// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench_site.hpp"

namespace vantage::bench {

struct GrowthOptions {
  std::string folder;  // empty: standard output alone
  std::vector<std::string> engines;
  // The settings in the middle, from which one quantity at a time departs.
  std::uint64_t base_triangles = 300'000, base_sample = 20'000;
  std::uint32_t base_stations = 15;
  double base_user_size_m = 0.04;
  std::vector<std::uint64_t> triangles{20'000, 300'000}, samples{5'000, 20'000, 100'000, 500'000};
  std::vector<std::uint32_t> stations{1, 4, 15, 64};
  std::vector<double> user_sizes_m{0.08, 0.04, 0.02, 0.01};
  double step_deg = 0.0286, spacing_m = 0.005;
  std::uint32_t population = 16, repeats = 3;

  void add(CLI::App& command);
};

// Time and memory on industrial sites, each line in a process of its own, so that its memory is its own.
void run_growth(const GrowthOptions& options);

}  // namespace vantage::bench
