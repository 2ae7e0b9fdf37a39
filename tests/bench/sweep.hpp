// SPDX-License-Identifier: Apache-2.0
// Plans of many sites by the default question, scored against the known truth of each site.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

namespace vantage::bench {

struct SweepOptions {
  std::vector<std::string> sites;       // random ones by seed ("7", "1..12"), reference ones by name, else files
  std::string folder, by_hand;          // for results; of plans by hand, NAME.csv each. Empty: none
  std::optional<std::string> unit, up;  // of files
  std::optional<double> step_deg, user_size_m, spacing_m;
  bool pays = false;  // by default 90 % of what is attainable
  double max_seconds = 0;
  void add(CLI::App& command);
};

// Writes sweep.csv, sweep.md and sweep.png to the folder, the rounds on site as rounds.csv and rounds.md, and with
// plans by hand also by_hand.csv and by_hand.md. Returns false if a site cannot be planned, or a plan has a fault that
// none may have; standard error tells which.
bool run_sweep(const SweepOptions& options);

}  // namespace vantage::bench
