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

constexpr const char* kSurvey = "survey";

// A requirement in place of one on the same objective from the same side.
void require(SurveyProblem& problem, const std::string& text) {
  Requirement requirement = make_requirement(text, problem.settings());
  for (Requirement& known : problem.requirements)
    if (known.objective.name == requirement.objective.name && known.bound == requirement.bound) {
      known = std::move(requirement);
      return;
    }
  problem.requirements.push_back(std::move(requirement));
}

}  // namespace

void ProblemOptions::add(CLI::App& command) {
  add_text(command, "--problem", "PROBLEM",
           std::string(kSurvey) + " (otherwise; the fewest stations that capture and link enough), or " +
               joined(problem_names()),
           problem)
      ->group("Problem");
  add_number(command, "--capture", "SHARE",
             fmt::format("Share of what can be seen that the survey has to capture; {} otherwise", default_capture),
             capture, {.low = 0, .high = 1})
      ->group("Problem");
  add_number(command, "--link", "SHARE",
             fmt::format("Least scan overlap, along some spanning tree, that all stations are linked by: the share of "
                         "the smaller scan that the other sees too, over all surfaces; {} otherwise",
                         default_link),
             link, {.low = 0, .high = 1})
      ->group("Problem");
  add_number(command, "--apart", "M",
             fmt::format("Least distance between two stations; {} m otherwise, and none with the problems by name",
                         default_apart_m),
             apart, not_negative)
      ->group("Problem");
  add_value(
      command, "--max-time-on-site", "T", "Longest time that the survey may take on site: 90min or 6h",
      [this](const std::string& text, const std::string& what) { time_on_site_min = parse_duration(text, what) / 60; })
      ->group("Problem");
  add_number(command, "--set-up", "MIN", "Minutes at each station besides the scan itself; 3 otherwise", set_up_min,
             not_negative)
      ->group("Problem");
  add_number(command, "--walking", "M/S", "How fast one walks with the scanner; 0.8 m/s otherwise", walking_m_per_s,
             positive)
      ->group("Problem");
  add_value(
      command, "--objectives", "LIST",
      "What to search for once the number is decided, or with --stations at once: any of " + joined(objective_names()),
      [this](const std::string& text, const std::string&) {
        objectives.clear();
        for (const auto part : split(text, ',')) objectives.emplace_back(part);
      })
      ->group("Problem");
  add_values(command, "--require", "OBJECTIVE>=LIMIT",
             "What a network has to keep, as coverage>=0.9 or stations<=8; may be repeated",
             [this](const std::string& text, const std::string&) { requirements.push_back(text); })
      ->group("Problem");
  add_value(command, "--stations", "N|A..B",
            fmt::format("How many stations, or from A to B (A,B) where the number is searched, up to {}", max_stations),
            [this](const std::string& text, const std::string& what) {
              std::string range = text;
              if (const auto comma = range.find(','); comma != std::string::npos) range.replace(comma, 1, "..");
              stations = parse_count_range(range, what, 1, max_stations);
            })
      ->group("Problem");
  add_values(command, "--keep", "X,Y,Z|U,V", "A station that is there already, on top of --stations; may be repeated",
             [this](const std::string& text, const std::string& what) { keep.push_back(parse_station(text, what)); })
      ->group("Problem");
  add_value(command, "--search-step", "LIST",
            "Choose each station's step among these: degrees, as 0.2,0.1,0.05, or settings of the scanner, as 12mm,3mm",
            [this](const std::string& text, const std::string&) {
              search_steps.clear();
              for (const auto part : split(text, ',')) search_steps.emplace_back(part);
            })
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

bool ProblemOptions::surveyors() const {
  if (problem) return *problem == kSurvey;
  if (fitness) return false;
  const bool searches_number = std::ranges::count(objectives, "stations") > 0;
  return objectives.empty() || (!stations && !searches_number);
}

SurveyProblem ProblemOptions::settle(double scale) const {
  const bool survey = surveyors();
  if (!stations && !survey)
    throw Error(Errc::invalid_argument, "--stations: how many? Give N, or A..B to search the number too");
  if (keep.size() >= max_stations)
    throw Error(Errc::invalid_argument, fmt::format("--keep: {} kept ones leave none of the {} that can be simulated "
                                                    "together",
                                                    keep.size(), max_stations));
  const auto [low, high] = stations.value_or(CountRange{1, max_stations - keep.size()});
  if (high + keep.size() > max_stations)
    throw Error(Errc::invalid_argument,
                fmt::format("--stations {} and {} kept ones are more than the {} that can be simulated together", high,
                            keep.size(), max_stations));
  if (min_overlap && link_overlap && *min_overlap != *link_overlap)
    throw Error(Errc::invalid_argument, "--min-overlap and --link-overlap differ; give one of them");
  if (!objectives.empty() && problem && !survey)
    throw Error(Errc::invalid_argument, "--objectives: " + *problem + " has its own; give one of them");
  const double least = min_overlap && *min_overlap > 0 ? *min_overlap : link_overlap.value_or(default_link_overlap);
  SurveyProblem asked;
  if (survey) {
    asked = fewest_stations(capture.value_or(default_capture), link.value_or(default_link), low, high,
                            apart.value_or(default_apart_m * scale));
    if (!objectives.empty()) {
      std::vector<Requirement> required = std::move(asked.requirements);
      asked =
          named("--objectives", [&, low = low, high = high] { return survey_problem(objectives, low, high, least); });
      asked.requirements = std::move(required);
      asked.name = kSurvey;
      asked.fewest = true;
    }
  } else if (!objectives.empty()) {
    asked = named("--objectives", [&, low = low, high = high] { return survey_problem(objectives, low, high, least); });
  } else {
    const std::string name = problem.value_or("fitness-min");
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
  if (set_up_min) asked.on_site.set_up_min = *set_up_min;
  if (walking_m_per_s) asked.on_site.walking_m_per_s = *walking_m_per_s;
  const auto at_least = [&](const char* name, std::optional<double> limit) {
    if (limit && *limit > 0) require(asked, fmt::format("{}>={}", name, *limit));
  };
  if (!survey) at_least("capture", capture), at_least("link", link);
  // The problems of the method know no such distance; what anybody else makes up is kept from stations on one spot.
  const bool by_name = !survey && objectives.empty();
  if (!survey) at_least("apart", by_name ? apart : std::optional(apart.value_or(default_apart_m * scale)));
  if (time_on_site_min) require(asked, fmt::format("time<={}", *time_on_site_min));
  if (min_overlap && *min_overlap > 0) require(asked, "parts<=1");
  for (const std::string& text : requirements)
    named("--require", [&] {
      require(asked, text);
      return 0;
    });
  return asked;
}

}  // namespace vantage::cli
