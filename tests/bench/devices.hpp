// SPDX-License-Identifier: Apache-2.0
// How the rate of evaluation grows with the number of devices that share it.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <vector>

#include "bench_site.hpp"

namespace vantage::bench {

struct DevicesOptions {
  SiteOptions site;
  std::vector<std::uint32_t> devices{1, 2, 4, 8};   // how many; more than there are are left out
  std::vector<std::size_t> populations{250, 1000};  // networks of a sampled evaluation
  std::vector<std::size_t> sizes{15, 64};           // stations of a network of every ray
  std::size_t exact = 64;                           // such networks that are evaluated together
  std::uint64_t sample = 20'000;
  double spread_m = 0.3;
  bool software = false;

  void add(CLI::App& command);
};

// Prints a table: for each number of devices and each task the seconds (best of `site.repeats`), how many times faster
// than one device that is, and whether all counts are those of one device.
void run_devices(const DevicesOptions& options);

}  // namespace vantage::bench
