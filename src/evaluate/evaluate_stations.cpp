// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>

#include "core/parse.hpp"
#include "core/site_reach.hpp"
#include "evaluate/sight_targets.hpp"
#include "evaluate/through_glass.hpp"
#include "evaluate/visibility.hpp"
#include "objective/registered_sample.hpp"
#include "placement/nearest_place.hpp"
#include "vantage/error.hpp"
#include "vantage/evaluation.hpp"

namespace vantage {
namespace {

constexpr double kMillimetres = 1000;

std::vector<Objective> measures_of(const EvaluationOptions& options) {
  std::vector<Objective> all{make_objective("coverage")};
  const auto add = [&](const Objective& measure) {
    if (std::ranges::count(all, measure.name, &Objective::name) == 0) all.push_back(measure);
  };
  if (options.overlap) add(make_objective("overlap"));
  for (const Objective& measure : options.measures) add(measure);
  for (const Requirement& requirement : options.requirements) add(requirement.objective);
  if (options.attainable) add(make_objective("capture"));
  return all;
}

RequiredInputs required_inputs_of(const std::vector<Objective>& measures, const EvaluationOptions& options) {
  RequiredInputs needs = vantage::required_inputs_of(measures);
  if (!options.registration) return needs;
  const bool all_surfaces = options.registration->surfaces == RegistrationSurfaces::all;
  return needs | RequiredInputs{.pairs = true,
                                .surroundings = all_surfaces,
                                .registration = options.registration->model,
                                .surroundings_registration = all_surfaces};
}

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
  check_number(options.link, "evaluate: link", any_share);
  check_number(options.link_overlap, "evaluate: link-overlap", any_share);
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

// The prediction whose error is to be known.
RegistrationOptions registration_of(const RequiredInputs& needs, const EvaluationOptions& options) {
  RegistrationOptions plain;
  if (needs.registration) plain.model = *needs.registration;
  if (needs.surroundings_registration) plain.surfaces = RegistrationSurfaces::all;
  return options.registration.value_or(plain);
}

// As many voxels as the caller wants.
EvaluateOptions registered_by(EvaluateOptions counting, std::uint64_t voxels) {
  if (voxels > 0) counting.registration_voxels = voxels, counting.registration_known = nullptr;
  return counting;
}

std::vector<NetworkCounts> count(Simulator& simulator, std::span<const Network> networks, const RequiredInputs& needs,
                                 const EvaluationOptions& options, VoxelField* field, const Progress& progress) {
  if (options.sample_voxels)
    return simulator.evaluate_sampled(networks,
                                      {.voxels = *options.sample_voxels,
                                       .overlap = options.overlap,
                                       .registration = needs.registration,
                                       .meshes = needs.meshes},
                                      progress);
  EvaluateOptions every_ray =
      registered_by(count_surveyed(needs, registration_of(needs, options), simulator), options.registration_voxels);
  every_ray.overlap = options.overlap, every_ray.skip = options.skip;
  every_ray.field = field, every_ray.beam = options.beam, every_ray.meshes = needs.meshes;
  if (networks.size() == 1) return {simulator.evaluate(networks.front(), every_ray, progress)};
  return simulator.evaluate_each(networks, every_ray, progress);
}

}  // namespace

std::vector<Evaluation> evaluate_networks(const EvaluationSite& site,
                                          std::span<const std::vector<PlacedStation>> stations,
                                          const EvaluationOptions& options, const Progress& progress) {
  const std::vector<Objective> measures = measures_of(options);
  const RequiredInputs needs = required_inputs_of(measures, options);
  check(site, needs, options);
  if (options.field && stations.size() != 1)
    throw Error(Errc::invalid_argument, "evaluate: the points of every voxel are kept of one network at a time");
  std::vector<Network> networks;
  for (const auto& one : stations) {
    check_positions(site.simulator.origin(), one);
    networks.push_back(to_network(one));
  }

  // A day that is too short for a station is told before anything is counted.
  if (site.on_site && site.on_site->options().day_min)
    for (const auto& one : stations) {
      Evaluation plain{.stations = one};
      plain.visit = visit_of(plain, *site.on_site);
      add_sessions(plain, *site.on_site);
      if (!plain.visit->not_split.empty()) throw Error(Errc::invalid_argument, plain.visit->not_split);
    }

  // Shares of the time: surveyed voxels, then surroundings and what is attainable.
  const bool counts_around = site.surroundings && options.overlap;
  const auto share = [&](double from, double to) -> Progress {
    return {.report = [&progress, from, to](double done) { progress(from + (to - from) * done); },
            .stop = progress.stop};
  };
  const double counted = counts_around || options.attainable ? 0.6 : 1, looked = options.attainable ? 0.8 : 1;

  const auto work = [&] { return site.simulator.work() + (site.surroundings ? site.surroundings->work() : Work{}); };
  const Work before = work();
  VoxelField field;
  const std::vector<NetworkCounts> counts =
      count(site.simulator, networks, needs, options, options.field ? &field : nullptr, share(0, counted));
  std::vector<NetworkCounts> around;
  if (counts_around && !progress.stopped())
    around = site.surroundings->evaluate_each(
        networks,
        registered_by(
            count_surroundings(needs, registration_of(needs, options), counts, site.simulator, *site.surroundings),
            options.registration_voxels),
        share(counted, looked));

  AttainableCounts attainable;
  std::vector<Estimate> captured;
  if (options.attainable) {
    attainable = *options.attainable;
    const Progress raising = share(0.8, 0.95), silent{.report = {}, .stop = progress.stop};
    bool whole = true;
    for (const Network& network : networks)
      whole = whole && raise_attainable(attainable, site.simulator, network, networks.size() == 1 ? raising : silent);
    if (whole) captured = captured_shares(site.simulator, attainable, networks, silent);
  }

  std::vector<Evaluation> made;
  for (std::size_t k = 0; k < networks.size(); ++k) {
    if (counts[k].cancelled || (counts_around && (around.empty() || around[k].cancelled)) ||
        (options.attainable && captured.empty())) {
      made.push_back({.stations = stations[k]});
      made.back().counts.cancelled = true;
      continue;
    }
    const auto existing = static_cast<std::size_t>(std::ranges::count(stations[k], true, &PlacedStation::existing));
    const OverlapMatrix overlap = options.overlap ? overlap_matrix(counts[k]) : OverlapMatrix{};
    std::optional<Visit> visit;
    if (site.on_site)
      visit = visit_of({.stations = stations[k],
                        .overlap_matrix = overlap,
                        .scan_overlap_matrix = counts_around ? scan_overlap_matrix(around[k]) : ScanOverlapMatrix{},
                        .link_overlap = options.link_overlap,
                        .link = options.link},
                       *site.on_site, most_minutes(options.requirements));
    MeasuredNetwork measured{
        .counts = counts[k],
        .stations = stations[k],
        .existing = existing,
        .goal_density = site.simulator.goal_density(),
        .voxels = site.simulator.voxel_count(),
        .overlap = overlap,
        .visible_parts = needs.visibility
                             ? visibility_parts([&](const Vec3& a, const Vec3& b) { return site.clash->sees(a, b); },
                                                site.simulator.scanner().max_range_m, networks[k])
                             : 0,
        .surroundings = counts_around ? &around[k] : nullptr,
        .surroundings_voxels = counts_around ? site.surroundings->voxel_count() : 0,
        .minutes_on_site = visit ? visit->minutes : 0,
        .scene = &site.simulator.scene()};
    if (options.attainable) measured.captured = captured[k];
    std::vector<Target> targets = options.targets;
    std::vector<RegistrationTarget> sighted;
    if (!targets.empty()) sighted = sight_targets(site.simulator, *site.clash, stations[k], targets, options.target);
    Evaluation& one = made.emplace_back(evaluation_of(measured, measures, options.registration, sighted));
    one.targets = std::move(targets), one.accuracy_class = options.target.wanted;
    if (options.registration && !one.targets.empty())
      one.without_targets_m = registration_error(counts[k], measured.voxels, *options.registration,
                                                 measured.surroundings, measured.surroundings_voxels)
                                  .rms_m;
    if (options.registration) {
      const Estimate rms = registration_estimate(counts[k], measured.voxels, *options.registration,
                                                 measured.surroundings, measured.surroundings_voxels, sighted);
      one.values["registration"] = {kMillimetres * rms.value, kMillimetres * rms.standard_error};
    }
    one.names = options.names, one.visit = std::move(visit);
    if (site.on_site) add_sessions(one, *site.on_site);
    if (site.area && site.clash)
      one.moves = station_moves(*site.area, *site.clash, site.simulator.scanner().height_m, stations[k]);
    if (options.attainable) one.attainable = attainable.coverage(), one.attainable_growth = options.attainable_growth;
    one.link_overlap = options.link_overlap, one.link = options.link;
    look_through_glass(one, site.simulator, progress);
    if (site.on_site) one.storey_ties = storey_ties_of(one, *site.on_site);
    one.violation = violation_of(one, options.requirements);
  }
  if (options.field && !made.front().counts.cancelled) made.front().field = std::move(field);
  for (Evaluation& one : made) one.work = work() - before;
  return made;
}

Evaluation evaluate_stations(const EvaluationSite& site, std::span<const PlacedStation> stations,
                             const EvaluationOptions& options, const Progress& progress) {
  const std::vector<PlacedStation> one(stations.begin(), stations.end());
  return std::move(evaluate_networks(site, {&one, 1}, options, progress).front());
}

}  // namespace vantage
