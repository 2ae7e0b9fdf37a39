// SPDX-License-Identifier: Apache-2.0
// Default plans of sites: times of their stages, and of another build of the program.
#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <string>
#include <vector>

namespace vantage::bench {

struct PlanStagesOptions {
  std::vector<std::string> sites;
  std::string engine = "auto", program, against;
  std::vector<std::string> site_options;  // of both programs, as on their command lines
  std::size_t repeats = 2;
  void add(CLI::App& command);
};

void run_plan_stages(const PlanStagesOptions& options);

}  // namespace vantage::bench
