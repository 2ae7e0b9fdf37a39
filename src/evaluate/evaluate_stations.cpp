// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>

#include "core/parse.hpp"
#include "core/part_of.hpp"
#include "core/site_reach.hpp"
#include "evaluate/evaluator.hpp"
#include "vantage/error.hpp"
#include "vantage/evaluation.hpp"

namespace vantage {
namespace {

std::vector<Objective> measures_of(const EvaluationOptions& options) {
  std::vector<Objective> all{make_objective("coverage")};
  // The registration error that the options ask for takes the place of the measure of that name.
  const auto add = [&](const Objective& measure) {
    if (options.registration && measure.name == "registration") return;
    if (std::ranges::count(all, measure.name, &Objective::name) == 0) all.push_back(measure);
  };
  if (options.overlap) add(make_objective("overlap"));
  for (const Objective& measure : options.measures) add(measure);
  for (const Requirement& requirement : options.requirements) add(requirement.objective);
  if (options.attainable) add(make_objective("capture"));
  return all;
}

// Throws Error invalid_argument for options that do not go together, and measures that need what the site lacks.
void check(const EvaluationSite& site, const RequiredInputs& needs, const EvaluationOptions& options) {
  const auto refuse = [](const std::string& why) { throw Error(Errc::invalid_argument, "evaluate: " + why); };
  if (needs.pairs && !options.overlap) refuse("a measure needs pairs of stations; count overlap too");
  if (needs.surroundings && !site.surroundings)
    refuse("a measure needs all surfaces; give the simulator of the surroundings too");
  if (needs.visibility && !site.clash)
    refuse("a measure needs lines of sight between stations; give the clash checker too");
  if (!options.targets.empty() && !options.registration)
    refuse("targets were given, but the registration error was not requested; request it too");
  if (!options.targets.empty() && !site.clash) refuse("targets were given without the clash checker; give it too");
  if (needs.time && !site.on_site) refuse("a measure needs the time on site; give the rounds on site too");
  if (options.beam && options.sample_voxels)
    refuse("a sample is traced by rays without a width; choose either a beam with a width or a sample");
  if (options.beam && options.attainable)
    refuse("attainable coverage is measured by rays without a width; choose either it or a beam with a width");
  if (options.field && options.sample_voxels)
    refuse("a sample has no points of every voxel; choose either the field or a sample");
  check_number(options.link, "evaluate: link", kAnyShare);
  check_number(options.link_overlap, "evaluate: link-overlap", kAnyShare);
  if (options.registration) check_settings(registration_settings(), *options.registration);
  check_settings(target_settings(), options.target);
  for (const Requirement& requirement : options.requirements)
    check_number(requirement.limit, "evaluate: the limit of " + requirement.objective.name);
}

// Positions of inactive stations are not traced, but shown and moved; a hole has none.
void check_positions(const Vec3& origin, std::span<const PlacedStation> stations) {
  for (std::size_t k = 0; k < stations.size(); ++k)
    if (active(stations[k]))
      require_in_reach(stations[k].position, origin, "station " + std::to_string(k + 1) + " stands");
    else if (const Vec3& at = stations[k].position; !std::isfinite(at.x + at.y + at.z))
      refuse_position(at, "station " + std::to_string(k + 1) + " stands");
}

// A day that is too short for a station is told before anything is counted.
void check_day(const std::vector<PlacedStation>& stations, const OnSite& on_site) {
  if (!on_site.options().day_min) return;
  Evaluation plain{.stations = stations, .visit = visit_of(stations, std::nullopt, on_site)};
  add_sessions(plain, on_site);
  if (!plain.visit->not_split.empty()) throw Error(Errc::invalid_argument, plain.visit->not_split);
}

}  // namespace

std::vector<Evaluation> evaluate_networks(const EvaluationSite& site,
                                          std::span<const std::vector<PlacedStation>> stations,
                                          const EvaluationOptions& options, const Progress& progress) {
  EvaluationSite counted = site;
  if (!options.overlap) counted.surroundings = nullptr;
  const Evaluator evaluator(counted, options, measures_of(options));
  check(site, evaluator.needs(), options);
  if (options.field && stations.size() != 1)
    throw Error(Errc::invalid_argument, "evaluate: the points of every voxel are kept of one network at a time");
  std::vector<Network> networks;
  for (const auto& one : stations) {
    check_positions(site.simulator.origin(), one);
    networks.push_back(to_network(one));
  }
  if (site.on_site)
    for (const auto& one : stations) check_day(one, *site.on_site);

  // The rest of the time counts what is attainable.
  const double counting = options.attainable ? 0.8 : 1;
  const auto work = [&] { return site.simulator.work() + (site.surroundings ? site.surroundings->work() : Work{}); };
  const Work before = work();
  CountedNetworks counts = evaluator.count(networks, options.field, between(progress, 0, counting));
  AttainableCounts attainable;
  std::vector<CapturedShares> captured;
  if (options.attainable) {
    attainable = *options.attainable;
    for (const Objective& measure : evaluator.measures())
      if (!measure.meshes.empty()) attainable.tell_of(site.simulator, measure.meshes);
    const Progress raising = between(progress, counting, 0.95), silent{.stop = progress.stop};
    bool whole = true;
    for (const Network& network : networks)
      whole = whole && raise_attainable(attainable, site.simulator, network, networks.size() == 1 ? raising : silent);
    if (whole) captured = captured_shares(site.simulator, attainable, networks, silent);
  }

  std::vector<Evaluation> made;
  for (std::size_t k = 0; k < networks.size(); ++k) {
    if (!counts.whole(k) || (options.attainable && captured.empty())) {
      made.push_back({.stations = stations[k]});
      made.back().counts.cancelled = true;
      continue;
    }
    CountedNetwork network{.stations = stations[k],
                           .surveyed = counts.surveyed[k],
                           .surroundings = counts.surroundings.empty() ? nullptr : &counts.surroundings[k],
                           .captured = captured.empty() ? CapturedShares{} : captured[k],
                           .field = options.field ? &counts.field : nullptr};
    if (options.attainable) network.attainable = attainable.coverage();
    std::optional<Visit> visit;
    if (site.on_site) network.visit = &visit.emplace(evaluator.visit(network, most_minutes(options.requirements)));
    complete(made.emplace_back(evaluator.evaluate(network)), site, progress);
  }
  for (Evaluation& one : made) one.work = work() - before;
  return made;
}

Evaluation evaluate_stations(const EvaluationSite& site, std::span<const PlacedStation> stations,
                             const EvaluationOptions& options, const Progress& progress) {
  const std::vector<PlacedStation> one(stations.begin(), stations.end());
  return std::move(evaluate_networks(site, {&one, 1}, options, progress).front());
}

}  // namespace vantage
