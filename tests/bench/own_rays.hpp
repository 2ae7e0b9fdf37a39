// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "bench_site.hpp"

namespace vantage::bench {

struct OwnRaysOptions {
  SiteOptions site;
  std::size_t most = std::size_t{1} << 24;  // rays of a whole call
  std::size_t batch = 0;                    // rays that a device alone has at once; 0: as many as in whole calls

  void add(CLI::App& command);
};

// Prints CSV lines: rates of counting every ray of the first station, and of the same rays as a caller's own, in
// several orders: on each device alone, and for whole calls of RayTracer. Best of the repeats, which take turns.
void run_own_rays(const OwnRaysOptions& options);

}  // namespace vantage::bench
