// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>

#include "core/closest_name.hpp"
#include "core/graph.hpp"
#include "vantage/error.hpp"
#include "vantage/evaluate.hpp"
#include "vantage/evaluation.hpp"
#include "vantage/registration.hpp"

namespace vantage {

Network to_network(std::span<const PlacedStation> stations) {
  Network network;
  network.reserve(stations.size());
  for (const PlacedStation& station : stations)
    network.push_back({.position = station.position, .active = active(station), .setup = station.setup});
  return network;
}

Visit visit_of(std::span<const PlacedStation> stations, const std::optional<StationLinks>& links, const OnSite& on_site,
               double most_min) {
  const std::size_t existing = existing_count(stations);
  const std::span<const PlacedStation> placed = stations.subspan(existing);
  if (!links) return on_site.visit(placed);
  return on_site.visit(
      placed,
      [&](std::size_t a, std::size_t b) {
        const double value = links->values(existing + a, existing + b);
        return value >= links->least ? value : 0;
      },
      most_min);
}

void add_sessions(Evaluation& evaluation, const OnSite& on_site) {
  if (!evaluation.visit || !on_site.options().day_min) return;
  const std::vector<PlacedStation>& stations = evaluation.stations;
  const std::size_t existing = existing_count(stations);
  LinkStrength link;
  const std::optional<StationLinks> links = evaluation.links();
  // Scans that were taken before are there in every session.
  Components held;
  std::vector<std::vector<char>> by;  // by component of existing stations, the placed ones that it is linked to
  if (links) {
    const auto linked = [&](std::size_t a, std::size_t b) {
      return active(stations[a]) && active(stations[b]) && links->values(a, b) > 0 &&
             links->values(a, b) >= links->least;
    };
    held = components(existing, linked);
    by.assign(held.count, std::vector<char>(stations.size() - existing, 0));
    for (std::size_t k = 0; k < existing; ++k)
      for (std::size_t s = existing; s < stations.size(); ++s) by[held.of[k]][s - existing] |= linked(k, s);
    link = [&, linked, existing](std::size_t a, std::size_t b) {
      const bool through =
          std::ranges::any_of(by, [&](const std::vector<char>& known) { return known[a] && known[b]; });
      return linked(existing + a, existing + b) || through ? 1 : 0;
    };
  }
  evaluation.visit->day_min = *on_site.options().day_min;
  try {
    const std::span<const PlacedStation> placed = std::span(stations).subspan(existing);
    on_site.add_windows(placed, *evaluation.visit);
    evaluation.visit->sessions = on_site.sessions(placed, *evaluation.visit, link);
  } catch (const Error& error) {  // a plan that took hours is worth more than its days
    if (error.code() != Errc::invalid_argument) throw;
    evaluation.visit->not_split = error.what();
  }
}

std::size_t closed_stations(const Evaluation& evaluation) {
  return evaluation.visit ? evaluation.visit->closed.size() : 0;
}

double most_minutes(std::span<const Requirement> requirements) {
  double most = std::numeric_limits<double>::infinity();
  for (const Requirement& requirement : requirements)
    if (requirement.objective.needs.time && requirement.bound == Requirement::Bound::at_most)
      most = std::min(most, requirement.limit);
  return most;
}

double violation_of(const Evaluation& evaluation, std::span<const Requirement> requirements) {
  double violation = 0;
  for (const Requirement& requirement : requirements)
    violation += requirement.missed_by(evaluation.estimate(requirement.objective.name));
  return violation;
}

const Estimate& Evaluation::estimate(const std::string& measure) const {
  const auto found = values.find(measure);
  if (found != values.end()) return found->second;
  if (counts.cancelled) throw Error(Errc::invalid_argument, measure + ": the evaluation was stopped and has no values");
  std::vector<std::string> names;
  for (const auto& [name, value] : values) names.push_back(name);
  std::string what = "the evaluation has no \"" + measure + "\"";
  if (const std::string near = did_you_mean(measure, names); !near.empty())
    throw Error(Errc::invalid_argument, what + near);
  what += "; it has ";
  for (const std::string& name : names) what += (&name == names.data() ? "" : ", ") + name;
  throw Error(Errc::invalid_argument, what + (names.empty() ? "no values" : "; name others in what is to be measured"));
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
