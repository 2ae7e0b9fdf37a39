// SPDX-License-Identifier: Apache-2.0
// The folder of a plan's results: how they were made, and whether they may be replaced.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/site.hpp"

namespace vantage::cli {

// All settings of a plan, as options for --config.
nlohmann::json plan_options(const Site& site, const SurveyQuestion& question, const SurveyProblem& problem,
                            const PlanConfig& config);

// Existing results in a folder.
struct EarlierResults {
  bool another_run = false;
  std::uint64_t evaluations = 0, confirmed = 0;  // 0: there are none
};
EarlierResults earlier_results(const std::filesystem::path& folder, const nlohmann::json& options);

}  // namespace vantage::cli
