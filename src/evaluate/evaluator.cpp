// SPDX-License-Identifier: Apache-2.0
#include "evaluate/evaluator.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "core/part_of.hpp"
#include "core/text.hpp"
#include "evaluate/scan_data.hpp"
#include "evaluate/sight_targets.hpp"
#include "evaluate/steep_checks.hpp"
#include "evaluate/through_glass.hpp"
#include "evaluate/visibility.hpp"
#include "objective/registered_sample.hpp"
#include "placement/nearest_place.hpp"

namespace vantage {
namespace {

constexpr double kMillimetres = 1000;

RequiredInputs required_inputs_of(std::span<const Objective> measures, const EvaluationOptions& options) {
  RequiredInputs needs = vantage::required_inputs_of(measures);
  if (!options.registration) return needs;
  const bool all_surfaces = options.registration->surfaces == RegistrationSurfaces::all;
  return needs | RequiredInputs{.pairs = true,
                                .surroundings = all_surfaces,
                                .registration = options.registration->model,
                                .surroundings_registration = all_surfaces};
}

// The prediction whose error is to be known.
RegistrationOptions registration_of(const RequiredInputs& needs, const EvaluationOptions& options) {
  RegistrationOptions plain;
  if (needs.registration) plain.model = *needs.registration;
  if (needs.surroundings_registration) plain.surfaces = RegistrationSurfaces::all;
  return options.registration.value_or(plain);
}

// As many voxels as the caller wants.
EveryRayOptions registered_by(EveryRayOptions counting, std::uint64_t voxels) {
  if (voxels > 0) counting.registration_voxels = voxels, counting.registration_known = nullptr;
  return counting;
}

// "18″, 1 mm and 10 ppm"; empty: it states no calibration.
std::string calibration_text(const Scanner& scanner) {
  std::vector<std::string> parts;
  const auto add = [&](double value, const char* unit) {
    if (value > 0) parts.push_back(number(std::round(10 * value) / 10) + unit);
  };
  add(3600 * scanner.angle_accuracy.in_degrees(), "″");
  add(kMillimetres * scanner.range_accuracy_m, " mm");
  add(scanner.range_accuracy_ppm, " ppm");
  std::string text;
  for (std::size_t k = 0; k < parts.size(); ++k)
    text += (k == 0 ? "" : k + 1 == parts.size() ? " and " : ", ") + parts[k];
  return text;
}

// The texts of all scanners that stations have.
std::string calibrations_text(std::span<const PlacedStation> stations, std::span<const Scanner> scanners) {
  std::vector<std::string> told;
  for (const PlacedStation& station : stations) {
    if (!active(station)) continue;
    std::string text = calibration_text(scanners[station.setup.scanner]);
    if (!text.empty() && std::ranges::find(told, text) == told.end()) told.push_back(std::move(text));
  }
  std::string all;
  for (const std::string& text : told) all += (all.empty() ? "" : "; ") + text;
  return all;
}

}  // namespace

Evaluator::Evaluator(const EvaluationSite& site, EvaluationOptions options, std::vector<Objective> measures)
    : site_(site),
      options_(std::move(options)),
      measures_(std::move(measures)),
      needs_(required_inputs_of(measures_, options_)) {
  if (options_.registration) options_.registration = levelled_by(*options_.registration, site_.simulator.scanners());
}

CountedNetworks Evaluator::count(std::span<const Network> networks, bool field, const Progress& progress) const {
  CountedNetworks counts;
  const std::size_t parts = site_.surroundings ? 2 : 1;
  if (options_.sample_voxels) {
    counts.surveyed = site_.simulator.evaluate_sampled(networks,
                                                       {.voxels = *options_.sample_voxels,
                                                        .overlap = options_.overlap,
                                                        .registration = needs_.registration,
                                                        .meshes = needs_.meshes},
                                                       part_of(progress, 0, parts));
  } else {
    EveryRayOptions every_ray = registered_by(
        count_surveyed(needs_, registration_of(needs_, options_), site_.simulator), options_.registration_voxels);
    every_ray.overlap = options_.overlap, every_ray.skip = options_.skip;
    every_ray.beam = options_.beam, every_ray.meshes = needs_.meshes;
    if (field) every_ray.field = &counts.field;
    const Progress own = part_of(progress, 0, parts);
    if (networks.size() == 1)
      counts.surveyed.push_back(site_.simulator.evaluate(networks.front(), every_ray, own));
    else
      counts.surveyed = site_.simulator.evaluate_each(networks, every_ray, own);
  }
  if (site_.surroundings)
    counts.surroundings = site_.surroundings->evaluate_each(
        networks,
        registered_by(count_surroundings(needs_, registration_of(needs_, options_), counts.surveyed, site_.simulator,
                                         *site_.surroundings),
                      options_.registration_voxels),
        part_of(progress, 1, parts));
  return counts;
}

MeasuredNetwork Evaluator::measured(const CountedNetwork& network, const RequiredInputs& needs) const {
  const std::size_t existing = existing_count(network.stations);
  const auto visible_parts = [&] {
    return visibility_parts([&](const Vec3& a, const Vec3& b) { return site_.clash->sees(a, b); },
                            site_.simulator.scanner().max_range_m, to_network(network.stations));
  };
  const auto minutes = [&] {
    return network.visit ? network.visit->minutes : site_.on_site->visit(network.stations.subspan(existing)).minutes;
  };
  MeasuredNetwork made{.counts = network.surveyed,
                       .stations = network.stations,
                       .existing = existing,
                       .goal_density = site_.simulator.goal_density(),
                       .voxels = site_.simulator.voxel_count(),
                       .overlap = needs.pairs ? overlap_matrix(network.surveyed) : OverlapMatrix{},
                       .visible_parts = needs.visibility ? visible_parts() : 0,
                       .surroundings = network.surroundings,
                       .surroundings_voxels = network.surroundings ? site_.surroundings->voxel_count() : 0,
                       .minutes_on_site = needs.time ? minutes() : 0,
                       .scene = &site_.simulator.scene()};
  if (needs.attainable) made.captured = network.captured.all, made.captured_of_meshes = network.captured.meshes;
  return made;
}

Visit Evaluator::visit(const CountedNetwork& network, double most_min) const {
  std::optional<StationLinks> links;
  if (network.surroundings)
    links = station_links(scan_overlap_matrix(*network.surroundings), options_.link, network.stations);
  else if (needs_.pairs)
    links = station_links(overlap_matrix(network.surveyed), options_.link_overlap, network.stations);
  return visit_of(network.stations, links, *site_.on_site, most_min);
}

Evaluation Evaluator::evaluate(const CountedNetwork& network) const {
  const MeasuredNetwork measured = this->measured(network, needs_);
  const std::optional<RegistrationOptions>& registration = options_.registration;
  std::vector<Target> targets = options_.targets;
  std::vector<RegistrationTarget> sighted;
  if (!targets.empty())
    sighted = sight_targets(site_.simulator, *site_.clash, network.stations, targets, options_.target);
  Evaluation made = evaluation_of(measured, measures_, registration, sighted);
  take_options(made, options_);
  made.data = scan_data(network, site_.simulator, site_.surroundings);
  if (made.values.contains("registration") || registration)
    made.calibration = calibrations_text(made.stations, site_.simulator.scanners());
  made.targets = std::move(targets);
  if (registration && !made.targets.empty())
    made.without_targets_m = registration_error(network.surveyed, measured.voxels, *registration, network.surroundings,
                                                measured.surroundings_voxels)
                                 .rms_m;
  if (registration && std::ranges::count(measures_, "registration", &Objective::name) == 0) {
    const Estimate rms = registration_estimate(network.surveyed, measured.voxels, *registration, network.surroundings,
                                               measured.surroundings_voxels, sighted);
    made.values["registration"] = {kMillimetres * rms.value, kMillimetres * rms.standard_error};
  }
  if (network.visit) made.visit = *network.visit;
  made.attainable = network.attainable;
  if (made.attainable) made.attainable_growth = options_.attainable_growth;
  if (network.field) made.field = std::move(*network.field);
  made.violation = violation_of(made, options_.requirements);
  return made;
}

void take_options(Evaluation& evaluation, const EvaluationOptions& options) {
  evaluation.names = options.names;
  if (!evaluation.names.empty()) evaluation.names.resize(evaluation.stations.size());
  evaluation.link_overlap = options.link_overlap, evaluation.link = options.link;
  evaluation.accuracy_class = wanted_class(options.target);
}

void add_round(Evaluation& evaluation, const OnSite& on_site, double most_min) {
  evaluation.visit = visit_of(evaluation.stations, evaluation.links(), on_site, most_min);
  if (const auto time = evaluation.values.find("time"); time != evaluation.values.end())
    if (!std::isnan(time->second.value)) time->second.value = evaluation.visit->minutes;
}

void look_closer(Evaluation& evaluation, const EvaluationSite& site) {
  if (site.on_site && evaluation.visit) {
    add_sessions(evaluation, *site.on_site);
    evaluation.storey_ties = storey_ties_of(evaluation, *site.on_site);
  }
  if (site.area && site.clash)
    evaluation.moves = station_moves(*site.area, *site.clash, site.simulator.scanner().height_m, evaluation.stations);
}

void complete(Evaluation& evaluation, const EvaluationSite& site, const Progress& progress) {
  look_closer(evaluation, site);
  look_through_glass(evaluation, site.simulator, progress);
  if (site.clash) add_steep_checks(evaluation, site.simulator, *site.clash);
}

}  // namespace vantage
