// SPDX-License-Identifier: Apache-2.0
#include "vantage/evaluation.hpp"

namespace vantage {

Network to_network(std::span<const PlacedStation> stations) {
  Network network;
  network.reserve(stations.size());
  for (const PlacedStation& station : stations)
    network.push_back({.position = station.position, .active = active(station), .setup = station.setup});
  return network;
}

double violation_of(const Evaluation& evaluation, std::span<const Requirement> requirements) {
  double violation = 0;
  for (const Requirement& requirement : requirements)
    violation += requirement.missed_by(evaluation.value(requirement.objective.name));
  return violation;
}

Evaluation evaluation_of(const MeasuredNetwork& measured, std::span<const Objective> measures,
                         const std::optional<RegistrationOptions>& registration,
                         std::span<const RegistrationTarget> targets) {
  const NetworkCounts& counts = measured.counts;
  Evaluation made{.stations = {measured.stations.begin(), measured.stations.end()},
                  .exact = counts.voxels >= measured.voxels,
                  .voxels = measured.voxels,
                  .goal_density = measured.goal_density,
                  .counts = counts};
  if (registration)
    made.registration = registration_error(counts, measured.voxels, *registration, measured.surroundings,
                                           measured.surroundings_voxels, targets);
  // The measure of the same name is this error where it has no targets, and no error of a sample.
  const auto summed = [](const NetworkCounts& sums, std::uint64_t voxels) {
    return sums.registration.voxels >= voxels;
  };
  const bool whole = registration && summed(counts, measured.voxels) &&
                     (registration->surfaces != RegistrationSurfaces::all ||
                      summed(*measured.surroundings, measured.surroundings_voxels));
  ObjectiveSettings settings;
  settings.registration = registration.value_or(RegistrationOptions{});
  const Objective same = make_objective("registration", settings);
  for (const Objective& measure : measures) {
    const bool known = whole && targets.empty() && measure.name == same.name && measure.parameters == same.parameters;
    made.values[measure.name] = known ? Estimate{1000 * made.registration->rms_m, 0} : estimate(measure, measured);
  }
  if (!counts.seen.empty()) {
    made.overlap_matrix = measured.overlap.size() > 0 ? measured.overlap : overlap_matrix(counts);
    if (!counts.groups.empty()) made.overlap_errors = overlap_standard_errors(counts, measured.voxels);
  }
  if (measured.surroundings) made.scan_overlap_matrix = scan_overlap_matrix(*measured.surroundings);
  made.counts.groups.clear();
  made.counts.registration = {};
  return made;
}

}  // namespace vantage
