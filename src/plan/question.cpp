// SPDX-License-Identifier: Apache-2.0
#include "vantage/question.hpp"

#include <algorithm>
#include <charconv>
#include <string>
#include <string_view>
#include <utility>

#include "core/setting_table.hpp"
#include "plan/check_problem.hpp"
#include "plan/limits.hpp"
#include "site/site_scanner.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

constexpr const char* kSurvey = "survey";

// Adds a requirement; replaces one on the same objective from the same side.
void require(SurveyProblem& problem, const std::string& text) {
  Requirement requirement = make_requirement(text, problem.settings());
  for (Requirement& known : problem.requirements)
    if (known.objective.name == requirement.objective.name && known.bound == requirement.bound) {
      known = std::move(requirement);
      return;
    }
  problem.requirements.push_back(std::move(requirement));
}

void require_at_least(SurveyProblem& problem, const char* name, double limit) {
  if (limit > 0)
    problem.requirements.push_back({make_objective(name, problem.settings()), Requirement::Bound::at_least, limit});
}

std::array<std::size_t, 2> station_range(const SurveyQuestion& question) {
  const std::size_t kept = question.existing.size();
  if (!question.stations && !question.asks_for_fewest())
    throw Error(Errc::invalid_argument, "stations: how many? Give N, or A..B to search the number too");
  if (kept >= max_stations)
    throw Error(Errc::invalid_argument, std::to_string(kept) + " existing stations leave none of the " +
                                            std::to_string(max_stations) + " that can be simulated together");
  const auto range = question.stations.value_or(std::array<std::size_t, 2>{1, max_stations - kept});
  if (range[1] + kept > max_stations)
    throw Error(Errc::invalid_argument, "stations: " + std::to_string(range[1]) + " and " + std::to_string(kept) +
                                            " existing ones are more than the " + std::to_string(max_stations) +
                                            " that can be simulated together");
  return range;
}

// Least overlap of a link.
double linked_from(const SurveyQuestion& question) {
  if (question.min_overlap && question.link_overlap && *question.min_overlap != *question.link_overlap)
    throw Error(Errc::invalid_argument, "min-overlap and link-overlap differ; give one of them");
  if (question.min_overlap && *question.min_overlap > 0) return *question.min_overlap;
  return question.link_overlap.value_or(default_link_overlap);
}

SurveyProblem of_objectives(const SurveyQuestion& question, std::array<std::size_t, 2> stations, double least) {
  return named("objectives", [&] { return survey_problem(question.objectives, stations[0], stations[1], least); });
}

// True if it asks for the most coverage of a fixed number of stations.
bool asks_for_most(const SurveyQuestion& question) {
  return question.stations && (*question.stations)[0] == (*question.stations)[1] && !question.capture &&
         !question.pays_m2 && question.objectives.empty();
}

// True if a requirement in words is a lower limit on the captured share.
bool requires_share(const std::string& text) {
  return requires_capture(named("require", [&] { return make_requirement(text, {}); }));
}

// True if the plan places the stations that pay: always, unless the question has a number or a share.
bool asks_what_pays(const SurveyQuestion& question) {
  if (question.pays_m2) return true;
  return question.asks_for_fewest() && !question.capture && !asks_for_most(question) &&
         std::ranges::none_of(question.requirements, requires_share);
}

SurveyProblem fewest(const SurveyQuestion& question, std::array<std::size_t, 2> stations, double least, double apart) {
  SurveyProblem asked = fewest_stations(question.capture.value_or(0), question.link.value_or(default_link), stations[0],
                                        stations[1], apart);
  if (asks_for_most(question)) asked.objectives = {make_objective("capture", asked.settings())};
  // The stations that pay set its limit, or a requirement takes its place.
  if (!question.capture && !asks_for_most(question))
    asked.requirements.insert(asked.requirements.begin(),
                              {make_objective("capture", asked.settings()), Requirement::Bound::at_least, 0});
  if (question.objectives.empty()) return asked;
  std::vector<Requirement> required = std::move(asked.requirements);
  asked = of_objectives(question, stations, least);
  asked.requirements = std::move(required);
  asked.name = kSurvey;
  asked.fewest = true;
  return asked;
}

