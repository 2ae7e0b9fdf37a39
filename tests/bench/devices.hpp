// SPDX-License-Identifier: Apache-2.0
// Growth of the rate of evaluation with the number of devices that share it.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <vector>

#include "bench_site.hpp"

namespace vantage::bench {

struct DevicesOptions {
  SiteOptions site;
  std::vector<std::uint32_t> devices{1, 2, 4, 8};   // numbers of devices; more than there are are left out
  std::vector<std::size_t> populations{250, 1000};  // networks of a sampled evaluation
  std::vector<std::size_t> sizes{15, 64};           // stations of a network of every ray
  std::size_t exact = 64;                           // networks of every ray that are evaluated together
  std::uint64_t sample = 20'000;
  double spread_m = 0.3;
  bool software = false;

  void add(CLI::App& command);
};

// Prints a table with a row for each number of devices and each task: seconds (best of `site.repeats`), speed relative
// to one device, and whether all counts equal those of one device.
void run_devices(const DevicesOptions& options);

}  // namespace vantage::bench
