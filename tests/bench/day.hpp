// SPDX-License-Identifier: Apache-2.0
// A day on a site that differs from its model: a plan that is renewed after each scan, beside one that is not.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace vantage::bench {

struct DayOptions {
  std::string scene, folder, scanner = "rtc360@6mm";
  std::vector<std::string> things;  // x,y,z,x,y,z: boxes that stand there and are not in the model
  double capture = 0.9, link = 0.3, shift_m = 0.05, turn_deg = 0.5;
  std::uint64_t most = 20, seed = 1;
  std::optional<std::uint64_t> instrument;  // seed of its errors
  std::vector<double> steps_deg;
  std::optional<double> user_size_m, spacing_m;
  void add(CLI::App& command);
};

void run_day(const DayOptions& options);

}  // namespace vantage::bench
