// SPDX-License-Identifier: Apache-2.0
// Scaling of a search over the ranks of a job. Figures measured on one machine go into a model of up to 1 024 ranks,
// and are drawn. Started by `mpirun`, it compares the model with ranks that take as long without computing.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bench_site.hpp"

namespace vantage::bench {

struct RanksOptions {
  SiteOptions site;
  std::vector<std::size_t> populations{250, 1'000, 4'000}, ranks{1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1'024};
  std::uint64_t sample = 20'000;
  std::size_t networks = 32;
  double spread_m = 0.3;
  double round_trip_us = 100, gbit = 10;
  std::optional<double> network_ms;
  std::string picture;
  void add(CLI::App& command);
};

void run_ranks(const RanksOptions& options);

}  // namespace vantage::bench