SurveyProblem by_name(const SurveyQuestion& question, std::array<std::size_t, 2> stations) {
  const std::string name = question.problem.value_or("fitness-min");
  if (question.fitness && name != "fitness-min" && name != "coverage-min")
    throw Error(Errc::invalid_argument, "fitness: goes with coverage-min, not with " + name);
  SurveyProblem asked = named("stations", [&] { return survey_problem(name, stations[0], stations[1]); });
  if (question.fitness)
    asked = named("fitness", [&] { return fitness_min(stations[0], stations[1], *question.fitness); });
  return asked;
}

std::optional<double> number_in(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() ? std::optional(value) : std::nullopt;
}

// Returns the site's scanner with each of these steps.
std::vector<Scanner> scanners_with(const Site& site, const std::vector<std::string>& steps, bool every_echo) {
  std::vector<Scanner> scanners;
  for (const std::string& step : steps) {
    Scanner scanner = site.scanner();
    if (every_echo && !site.options().detection) detect_every_echo(scanner);
    const std::string preset_name = site.options().scanner.value_or("");
    if (const auto degrees = number_in(step)) {
      scanner.set_steps(Angle::degrees(*degrees), Angle::degrees(*degrees));
    } else if (preset_name.empty()) {
      throw Error(Errc::invalid_argument,
                  "search-step: '" + step + "' is no number of degrees; settings by name go with a scanner's preset");
    } else {
      const Scanner preset =
          load_scanner(preset_name.substr(0, preset_name.find('@')) + "@" + step, own_presets_file());
      scanner.name = preset.name;
      if (preset.directions.empty())
        scanner.set_steps(preset.azimuth_step, preset.zenith_step);
      else
        scanner.set_directions(preset.directions, preset.times_s);
      scanner.points_per_second = preset.points_per_second;
    }
    if (place_in(scanners, scanner) < scanners.size())
      throw Error(Errc::invalid_argument, "search-step: '" + step + "' is there twice");
    scanners.push_back(std::move(scanner));
  }
  return scanners;
}

// Sample sizes of a search, for errors of .002 in coverage, and of .007 in overlap, on large sites
// (docs/evidence/benchmarks.md).
constexpr std::uint64_t kSampleForCoverage = 20'000, kSampleForOverlap = 100'000;
// A front is searched with fewer voxels, redrawn regularly, so that no network survives by luck, as with a fixed
// sample; every ray then judges the archive (docs/evidence/cases.md).
constexpr std::uint64_t kSampleRedrawn = 5'000;
constexpr std::size_t kIterationsOfASample = 20;
// Sample size of a search at a fixed number of stations; a larger sample chooses the number.
constexpr std::uint64_t kSampleForFewest = 5'000;
// A quarter of the voxels is enough on small sites, but at least some thousands.
constexpr std::uint64_t kLeastSample = 5'000;
constexpr std::size_t kUsualIterations = 100;

std::uint64_t usual_sample(const SurveyProblem& problem, bool redrawn, std::uint64_t voxels) {
  const auto pairs = [](const Objective& objective) { return objective.needs.pairs; };
  const bool overlap = std::ranges::any_of(problem.objectives, pairs) ||
                       std::ranges::any_of(problem.requirements, pairs, &Requirement::objective);
  if (problem.fewest) return std::min(kSampleForFewest, voxels);
  if (redrawn) return std::min(kSampleRedrawn, voxels);
  return std::min({overlap ? kSampleForOverlap : kSampleForCoverage, std::max(voxels / 4, kLeastSample), voxels});
}

}  // namespace

bool SurveyQuestion::asks_for_fewest() const {
  if (problem) return *problem == kSurvey;
  if (fitness) return false;
  const bool searches_number = std::ranges::count(objectives, "stations") > 0;
  return objectives.empty() || (!stations && !searches_number);
}

