// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench_site.hpp"

namespace vantage::bench {

struct ErrorOptions {
  SiteOptions site;
  std::string folder = ".";
  std::uint32_t networks = 8;    // on which errors are measured
  std::uint32_t population = 0;  // sampled in one submission; 0: the networks
  std::uint32_t drawn = 15;      // stations on the search area where none are given
  std::uint32_t seeds = 4;       // samples drawn, each of which errs in its own way
  double spread_m = 2;
  bool cpu_time = false;   // compare and draw the time of all cores, not that of the clock
  double patience_s = 20;  // a method slower than this is timed once
  std::vector<std::uint64_t> sizes{200, 500, 1'000, 2'000, 5'000, 10'000, 20'000, 50'000, 100'000, 200'000};
  std::vector<double> coarser{2, 4, 8};

  void add(CLI::App& command);
};

// Time a candidate against the error of its coverage and clustering coefficient: exact, sampled, and by coarser steps
// and voxels. Writes error.csv, and a picture an engine, error_ENGINE.svg and .png.
void run_error(const ErrorOptions& options);

}  // namespace vantage::bench
