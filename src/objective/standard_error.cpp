// SPDX-License-Identifier: Apache-2.0
// Standard errors of sampled objectives (Wolter: Introduction to Variance Estimation, 2007: chapter 8 for systematic
// samples, chapter 4 for the jackknife), with the finite-population correction 1 − n/N.
#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "vantage/objective.hpp"

namespace vantage {
namespace {

constexpr double largest_error = 0.5;  // of the scale: the standard deviation of a value in {0, 1}

double unsampled_share(const NetworkCounts& counts, std::uint64_t population) {
  if (counts.voxels >= population) return 0;
  return 1.0 - static_cast<double>(counts.voxels) / static_cast<double>(population);
}

// What the sample holds without one of its groups.
NetworkCounts without_group(const NetworkCounts& all, const NetworkCounts& group) {
  NetworkCounts rest;
  rest.stations = all.stations;
  rest.voxels = all.voxels - group.voxels;
  rest.weight = all.weight - group.weight;
  rest.saturated = all.saturated - group.saturated;
  rest.partial_points = all.partial_points - group.partial_points;
  rest.seen.resize(all.seen.size());
  rest.shared.resize(all.shared.size());
  std::transform(all.seen.begin(), all.seen.end(), group.seen.begin(), rest.seen.begin(), std::minus<>());
  std::transform(all.shared.begin(), all.shared.end(), group.shared.begin(), rest.shared.begin(), std::minus<>());
  // Differences of sums that are exact but for their last place.
  rest.registration = all.registration;
  const auto take_off = [](std::vector<double>& sums, const std::vector<double>& some) {
    for (std::size_t k = 0; k < some.size(); ++k) sums[k] -= some[k];
  };
  take_off(rest.registration.pairs, group.registration.pairs);
  take_off(rest.registration.surface, group.registration.surface);
  return rest;
}

// `of` each delete-one-group replicate; empty where there are fewer than two groups.
template <class Value>
std::vector<Value> replicates(const NetworkCounts& counts, const std::function<Value(const NetworkCounts&)>& of) {
  std::vector<Value> found;
  for (const NetworkCounts& group : counts.groups) {
    if (group.voxels > 0) found.push_back(of(without_group(counts, group)));
  }
  if (found.size() < 2) found.clear();
  return found;
}

double jackknife_error(const std::vector<double>& values, double unsampled, double scale = 1) {
  if (values.empty()) return largest_error * scale;
  const double groups = static_cast<double>(values.size());
  double mean = 0, squares = 0;
  for (const double value : values) mean += value / groups;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return std::min(std::sqrt(unsampled * (groups - 1) / groups * squares), largest_error * scale);
}

// How much too large a function of a sample tends to be, by the same replicates (Quenouille 1956): the part of its bias
// that falls as 1/n, n counted against the population.
double jackknife_bias(double estimate, const std::vector<double>& values, double unsampled) {
  const double groups = static_cast<double>(values.size());
  double sum = 0;
  for (const double value : values) sum += value - estimate;
  return values.empty() ? 0 : unsampled * (groups - 1) / groups * sum;
}

// What is corrected must not be worse known for it.
double within_error(double bias, double error) { return std::clamp(bias, -error, error); }

}  // namespace

Estimate coverage_estimate(const NetworkCounts& counts, double goal_density, std::uint64_t population) {
  Estimate estimate{coverage(counts, goal_density), 0};
  const double unsampled = unsampled_share(counts, population);
  if (unsampled == 0) return estimate;
  if (counts.voxels < 2) {
    estimate.standard_error = largest_error;
    return estimate;
  }
  if (counts.weight != counts.voxels) {
    const auto of = [&](const NetworkCounts& rest) { return coverage(rest, goal_density); };
    estimate.standard_error = jackknife_error(replicates<double>(counts, of), unsampled);
    return estimate;
  }
  const double n = static_cast<double>(counts.voxels);
  estimate.standard_error = std::sqrt(unsampled * counts.successive_difference_sum / (2 * n * (n - 1)));
  return estimate;
}

Estimate estimate(const Objective& objective, const MeasuredNetwork& measured) {
  Estimate estimate{objective.value(measured), 0};
  const double scale = std::abs(objective.best - objective.worst);
  const NetworkCounts& counts = measured.counts;
  double variance = 0;
  const auto add = [&](double error) { variance += error * error; };
  if (const double unsampled = unsampled_share(counts, measured.voxels); objective.needs.counts && unsampled > 0) {
    if (objective.standard_error) {
      add(objective.standard_error(measured));
    } else {
      const auto of = [&](const NetworkCounts& rest) {
        return objective.value({.counts = rest,
                                .stations = measured.stations,
                                .kept = measured.kept,
                                .goal_density = measured.goal_density,
                                .voxels = measured.voxels,
                                .overlap = objective.needs.pairs ? overlap_matrix(rest) : OverlapMatrix{},
                                .visible_parts = measured.visible_parts,
                                .surroundings = measured.surroundings,
                                .surroundings_voxels = measured.surroundings_voxels,
                                .minutes_on_site = measured.minutes_on_site});
      };
      const std::vector<double> values = replicates<double>(counts, of);
      const double own = jackknife_error(values, unsampled, scale);
      estimate.value -= within_error(jackknife_bias(estimate.value, values, unsampled), own);
      add(own);
    }
  }
  // Another sample, of other voxels: its error is on top.
  if (objective.needs.surroundings && measured.surroundings) {
    const double unsampled = unsampled_share(*measured.surroundings, measured.surroundings_voxels);
    const auto of = [&](const NetworkCounts& rest) {
      MeasuredNetwork without{.counts = counts, .stations = measured.stations};
      without.kept = measured.kept, without.goal_density = measured.goal_density, without.voxels = measured.voxels;
      without.overlap = measured.overlap, without.visible_parts = measured.visible_parts;
      without.surroundings = &rest, without.surroundings_voxels = measured.surroundings_voxels;
      without.minutes_on_site = measured.minutes_on_site;
      return objective.value(without);
    };
    if (unsampled > 0) add(jackknife_error(replicates<double>(*measured.surroundings, of), unsampled, scale));
  }
  estimate.standard_error = std::sqrt(variance);
  return estimate;
}

Estimate overlap_estimate(const NetworkCounts& counts, std::uint64_t population) {
  Estimate estimate{clustering_coefficient(overlap_matrix(counts)), 0};
  const double unsampled = unsampled_share(counts, population);
  if (unsampled == 0 || counts.seen.empty()) return estimate;
  const auto of = [](const NetworkCounts& rest) { return clustering_coefficient(overlap_matrix(rest)); };
  const std::vector<double> values = replicates<double>(counts, of);
  estimate.standard_error = jackknife_error(values, unsampled);
  estimate.value -= within_error(jackknife_bias(estimate.value, values, unsampled), estimate.standard_error);
  return estimate;
}

Estimate registration_estimate(const NetworkCounts& counts, std::uint64_t voxels, const RegistrationOptions& options,
                               const NetworkCounts* surroundings, std::uint64_t surroundings_voxels) {
  const auto error = [&](const NetworkCounts& surveyed, const NetworkCounts* around) {
    return registration_error(surveyed, voxels, options, around, surroundings_voxels).rms_m;
  };
  const double seen = error(counts, surroundings);
  Estimate estimate{seen, 0};
  const auto add = [&](const std::vector<double>& values, double unsampled) {
    // Nothing is further off than where it starts.
    const double own = jackknife_error(values, unsampled, 2 * options.position_m);
    estimate.value -= within_error(jackknife_bias(seen, values, unsampled), own);
    estimate.standard_error = std::hypot(estimate.standard_error, own);
  };
  if (const double unsampled = unsampled_share(counts, voxels); unsampled > 0)
    add(replicates<double>(counts, [&](const NetworkCounts& rest) { return error(rest, surroundings); }), unsampled);
  if (options.surfaces == RegistrationSurfaces::all)
    if (const double unsampled = unsampled_share(*surroundings, surroundings_voxels); unsampled > 0)
      add(replicates<double>(*surroundings, [&](const NetworkCounts& rest) { return error(counts, &rest); }),
          unsampled);
  estimate.value = std::max(estimate.value, 0.0);
  return estimate;
}

OverlapMatrix overlap_standard_errors(const NetworkCounts& counts, std::uint64_t population) {
  OverlapMatrix errors(counts.stations);
  const double unsampled = unsampled_share(counts, population);
  if (unsampled == 0 || counts.seen.empty()) return errors;
  const std::vector<OverlapMatrix> without = replicates<OverlapMatrix>(counts, overlap_matrix);
  std::vector<double> values(without.size());
  for (std::size_t i = 0; i < counts.stations; ++i) {
    for (std::size_t j = i + 1; j < counts.stations; ++j) {
      for (std::size_t g = 0; g < without.size(); ++g) values[g] = without[g](i, j);
      errors.set(i, j, jackknife_error(values, unsampled));
    }
  }
  return errors;
}

}  // namespace vantage