SurveyProblem survey_problem(const Site& site, const SurveyQuestion& question) {
  check_settings(question_settings(), question);
  const bool survey = question.asks_for_fewest();
  const auto stations = station_range(question);
  if (question.pays_m2 && question.capture)
    throw Error(Errc::invalid_argument, "pays and capture both decide the number of stations; give one of them");
  if (question.pays_m2 && !survey)
    throw Error(Errc::invalid_argument,
                "pays: goes with the fewest stations, without a problem of its own; leave one out");
  if (!question.objectives.empty() && question.problem && !survey)
    throw Error(Errc::invalid_argument, "objectives: " + *question.problem + " has its own; give one of them");
  const double least = linked_from(question);
  const double apart = question.apart_m.value_or(default_apart_m * site.length_scale());
  SurveyProblem asked = survey                        ? fewest(question, stations, least, apart)
                        : question.objectives.empty() ? by_name(question, stations)
                                                      : of_objectives(question, stations, least);
  if (asks_what_pays(question)) {
    asked.pays_m2 = question.pays_m2.value_or(default_pays_m2 * site.length_scale() * site.length_scale());
    asked.pays_share = question.pays_m2 ? 0 : default_pays_share;
  }
  asked.existing = question.existing, asked.existing_setups = question.existing_setups;
  asked.existing_names = question.existing_names;
  asked.heights_m = question.heights_m;
  asked.link_overlap = least;
  asked.registration = levelled_by(question.registration, site.scanners());
  asked.on_site = question.on_site;
  asked.targets = question.targets, asked.existing_targets = question.existing_targets;
  asked.target = with_class_of(site.options(), question.target);
  if (!asked.on_site.entrance && !site.walkable().enter.empty()) asked.on_site.entrance = site.walkable().enter.front();
  for (Objective& objective : asked.objectives)
    if (objective.needs.registration) objective = make_objective(objective.name, asked.settings());
  if (!survey) {
    require_at_least(asked, "capture", question.capture.value_or(0));
    require_at_least(asked, "link", question.link.value_or(0));
    // The problems of the method have no such distance; in others two stations must not stand at one place.
    require_at_least(asked, "apart", question.objectives.empty() ? question.apart_m.value_or(0) : apart);
  }
  if (question.minutes_on_site) {
    Requirement time = make_requirement("time<=1", asked.settings());
    time.limit = *question.minutes_on_site;
    asked.requirements.push_back(std::move(time));
  }
  if (question.min_overlap && *question.min_overlap > 0) require(asked, "parts<=1");
  for (const std::string& text : question.requirements)
    named("require", [&] {
      require(asked, text);
      return 0;
    });
  asked.every_echo = !survey && question.objectives.empty();
  asked.scanners = scanners_with(site, question.search_steps, asked.every_echo);
  check_problem(site, asked);
  return asked;
}

PlanConfig settled(const PlanConfig& config, const SurveyProblem& problem, std::uint64_t voxels, std::uint64_t seed) {
  PlanConfig all = config;
  const bool sample_given = config.sample_voxels > 0 || config.sample_share;
  if (config.exact && (sample_given || config.renew_iterations.value_or(0) > 0))
    throw Error(Errc::invalid_argument, "exact: a search with every ray has no sample; give one of them");
  if (all.iterations == 0 && !problem.fewest) all.iterations = kUsualIterations;
  if (!all.seed) all.seed = seed;
  if (!all.renew_iterations) {
    const bool front = problem.objectives.size() > 1 && !problem.fewest && !config.optimiser;
    all.renew_iterations = front && !config.exact && !sample_given ? kIterationsOfASample : 0;
  }
  if (config.exact)
    all.sample_voxels = 0;
  else if (sample_given)
    all.sample_voxels =
        SampleSize{config.sample_voxels > 0 ? std::optional(config.sample_voxels) : std::nullopt, config.sample_share}
            .of(voxels);
  else
    all.sample_voxels = usual_sample(problem, *all.renew_iterations > 0, voxels);
  all.sample_share.reset();
  return all;
}

SurveyProblem fewest_stations(double capture, double link, std::size_t stations_min, std::size_t stations_max,
                              double apart_m) {
  SurveyQuestion question;
  question.capture = capture, question.link = link, question.apart_m = apart_m;
  check_settings(question_settings(), question);
  const std::vector<std::string> goal{"registration"};
  SurveyProblem problem = survey_problem(goal, stations_min, stations_max);
  problem.name = "survey";
  problem.fewest = true;
  const auto require = [&](const char* name, double limit) {
    if (limit > 0)
      problem.requirements.push_back({make_objective(name, problem.settings()), Requirement::Bound::at_least, limit});
  };
  require("capture", capture);
  require("link", link);
  require("apart", apart_m);
  return problem;
}

PlanResult plan(Site& site, const SurveyQuestion& question, const PlanConfig& config, const PlanWatch& watch) {
  const SurveyProblem problem = survey_problem(site, question);
  return plan(site, problem, config, watch);
}

}  // namespace vantage
