// SPDX-License-Identifier: Apache-2.0
// Standard errors of sampled objectives (Wolter: Introduction to Variance Estimation, 2007: chapter 8 for systematic
// samples, chapter 4 for the jackknife), with the finite-population correction 1 − n/N.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numeric>
#include <utility>
#include <vector>

#include "core/parallel.hpp"
#include "objective/number_of.hpp"
#include "objective/whole_counts.hpp"
#include "trace/registration_sums.hpp"
#include "vantage/objective.hpp"
#include "vantage/registration.hpp"

namespace vantage {
namespace {

constexpr double kLargestStandardError = 0.5;  // of the scale: the standard deviation of a value in {0, 1}
constexpr double kLeastUnbiased = 0.5;  // least share of a sample's registration error after subtracting its bias

// Sums that a function reads. With hundreds of stations, those of registration are by far the most; they may come from
// a sample although every voxel was counted.
enum class Sums : std::uint8_t { none, registration };

double unsampled_share(const NetworkCounts& counts, std::uint64_t population, Sums sums = Sums::none) {
  const std::uint64_t voxels = sums == Sums::registration ? counts.registration.voxels : counts.voxels;
  if (voxels >= population) return 0;
  return 1.0 - static_cast<double>(voxels) / static_cast<double>(population);
}

// Returns the sample's own counts, without its groups.
NetworkCounts without_groups(const NetworkCounts& all, Sums sums) {
  NetworkCounts rest;
  rest.stations = all.stations;
  rest.voxels = all.voxels, rest.weight = all.weight;
  rest.saturated = all.saturated, rest.partial_points = all.partial_points, rest.point_weight = all.point_weight;
  rest.seen = all.seen, rest.shared = all.shared, rest.meshes = all.meshes;
  if (sums == Sums::none) return rest;
  const RegistrationSums& registration = all.registration;
  rest.registration = {.voxels = registration.voxels,
                       .centre = registration.centre,
                       .radius_m = registration.radius_m,
                       .heads = registration.heads,
                       .pairs = registration.pairs,
                       .surface = registration.surface,
                       .instrument = registration.instrument,
                       .groups = {}};
  return rest;
}

void subtract(auto& sums, const auto& some) {
  for (std::size_t k = 0; k < some.size(); ++k) sums[k] -= some[k];
}

void take_off(NetworkCounts& rest, const NetworkCounts& group) {
  rest.voxels -= group.voxels, rest.weight -= group.weight;
  rest.saturated -= group.saturated, rest.partial_points -= group.partial_points;
  subtract(rest.seen, group.seen);
  subtract(rest.shared, group.shared);
  for (std::size_t m = 0; m < group.meshes.size(); ++m) {
    rest.meshes[m].voxels -= group.meshes[m].voxels;
    rest.meshes[m].captured -= group.meshes[m].captured;
  }
}

// Subtracts a group; differences of sums are exact except for their last place. A group of a large network lacks pairs
// without any sum.
void take_off(RegistrationSums& rest, const RegistrationSums& group) {
  rest.voxels -= group.voxels;
  if (group.pairs.size() < rest.pairs.size()) {
    std::size_t at = 0;
    for_summed_pairs(rest, [&](std::size_t first) {
      for (std::size_t k = first; k < first + RegistrationSums::of_pair; ++k) rest.pairs[k] -= group.pairs[at++];
    });
  } else {
    subtract(rest.pairs, group.pairs);
  }
  subtract(rest.surface, group.surface);
  subtract(rest.instrument, group.instrument);
}

// Returns `of` for each delete-one-group replicate, in parallel and with `whole` beside them; empty if there are fewer
// than two groups.
template <class Value>
std::vector<Value> replicates(
    const NetworkCounts& counts, Sums sums, const std::function<Value(const NetworkCounts&)>& of,
    const std::function<void()>& whole = [] {}) {
  const bool registered = sums == Sums::registration;
  const std::vector<RegistrationSums>& parts = counts.registration.groups;
  std::vector<std::size_t> groups;
  for (std::size_t g = 0; g < (registered ? parts.size() : counts.groups.size()); ++g)
    if ((registered ? parts[g].voxels : counts.groups[g].voxels) > 0) groups.push_back(g);
  if (groups.size() < 2) {
    whole();
    return {};
  }
  std::vector<Value> found(groups.size());
  const NetworkCounts all = without_groups(counts, sums);
  parallel::for_all(std::size_t{0}, groups.size() + 1, [&](std::size_t k) {
    if (k == groups.size()) return whole();
    const std::size_t g = groups[k];
    NetworkCounts rest = all;
    if (registered) take_off(rest.registration, parts[g]);
    // The counts have no groups if every voxel was counted and only the sums are of a sample.
    if (g < counts.groups.size()) take_off(rest, counts.groups[g]);
    found[k] = of(rest);
  });
  return found;
}

double jackknife_error(const std::vector<double>& values, double unsampled, double scale = 1) {
  if (values.empty()) return kLargestStandardError * scale;
  const double groups = static_cast<double>(values.size());
  double mean = 0, squares = 0;
  for (const double value : values) mean += value / groups;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return std::min(std::sqrt(unsampled * (groups - 1) / groups * squares), kLargestStandardError * scale);
}

// Returns the bias of a function of a sample, by the same replicates (Quenouille 1956): the part that falls as 1/n,
// with n counted against the population.
double jackknife_bias(double estimate, const std::vector<double>& values, double unsampled) {
  const double groups = static_cast<double>(values.size());
  double sum = 0;
  for (const double value : values) sum += value - estimate;
  return values.empty() ? 0 : unsampled * (groups - 1) / groups * sum;
}

// A correction must not exceed its own uncertainty.
double within_error(double bias, double error) { return std::clamp(bias, -error, error); }

Estimate jackknifed(double seen, const std::vector<double>& values, double unsampled, double scale) {
  const double error = jackknife_error(values, unsampled, scale);
  return {seen - within_error(jackknife_bias(seen, values, unsampled), error), error};
}

// Returns true if group g of 20 is in half r < 19 of them: the rows of Paley's Hadamard matrix of order 20, by the
// squares modulo 19. Each group is in as many halves as any other, and equally often with each other group (McCarthy:
// Pseudo-replication: Half samples, 1969).
constexpr std::size_t kHalvedGroups = 20;
bool in_half(std::size_t r, std::size_t g) {
  constexpr std::size_t kPrime = kHalvedGroups - 1;
  constexpr std::uint32_t kSquares = [] {
    std::uint32_t bits = 0;
    for (std::size_t k = 1; k < kPrime; ++k) bits |= 1u << (k * k % kPrime);
    return bits;
  }();
  return g == kPrime || (kSquares >> ((g + kPrime - r) % kPrime) & 1) == 1;
}

// Returns the mean excess of half a sample over the whole, over balanced halves and their complements. Unlike leaving
// out a twentieth, this shows the loss of links that depend on a few voxels.
double halving_bias(double estimate, const NetworkCounts& counts, double unsampled,
                    const std::function<double(const NetworkCounts&)>& of) {
  constexpr std::size_t kHalvings = kHalvedGroups - 1;
  const NetworkCounts all = without_groups(counts, Sums::none);
  std::array<double, kHalvings> excess{};
  parallel::for_all(std::size_t{0}, kHalvings, [&](std::size_t r) {
    NetworkCounts half = all, other = all;
    for (std::size_t g = 0; g < kHalvedGroups; ++g) take_off(in_half(r, g) ? half : other, counts.groups[g]);
    excess[r] = (of(half) - estimate) + (of(other) - estimate);
  });
  const double sum = std::accumulate(excess.begin(), excess.end(), 0.0);
  return unsampled * sum / (2.0 * kHalvings);
}

// Estimates functions of pairs: links may depend on a few voxels, of which a sample holds one or none. The correction's
// own error is as large as the correction.
Estimate of_pairs(double seen, const NetworkCounts& counts, double unsampled, double scale,
                  const std::function<double(const NetworkCounts&)>& of) {
  const std::vector<double> values = replicates<double>(counts, Sums::none, of);
  if (values.size() != kHalvedGroups) return jackknifed(seen, values, unsampled, scale);
  const double error = jackknife_error(values, unsampled, scale);
  const double bias = halving_bias(seen, counts, unsampled, of);
  return {seen - bias, std::min(std::hypot(error, bias), kLargestStandardError * scale)};
}

}  // namespace

Estimate coverage_estimate(const NetworkCounts& counts, double goal_density, std::uint64_t population) {
  Estimate estimate{coverage(counts, goal_density), 0};
  const double unsampled = unsampled_share(counts, population);
  if (unsampled == 0) return estimate;
  if (counts.voxels < 2) {
    estimate.standard_error = kLargestStandardError;
    return estimate;
  }
  if (counts.weight != counts.voxels) {
    const auto of = [&](const NetworkCounts& rest) { return coverage(rest, goal_density); };
    estimate.standard_error = jackknife_error(replicates<double>(counts, Sums::none, of), unsampled);
    return estimate;
  }
  const double n = static_cast<double>(counts.voxels);
  estimate.standard_error =
      std::min(std::sqrt(unsampled * counts.successive_difference_sum / (2 * n * (n - 1))), kLargestStandardError);
  return estimate;
}

Estimate estimate(const Objective& objective, const MeasuredNetwork& measured) {
  require_whole(measured.counts, objective.name.c_str());
  if (measured.surroundings) require_whole(*measured.surroundings, objective.name.c_str());
  Estimate estimate;
  const auto whole = [&] { estimate.value = number_of(objective, measured); };
  const double scale = objective.scale.width();
  const NetworkCounts& counts = measured.counts;
  double variance = 0;
  const auto add = [&](double error) { variance += error * error; };
  // These objectives have voxels of their own, whatever else was counted.
  if (objective.needs.attainable && objective.standard_error) add(objective.standard_error(measured));
  const bool registered = objective.needs.registration.has_value();
  const Sums sums = registered ? Sums::registration : Sums::none;
  const double unsampled = objective.needs.counts ? unsampled_share(counts, measured.voxels, sums) : 0;
  if (unsampled == 0 || objective.standard_error) whole();
  if (unsampled > 0 && objective.standard_error) {
    add(objective.standard_error(measured));
  } else if (unsampled > 0) {
    const auto of = [&](const NetworkCounts& rest) {
      return objective.value({.counts = rest,
                              .stations = measured.stations,
                              .existing = measured.existing,
                              .goal_density = measured.goal_density,
                              .voxels = measured.voxels,
                              .overlap = objective.needs.pairs ? overlap_matrix(rest) : OverlapMatrix{},
                              .visible_parts = measured.visible_parts,
                              .surroundings = measured.surroundings,
                              .surroundings_voxels = measured.surroundings_voxels,
                              .minutes_on_site = measured.minutes_on_site,
                              .scene = measured.scene});
    };
    if (objective.needs.pairs && !registered) {
      whole();
      const Estimate own = of_pairs(estimate.value, counts, unsampled, scale, of);
      estimate.value = own.value;
      add(own.standard_error);
    } else {
      const std::vector<double> values = replicates<double>(counts, sums, of, whole);
      const Estimate own = jackknifed(estimate.value, values, unsampled, scale);
      // As `registration_estimate`: no registration is without error.
      estimate.value = registered ? std::max(own.value, kLeastUnbiased * estimate.value) : own.value;
      add(own.standard_error);
    }
  }
  // The surroundings are another sample, of other voxels: its error adds.
  if (objective.needs.surroundings && measured.surroundings) {
    const Sums around = objective.needs.surroundings_registration ? Sums::registration : Sums::none;
    const double unseen = unsampled_share(*measured.surroundings, measured.surroundings_voxels, around);
    const auto of = [&](const NetworkCounts& rest) {
      MeasuredNetwork without{.counts = counts, .stations = measured.stations};
      without.existing = measured.existing, without.goal_density = measured.goal_density,
      without.voxels = measured.voxels;
      without.overlap = measured.overlap, without.visible_parts = measured.visible_parts;
      without.surroundings = &rest, without.surroundings_voxels = measured.surroundings_voxels;
      without.minutes_on_site = measured.minutes_on_site, without.scene = measured.scene;
      return objective.value(without);
    };
    if (unseen > 0) add(jackknife_error(replicates<double>(*measured.surroundings, around, of), unseen, scale));
  }
  estimate.standard_error = std::sqrt(variance);
  return estimate;
}

Estimate overlap_estimate(const NetworkCounts& counts, std::uint64_t population) {
  Estimate estimate{clustering_coefficient(overlap_matrix(counts)), 0};
  const double unsampled = unsampled_share(counts, population);
  if (unsampled == 0 || counts.seen.empty()) return estimate;
  const auto of = [](const NetworkCounts& rest) { return clustering_coefficient(overlap_matrix(rest)); };
  return of_pairs(estimate.value, counts, unsampled, 1, of);
}

Estimate registration_estimate(const NetworkCounts& counts, std::uint64_t voxels, const RegistrationOptions& options,
                               const NetworkCounts* surroundings, std::uint64_t surroundings_voxels,
                               std::span<const RegistrationTarget> targets) {
  const auto error = [&](const NetworkCounts& surveyed, const NetworkCounts* around) {
    return registration_error(surveyed, voxels, options, around, surroundings_voxels, targets).rms_m;
  };
  double seen = 0;
  const auto whole = [&] { seen = error(counts, surroundings); };
  std::vector<std::pair<std::vector<double>, double>> sampled;  // replicates, and the unsampled share
  if (const double unsampled = unsampled_share(counts, voxels, Sums::registration); unsampled > 0)
    sampled.emplace_back(
        replicates<double>(
            counts, Sums::registration, [&](const NetworkCounts& rest) { return error(rest, surroundings); }, whole),
        unsampled);
  else
    whole();
  if (options.surfaces == RegistrationSurfaces::all)
    if (const double unsampled = unsampled_share(*surroundings, surroundings_voxels, Sums::registration); unsampled > 0)
      sampled.emplace_back(replicates<double>(*surroundings, Sums::registration,
                                              [&](const NetworkCounts& rest) { return error(counts, &rest); }),
                           unsampled);
  Estimate estimate{seen, 0};
  for (const auto& [values, unsampled] : sampled) {
    // No error exceeds the prior.
    const double own = jackknife_error(values, unsampled, 2 * options.position_m);
    estimate.value -= within_error(jackknife_bias(seen, values, unsampled), own);
    estimate.standard_error = std::hypot(estimate.standard_error, own);
  }
  // An apparently larger bias means that the weakest link depends on voxels of one group, so that the sample cannot
  // show its size. Still, no registration is without error.
  estimate.value = std::max(estimate.value, kLeastUnbiased * seen);
  return estimate;
}

PairMatrix overlap_standard_errors(const NetworkCounts& counts, std::uint64_t population) {
  require_whole(counts, "standard errors of overlap");
  PairMatrix errors(counts.stations);
  const double unsampled = unsampled_share(counts, population);
  if (unsampled == 0 || counts.seen.empty()) return errors;
  const std::vector<OverlapMatrix> without = replicates<OverlapMatrix>(counts, Sums::none, overlap_matrix);
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
