// SPDX-License-Identifier: Apache-2.0
// What `plan` is asked, from options to a SurveyProblem.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/on_site.hpp"
#include "cli/parse.hpp"
#include "cli/registration.hpp"
#include "cli/site.hpp"

namespace vantage::cli {

struct ProblemOptions {
  std::optional<std::string> problem;
  std::vector<std::string> objectives, requirements;
  std::optional<CountRange> stations;
  std::vector<StationText> keep;
  std::vector<std::string> search_steps;
  std::optional<std::array<double, 2>> heights;
  std::optional<double> link_overlap, min_overlap;
  std::optional<double> capture, link, apart;
  std::optional<double> time_on_site_min;
  std::optional<FitnessWeights> fitness;
  RegistrationCliOptions registration;
  OnSiteCliOptions on_site;

  void add(CLI::App& command);
  // Whether it is the surveyor's question: no other problem is named, nor a list of objectives for a given number.
  bool surveyors() const;
  // Problem and number of stations say much about each other; what is missing follows from what is there. Kept stations
  // and rounds on site are left to the caller. `scale`: of lengths that nobody gave. Throws Error invalid_argument.
  SurveyProblem settle(double scale = 1) const;
};

// What is exported as an option of its own, as the default question has it.
inline constexpr double default_capture = 0.9, default_apart_m = 1;

}  // namespace vantage::cli
