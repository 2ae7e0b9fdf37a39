// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <utility>

#include "vantage/error.hpp"
#include "vantage/planner.hpp"

namespace vantage {
namespace {

constexpr std::array<std::pair<Problem, const char*>, 4> kProblems{
    {{Problem::coverage_fix, "coverage-fix"},
     {Problem::coverage_overlap_fix, "coverage-overlap-fix"},
     {Problem::coverage_min, "coverage-min"},
     {Problem::coverage_overlap_min, "coverage-overlap-min"}}};

}  // namespace

std::string to_string(Problem problem) {
  for (const auto& [value, name] : kProblems)
    if (value == problem) return name;
  return "unknown";
}

Problem problem_from_string(const std::string& text) {
  std::string known;
  for (const auto& [value, name] : kProblems) {
    if (text == name) return value;
    known += std::string(known.empty() ? "" : ", ") + name;
  }
  throw Error(Errc::invalid_argument, "unknown problem \"" + text + "\"; known: " + known);
}

std::vector<std::string> objective_names(Problem problem) {
  switch (problem) {
    case Problem::coverage_fix: return {"1 - coverage"};
    case Problem::coverage_overlap_fix: return {"1 - coverage", "1 - overlap"};
    case Problem::coverage_min: return {"1 - coverage", "alpha"};
    case Problem::coverage_overlap_min: return {"1 - coverage", "1 - overlap", "alpha"};
  }
  return {};
}

std::vector<std::string> objective_names(const PlanConfig& config) {
  if (config.fitness) return {"1 - fitness"};
  return objective_names(config.problem);
}

bool has_one_objective(const PlanConfig& config) { return config.fitness || config.problem == Problem::coverage_fix; }

std::string to_string(StationStatus status) {
  switch (status) {
    case StationStatus::ok: return "ok";
    case StationStatus::hole: return "hole";
    case StationStatus::clash: return "clash";
  }
  return "unknown";
}

}  // namespace vantage
