// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "bench_site.hpp"

namespace vantage::bench {

struct RatesOptions {
  SiteOptions site;
  std::uint32_t first = 0;  // only so many stations; 0: all
  bool unsorted = false;    // also the driver's structure over triangles in file order
  std::vector<std::string> glass;
  std::string shared_meshes = "auto";
  double detection_m = 0;  // on R = 0.5; 0: every echo is detected

  void add(CLI::App& command);
};

// Prints a CSV line an engine and way, best of the repeats, which take turns.
void run_rates(const RatesOptions& options);

}  // namespace vantage::bench
