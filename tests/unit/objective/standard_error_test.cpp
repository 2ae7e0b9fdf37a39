// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/philox.hpp"
#include "vantage/objective.hpp"

namespace vantage {
namespace {

// A strip of voxels with points and station masks, smooth along the strip as a surface along the Morton order.
struct Strip {
  std::vector<std::uint32_t> points;
  std::vector<std::uint64_t> masks;
  std::uint32_t stations = 0;
  std::vector<std::uint32_t> weights = {};
  std::uint32_t weight(std::size_t v) const { return weights.empty() ? 1 : weights[v]; }
};

Strip make_strip(std::size_t voxels, std::uint32_t stations, std::uint64_t seed) {
  RandomStream random(seed);
  Strip strip{std::vector<std::uint32_t>(voxels), std::vector<std::uint64_t>(voxels), stations};
  for (std::uint32_t s = 0; s < stations; ++s) {
    const double centre = random.uniform(), width = 0.2 + 0.2 * random.uniform();
    for (std::size_t v = 0; v < voxels; ++v) {
      const double x = std::abs(static_cast<double>(v) / static_cast<double>(voxels) - centre) / width;
      if (x < 1 && random.uniform() < 1 - 0.5 * x) {
        strip.masks[v] |= 1ull << s;
        strip.points[v] += 1 + random.bits() % 3;
      }
    }
  }
  return strip;
}

void count_voxel(NetworkCounts& counts, const Strip& strip, std::size_t v, double goal) {
  ++counts.voxels;
  counts.weight += strip.weight(v);
  if (strip.points[v] >= goal)
    counts.saturated += strip.weight(v);
  else
    counts.partial_points += strip.points[v] * strip.weight(v);
  std::size_t pair = 0;
  for (std::uint32_t i = 0; i < strip.stations; ++i) {
    counts.seen[i] += strip.masks[v] >> i & 1;
    for (std::uint32_t j = i + 1; j < strip.stations; ++j, ++pair)
      counts.shared[pair] += (strip.masks[v] >> i & 1) & (strip.masks[v] >> j & 1);
  }
}

// Counts that an engine would return for the voxels of `sample`.
NetworkCounts count(const Strip& strip, const std::vector<std::size_t>& sample, double goal, std::size_t groups) {
  NetworkCounts counts;
  counts.stations = strip.stations;
  counts.seen.assign(strip.stations, 0);
  counts.shared.assign(strip.stations * (strip.stations - 1) / 2, 0);
  counts.groups.assign(groups, counts);
  double before = 0;
  for (std::size_t k = 0; k < sample.size(); ++k) {
    count_voxel(counts, strip, sample[k], goal);
    if (groups > 0) count_voxel(counts.groups[k % groups], strip, sample[k], goal);
    const double filled = std::min(strip.points[sample[k]] / goal, 1.0);
    if (k > 0) counts.successive_difference_sum += (filled - before) * (filled - before);
    before = filled;
  }
  return counts;
}

std::vector<std::size_t> every(std::size_t step, std::size_t start, std::size_t voxels) {
  std::vector<std::size_t> sample;
  for (std::size_t v = start; v < voxels; v += step) sample.push_back(v);
  return sample;
}

TEST(CoverageEstimate, IsTheFormula) {
  NetworkCounts counts;
  counts.voxels = counts.weight = 5;
  counts.saturated = 2;
  counts.partial_points = 3;
  counts.successive_difference_sum = 1.25;
  const Estimate e = coverage_estimate(counts, 4, 20);
  EXPECT_DOUBLE_EQ(e.value, (2 + 3.0 / 4) / 5);
  EXPECT_DOUBLE_EQ(e.standard_error, std::sqrt((1 - 5.0 / 20) * 1.25 / (2 * 5 * 4)));
  // Two voxels suffice.
  counts.voxels = counts.weight = 2;
  counts.saturated = 1, counts.partial_points = 0, counts.successive_difference_sum = 1;
  EXPECT_DOUBLE_EQ(coverage_estimate(counts, 4, 20).standard_error, std::sqrt((1 - 2.0 / 20) / (2 * 2 * 1)));
}

TEST(CoverageEstimate, WithoutDifferencesKnowsNothing) {
  NetworkCounts counts;
  counts.voxels = counts.weight = 5;
  counts.saturated = 2;
  counts.successive_difference_sum = std::numeric_limits<double>::infinity();
  EXPECT_EQ(coverage_estimate(counts, 4, 20).standard_error, 0.5);  // the largest error of a value in [0, 1]
  EXPECT_EQ(coverage_estimate(counts, 4, 5).standard_error, 0.0);   // every voxel
}

TEST(OverlapEstimate, IsTheJackknife) {
  // Three stations and two groups with different pair overlaps; the replicates are then the other group's coefficients.
  NetworkCounts group;
  group.stations = 3;
  group.voxels = 10;
  group.seen = {8, 8, 8};
  group.shared = {8, 8, 8};
  NetworkCounts other = group;
  other.shared = {4, 2, 1};  // overlaps 4/12, 2/14, 1/15
  NetworkCounts all = group;
  all.voxels = 20;
  for (int i = 0; i < 3; ++i) {
    all.seen[i] += other.seen[i];
    all.shared[i] += other.shared[i];
  }
  all.groups = {group, other};
  const double a = 4.0 / 12, b = 2.0 / 14, c = 1.0 / 15;
  const double other_coefficient = (c + b + a) / a / 3, mean = (1 + other_coefficient) / 2;
  const double squares = 2 * (1 - mean) * (1 - mean);
  EXPECT_NEAR(overlap_estimate(all, 100).standard_error, std::sqrt(0.8 * 0.5 * squares), 1e-15);
  // Pair (0, 1): replicates 4/12 and 1.
  const double pair_mean = (1 + a) / 2;
  EXPECT_NEAR(overlap_standard_errors(all, 100)(0, 1), std::sqrt(0.8 * 0.5 * 2 * (1 - pair_mean) * (1 - pair_mean)),
              1e-15);
  EXPECT_EQ(overlap_standard_errors(all, 100)(2, 2), 0.0);
}

TEST(StandardErrors, AreZeroForTheWholePopulation) {
  const Strip strip = make_strip(400, 4, 1);
  const NetworkCounts counts = count(strip, every(1, 0, 400), 2.5, 20);
  EXPECT_GT(counts.successive_difference_sum, 0.0);
  EXPECT_EQ(coverage_estimate(counts, 2.5, 400).standard_error, 0.0);
  EXPECT_EQ(overlap_estimate(counts, 400).standard_error, 0.0);
  EXPECT_EQ(overlap_standard_errors(counts, 400)(0, 1), 0.0);
  // An exact evaluation has no groups.
  const NetworkCounts exact = count(strip, every(1, 0, 400), 2.5, 0);
  EXPECT_EQ(overlap_estimate(exact, 400).standard_error, 0.0);
  EXPECT_EQ(overlap_estimate(exact, 400).value, overlap_estimate(counts, 400).value);
}

TEST(StandardErrors, AreTheLargestWhereOneVoxelTellsNothing) {
  const Strip strip = make_strip(400, 3, 2);
  const NetworkCounts one = count(strip, {7}, 2.5, 20);
  EXPECT_EQ(coverage_estimate(one, 2.5, 400).standard_error, 0.5);
  EXPECT_EQ(overlap_estimate(one, 400).standard_error, 0.5);
  EXPECT_EQ(overlap_standard_errors(one, 400)(0, 1), 0.5);
}

TEST(StandardErrors, OfStationsWithoutMasksAreZero) {
  NetworkCounts counts;
  counts.voxels = 10;
  counts.stations = 4;
  EXPECT_EQ(overlap_estimate(counts, 100).standard_error, 0.0);
  EXPECT_EQ(overlap_standard_errors(counts, 100)(1, 2), 0.0);
}

// Over all systematic samples of many strips: how often the true value is within 1.96 standard errors.
TEST(StandardErrors, IntervalsHoldTheTruth) {
  constexpr std::size_t voxels = 12'000, step = 12;
  constexpr double goal = 3.5;
  int trials = 0, coverage_held = 0, overlap_held = 0, pairs = 0, pairs_held = 0;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    const Strip strip = make_strip(voxels, 6, seed);
    const NetworkCounts truth = count(strip, every(1, 0, voxels), goal, 0);
    const double true_coverage = coverage(truth, goal);
    const OverlapMatrix true_overlap = overlap_matrix(truth);
    const double true_clustering = clustering_coefficient(true_overlap);
    for (std::size_t start = 0; start < step; ++start, ++trials) {
      const NetworkCounts sample = count(strip, every(step, start, voxels), goal, 20);
      const Estimate c = coverage_estimate(sample, goal, voxels), o = overlap_estimate(sample, voxels);
      coverage_held += std::abs(c.value - true_coverage) <= 1.96 * c.standard_error;
      overlap_held += std::abs(o.value - true_clustering) <= 1.96 * o.standard_error;
      const OverlapMatrix values = overlap_matrix(sample);
      const PairMatrix errors = overlap_standard_errors(sample, voxels);
      for (std::size_t i = 0; i < 6; ++i) {
        for (std::size_t j = i + 1; j < 6; ++j) {
          if (true_overlap(i, j) < 0.05) continue;  // too few shared voxels for a normal interval
          ++pairs;
          pairs_held += std::abs(values(i, j) - true_overlap(i, j)) <= 1.96 * errors(i, j);
        }
      }
    }
  }
  // Binomial: 144 trials at 0.95 stay within ±0.055 except once in 400; pairs of one trial are correlated.
  EXPECT_NEAR(static_cast<double>(coverage_held) / trials, 0.95, 0.05);
  EXPECT_NEAR(static_cast<double>(overlap_held) / trials, 0.95, 0.06);
  EXPECT_NEAR(static_cast<double>(pairs_held) / pairs, 0.95, 0.05);
}

// Cube roots of small shares are biased low.
TEST(OverlapEstimate, IsLessItsBias) {
  constexpr std::size_t voxels = 12'000;
  for (const std::size_t step : {12, 20, 30}) {
    double seen = 0, told = 0;
    for (std::uint64_t seed = 0; seed < 12; ++seed) {
      const Strip strip = make_strip(voxels, 6, seed);
      const double truth = clustering_coefficient(overlap_matrix(count(strip, every(1, 0, voxels), 3.5, 0)));
      for (std::size_t start = 0; start < step; ++start) {
        const NetworkCounts sample = count(strip, every(step, start, voxels), 3.5, 20);
        seen += clustering_coefficient(overlap_matrix(sample)) - truth;
        told += overlap_estimate(sample, voxels).value - truth;
      }
    }
    EXPECT_LT(seen, 0) << step;
    EXPECT_LT(std::abs(told), 0.75 * std::abs(seen)) << step << " " << seen << " " << told;
  }
}

// Faint links beside strong ones, of which a sample of a fortieth holds one voxel or none. Leaving out one group at a
// time removes less than half of the coefficient's bias, and too few intervals hold.
TEST(OverlapEstimate, KnowsOfLinksThatRestOnAFewVoxels) {
  constexpr std::size_t voxels = 24'000, step = 40;
  double seen = 0, told = 0;
  int trials = 0, held = 0;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    Strip strip = make_strip(voxels, 8, seed);
    RandomStream random(100 + seed);
    for (std::size_t v = 0; v < voxels; ++v)
      if (random.uniform() < 0.005) strip.masks[v] |= std::uint64_t{1} << (random.bits() % 8);
    const double truth = clustering_coefficient(overlap_matrix(count(strip, every(1, 0, voxels), 1, 0)));
    for (std::size_t start = 0; start < step; ++start, ++trials) {
      const NetworkCounts sample = count(strip, every(step, start, voxels), 1, 20);
      const Estimate estimate = overlap_estimate(sample, voxels);
      seen += clustering_coefficient(overlap_matrix(sample)) - truth;
      told += estimate.value - truth;
      held += std::abs(estimate.value - truth) <= 1.96 * estimate.standard_error;
    }
  }
  EXPECT_LT(std::abs(told), 0.4 * std::abs(seen)) << seen / trials << " " << told / trials;
  EXPECT_NEAR(static_cast<double>(held) / trials, 0.95, 0.04);
}

// With weights coverage is a ratio: the sampled weight of the heavier stretches is itself random.
TEST(StandardErrors, WeightedIntervalsHoldTheTruth) {
  constexpr std::size_t voxels = 12'000, step = 12;
  constexpr double goal = 3.5;
  int trials = 0, held = 0;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    Strip strip = make_strip(voxels, 6, seed);
    for (std::size_t v = 0; v < voxels; ++v) strip.weights.push_back(v / 700 % 3 == 0 ? 20 : 1 + v % 2);
    const double truth = coverage(count(strip, every(1, 0, voxels), goal, 0), goal);
    for (std::size_t start = 0; start < step; ++start, ++trials) {
      const Estimate c = coverage_estimate(count(strip, every(step, start, voxels), goal, 20), goal, voxels);
      EXPECT_GT(c.standard_error, 0);
      held += std::abs(c.value - truth) <= 1.96 * c.standard_error;
    }
  }
  // The jackknife of a systematic sample is conservative.
  EXPECT_GE(static_cast<double>(held) / trials, 0.9);
}

}  // namespace
}  // namespace vantage
