// SPDX-License-Identifier: Apache-2.0
// The folder that a plan's results lie in: what made them, and whether they may be replaced.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "cli/site.hpp"

namespace vantage::cli {

// Everything that a plan goes by, as options that --config takes again.
nlohmann::json plan_options(const Site& site, const SurveyQuestion& question, const SurveyProblem& problem,
                            const PlanConfig& config);

// What a folder holds already.
struct EarlierResults {
  bool another_run = false;
  std::uint64_t evaluations = 0, confirmed = 0;  // of the results; 0: there are none
};
EarlierResults earlier_results(const std::filesystem::path& folder, const nlohmann::json& options);

}  // namespace vantage::cli
