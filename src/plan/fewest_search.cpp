// SPDX-License-Identifier: Apache-2.0
#include "plan/fewest_search.hpp"

#include <algorithm>
#include <chrono>

#include "core/seconds_since.hpp"
#include "plan/choose_optimiser.hpp"

namespace vantage {
namespace {

// Stations that the search may trace for each traced candidate.
constexpr double kSearchShare = 2;
constexpr std::size_t kLeastIterations = 10, kMostIterations = 100;
// First steps: about the distance between candidates, not the size of the site.
constexpr double kRefiningSigma = 0.03;
// Timed samples: sampled networks, and stations by every ray.
constexpr std::size_t kTimedNetworks = 2, kTimedStations = 4;
// With more stations, the timed samples themselves take long.
constexpr std::size_t kTimedUpTo = 100;
// Measured on the sites of docs/examples.md: how much longer later rounds take, and how many choices are verified.
constexpr double kLaterRounds = 1.1, kVerified = 4.5;

template <class Work>
double seconds_of(const Work& work) {
  const auto begun = std::chrono::steady_clock::now();
  work();
  return seconds_since(begun);
}

}  // namespace

SurveyProblem with_margins(SurveyProblem problem, const FewestAsked& asked, double overstated, double link_margin) {
  for (Requirement& requirement : problem.requirements) {
    if (requirement.bound != Requirement::Bound::at_least) continue;
    const Objective& objective = requirement.objective;
    if (objective.kind == Objective::Kind::coverage)
      requirement.limit = std::min(1.0, requirement.limit + overstated / asked.of_one(objective));
    if (objective.kind == Objective::Kind::link) requirement.limit += link_margin;
  }
  return problem;
}

PlanConfig refining_config(const SurveyProblem& problem, PlanConfig config, std::size_t candidates) {
  config.sigma0 = std::min(config.sigma0, kRefiningSigma);
  if (config.iterations == 0) {
    const double stations = kSearchShare * static_cast<double>(candidates);
    const auto each = static_cast<double>(population_of(problem, config) * problem.stations_max);
    config.iterations = std::clamp(static_cast<std::size_t>(stations / each), kLeastIterations, kMostIterations);
  }
  return config;
}

bool worth_searching(const SurveyProblem& problem, const PlanConfig& config) {
  return config.iterations * population_of(problem, config) >= problem.stations_max;
}

std::optional<double> expected_seconds(const FewestChoice& choice, const SurveyProblem& problem,
                                       const PlanConfig& config, NetworkEvaluator& evaluator, double round_s,
                                       const PlanWatch& watch) {
  const std::vector<PlacedStation> chosen = choice.stations_of(choice.network);
  if (chosen.size() > kTimedUpTo) return std::nullopt;
  const Progress silent{.report = {}, .stop = watch.stop};
  // The first call sets up structures that later ones reuse, so it may take longer.
  const auto sampled = [&](std::size_t copies) {
    const std::vector<PlacedNetwork> some(copies, chosen);
    return seconds_of([&] { evaluator.evaluate(some, {.voxels = config.sample_voxels}, silent); }) /
           static_cast<double>(copies);
  };
  const auto every_ray_of = [&](std::size_t stations) {
    const PlacedNetwork first(chosen.begin(), chosen.begin() + static_cast<std::ptrdiff_t>(stations));
    return seconds_of([&] { evaluator.confirm({&first, 1}, silent); });
  };
  const double network = std::min(sampled(1), sampled(kTimedNetworks));
  const std::size_t few = std::min(kTimedStations, chosen.size());
  const double one = std::min(every_ray_of(1), every_ray_of(1));
  const double each = few > 1 ? (every_ray_of(few) - one) / static_cast<double>(few - 1) : one;
  if (watch.stop.stop_requested() || watch.abort.stop_requested()) return std::nullopt;

  const auto count = static_cast<double>(chosen.size());
  const auto networks =
      worth_searching(problem, config) ? static_cast<double>(config.iterations * population_of(problem, config)) : 0;
  return (kRounds - 1) * kLaterRounds * round_s + networks * network +
         kVerified * (one + (count - 1) * std::max(each, 0.0));
}

}  // namespace vantage
