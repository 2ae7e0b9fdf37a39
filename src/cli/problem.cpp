// SPDX-License-Identifier: Apache-2.0
#include "cli/problem.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "cli/options.hpp"

namespace vantage::cli {
namespace {

std::string joined(std::span<const std::string> names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

// The same error, with the option that caused it in front.
template <class Make>
auto named(const std::string& what, Make&& make) {
  try {
    return make();
  } catch (const Error& error) {
    throw Error(error.code(), what + ": " + error.what());
  }
}

}  // namespace

void ProblemOptions::add(CLI::App& command) {
  auto* named_problem =
      add_text(command, "--problem", "PROBLEM", joined(problem_names()) + "; by --stations otherwise", problem)
          ->group("Problem");
  add_value(command, "--objectives", "LIST",
            "What to search for, in place of a problem by name: any of " + joined(objective_names()),
            [this](const std::string& text, const std::string&) {
              objectives.clear();
              for (const auto part : split(text, ',')) objectives.emplace_back(part);
            })
      ->group("Problem")
      ->excludes(named_problem);
  add_values(command, "--require", "OBJECTIVE>=LIMIT",
             "What a network has to keep, as coverage>=0.9 or stations<=8; may be repeated",
             [this](const std::string& text, const std::string&) { requirements.push_back(text); })
      ->group("Problem");
  add_value(command, "--stations", "N|A..B",
            fmt::format("How many stations, or from A to B where the number is searched, up to {}", max_stations),
            [this](const std::string& text, const std::string& what) {
              stations = parse_count_range(text, what, 1, max_stations);
            })
      ->group("Problem");
  add_values(command, "--keep", "X,Y,Z|U,V", "A station that is there already, on top of --stations; may be repeated",
             [this](const std::string& text, const std::string& what) { keep.push_back(parse_station(text, what)); })
      ->group("Problem");
  add_value(command, "--heights", "LOW,HIGH", "Search each station's height between these, in metres",
            [this](const std::string& text, const std::string& what) {
              const auto values = parse_numbers(text, what, 2, 2, not_negative);
              heights = {values[0], values[1]};
            })
      ->group("Problem");
  add_number(
      command, "--link-overlap", "W",
      fmt::format("Overlap from which on two stations count as linked, 0 to 1; {} otherwise", default_link_overlap),
      link_overlap, {.low = 0, .high = 1})
      ->group("Problem");
  add_number(
      command, "--min-overlap", "W",
      "Want every station linked to the others by overlaps of at least W: --link-overlap W with parts<=1 required",
      min_overlap, {.low = 0, .high = 1})
      ->group("Problem");
  add_value(command, "--fitness", "L1,L2,L3",
            "One network by a fitness of coverage, number and visibility with these weights, as 0.4,0.4,0.2",
            [this](const std::string& text, const std::string& what) {
              const auto weights = parse_numbers(text, what, 3, 3, not_negative);
              fitness = FitnessWeights{weights[0], weights[1], weights[2]};
            })
      ->group("Problem");
  registration.add(command);
}

SurveyProblem ProblemOptions::settle() const {
  if (!stations) throw Error(Errc::invalid_argument, "--stations: how many? Give N, or A..B to search the number too");
  const auto [low, high] = *stations;
  if (high + keep.size() > max_stations)
    throw Error(Errc::invalid_argument,
                fmt::format("--stations {} and {} kept ones are more than the {} that can be simulated together", high,
                            keep.size(), max_stations));
  if (min_overlap && link_overlap && *min_overlap != *link_overlap)
    throw Error(Errc::invalid_argument, "--min-overlap and --link-overlap differ; give one of them");
  const double least = min_overlap && *min_overlap > 0 ? *min_overlap : link_overlap.value_or(default_link_overlap);
  SurveyProblem asked;
  if (!objectives.empty()) {
    asked = named("--objectives", [&, low = low, high = high] { return survey_problem(objectives, low, high, least); });
  } else {
    std::string name = problem.value_or(fitness       ? "fitness-min"
                                        : low == high ? "coverage-overlap-fix"
                                                      : "coverage-overlap-min");
    if (fitness && name != "fitness-min" && name != "coverage-min")
      throw Error(Errc::invalid_argument, "--fitness: goes with coverage-min, not with " + name);
    asked = named("--stations", [&, low = low, high = high] { return survey_problem(name, low, high); });
    if (fitness) asked = named("--fitness", [&, low = low, high = high] { return fitness_min(low, high, *fitness); });
  }
  asked.heights_m = heights;
  asked.link_overlap = least;
  asked.registration = registration.settle();
  for (Objective& objective : asked.objectives)
    if (objective.needs.registration) objective = make_objective(objective.name, asked.settings());
  if (min_overlap && *min_overlap > 0) asked.requirements.push_back(make_requirement("parts<=1", asked.settings()));
  for (const std::string& text : requirements)
    asked.requirements.push_back(named("--require", [&] { return make_requirement(text, asked.settings()); }));
  return asked;
}

}  // namespace vantage::cli
