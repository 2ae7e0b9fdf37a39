// SPDX-License-Identifier: Apache-2.0
// What `plan` is asked, from options to a SurveyProblem.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/parse.hpp"
#include "cli/registration.hpp"
#include "cli/site.hpp"

namespace vantage::cli {

struct ProblemOptions {
  std::optional<std::string> problem;
  std::vector<std::string> objectives, requirements;
  std::optional<CountRange> stations;
  std::vector<StationText> keep;
  std::optional<std::array<double, 2>> heights;
  std::optional<double> link_overlap, min_overlap;
  std::optional<FitnessWeights> fitness;
  RegistrationCliOptions registration;

  void add(CLI::App& command);
  // Problem and number of stations say much about each other; what is missing follows from what is there. Kept stations
  // are left to the caller. Throws Error invalid_argument.
  SurveyProblem settle() const;
};

}  // namespace vantage::cli
