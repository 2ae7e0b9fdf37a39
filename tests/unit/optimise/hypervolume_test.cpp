// SPDX-License-Identifier: Apache-2.0
#include "optimise/hypervolume.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "optimise/normal_stream.hpp"
#include "vantage/error.hpp"
#include "vantage/optimiser.hpp"

namespace vantage {
namespace {

using optimise::PointSet;

// The union of boxes by inclusion–exclusion over all subsets: exact, and independent of the code under test.
double brute_force(std::span<const double> points, std::size_t m, std::span<const double> reference) {
  const std::size_t k = points.size() / m;
  double sum = 0;
  for (std::size_t subset = 1; subset < (std::size_t{1} << k); ++subset) {
    double box = 1;
    for (std::size_t j = 0; j < m; ++j) {
      double worst = -std::numeric_limits<double>::infinity();
      for (std::size_t i = 0; i < k; ++i)
        if (subset >> i & 1) worst = std::max(worst, points[i * m + j]);
      box *= std::max(0.0, reference[j] - worst);
    }
    sum += __builtin_popcountll(subset) % 2 == 1 ? box : -box;
  }
  return sum;
}

std::vector<double> without(std::span<const double> points, std::size_t m, std::size_t i) {
  std::vector<double> rest(points.begin(), points.end());
  const auto begin = rest.begin() + static_cast<std::ptrdiff_t>(i * m);
  rest.erase(begin, begin + static_cast<std::ptrdiff_t>(m));
  return rest;
}

// Points on a coarse lattice: ties, duplicates, dominated points and points on and beyond the reference are frequent.
rc::Gen<std::vector<double>> lattice(std::size_t m, std::size_t max_points, int levels) {
  return rc::gen::mapcat(rc::gen::inRange<std::size_t>(0, max_points + 1), [=](std::size_t k) {
    return rc::gen::map(rc::gen::container<std::vector<int>>(k * m, rc::gen::inRange(0, levels)),
                        [=](const std::vector<int>& v) {
                          std::vector<double> values;
                          for (const int i : v) values.push_back(i / 8.0);
                          return values;
                        });
  });
}

// Points on the positive part of the unit sphere, all non-dominated.
std::vector<double> sphere(std::size_t k, std::size_t m, std::uint64_t seed) {
  optimise::NormalStream random(seed);
  std::vector<double> values(k * m);
  for (std::size_t i = 0; i < k; ++i) {
    double norm = 0;
    for (std::size_t j = 0; j < m; ++j) {
      values[i * m + j] = std::abs(random.normal());
      norm += values[i * m + j] * values[i * m + j];
    }
    for (std::size_t j = 0; j < m; ++j) values[i * m + j] = 1 - values[i * m + j] / std::sqrt(norm);
  }
  return values;
}

class HypervolumeProperty : public testing::TestWithParam<std::size_t> {};
INSTANTIATE_TEST_SUITE_P(Objectives, HypervolumeProperty, testing::Values(1, 2, 3, 4, 5, 6));

TEST_P(HypervolumeProperty, EqualsInclusionExclusion) {
  const std::size_t m = GetParam();
  const std::vector<double> reference(m, 1.0);
  EXPECT_TRUE(rc::check([&] {
    const auto points = *lattice(m, 8, 11);
    RC_ASSERT(std::abs(hypervolume(points, m, reference) - brute_force(points, m, reference)) < 1e-12);
  }));
}

TEST_P(HypervolumeProperty, ContributionsAreWhatIsLostWithoutEach) {
  const std::size_t m = GetParam();
  const std::vector<double> reference(m, 1.0);
  EXPECT_TRUE(rc::check([&] {
    const auto points = *lattice(m, 12, 11);
    const auto contributions = hypervolume_contributions(points, m, reference);
    const double whole = hypervolume(points, m, reference);
    RC_ASSERT(contributions.size() == points.size() / m);
    for (std::size_t i = 0; i < contributions.size(); ++i)
      RC_ASSERT(std::abs(contributions[i] - (whole - hypervolume(without(points, m, i), m, reference))) < 1e-12);
  }));
}

TEST_P(HypervolumeProperty, ContributionsOfManyNonDominatedPoints) {
  const std::size_t m = GetParam();
  if (m < 2) return;
  const auto points = sphere(m < 4 ? 200 : 25, m, m);
  const std::vector<double> reference(m, 1.0);
  const auto contributions = hypervolume_contributions(points, m, reference);
  const double whole = hypervolume(points, m, reference);
  for (std::size_t i = 0; i < contributions.size(); ++i)
    EXPECT_NEAR(contributions[i], whole - hypervolume(without(points, m, i), m, reference), 1e-12);
}

// The greedy definition, with an exact recount each time.
TEST_P(HypervolumeProperty, TruncationRemovesTheLeastContributorEachTime) {
  const std::size_t m = GetParam();
  const std::vector<double> reference(m, 1.0);
  const auto check = [&](std::vector<double> points, std::size_t count) {
    std::vector<std::size_t> alive(points.size() / m);
    for (std::size_t i = 0; i < alive.size(); ++i) alive[i] = i;
    for (const std::size_t removed : optimise::least_contributors({points, m}, reference, count)) {
      std::vector<double> rest;
      for (const std::size_t i : alive)
        rest.insert(rest.end(), points.begin() + static_cast<std::ptrdiff_t>(i * m),
                    points.begin() + static_cast<std::ptrdiff_t>((i + 1) * m));
      const auto contributions = hypervolume_contributions(rest, m, reference);
      const auto place = std::find(alive.begin(), alive.end(), removed);
      RC_ASSERT(place != alive.end());
      const double least = *std::min_element(contributions.begin(), contributions.end());
      RC_ASSERT(contributions[static_cast<std::size_t>(place - alive.begin())] <= least + 1e-12);
      alive.erase(place);
    }
    RC_ASSERT(alive.size() + count == points.size() / m);
  };
  EXPECT_TRUE(rc::check([&] {
    const auto points = *lattice(m, 14, 9);
    check(points, *rc::gen::inRange<std::size_t>(0, points.size() / m + 1));
  }));
  EXPECT_TRUE(
      rc::check([&] { check(sphere(m < 4 ? 60 : 15, m, *rc::gen::arbitrary<std::uint64_t>()), m < 4 ? 40 : 8); }));
}

TEST_P(HypervolumeProperty, DoesNotDependOnTheOrderOfPoints) {
  const std::size_t m = GetParam();
  const std::vector<double> reference(m, 1.0);
  EXPECT_TRUE(rc::check([&] {
    const auto points = *lattice(m, 12, 9);
    std::vector<double> reversed;
    for (std::size_t i = points.size() / m; i-- > 0;)
      reversed.insert(reversed.end(), points.begin() + static_cast<std::ptrdiff_t>(i * m),
                      points.begin() + static_cast<std::ptrdiff_t>((i + 1) * m));
    RC_ASSERT(std::abs(hypervolume(points, m, reference) - hypervolume(reversed, m, reference)) < 1e-13);
  }));
}

TEST_P(HypervolumeProperty, RanksPeelFrontsOff) {
  const std::size_t m = GetParam();
  EXPECT_TRUE(rc::check([&] {
    const auto points = *lattice(m, 40, 5);
    const PointSet set{points, m};
    const auto ranks = non_dominated_ranks(points, m);
    for (std::size_t i = 0; i < set.size(); ++i) {
      // One more than the highest rank among those that dominate it.
      std::size_t expected = 0;
      for (std::size_t j = 0; j < set.size(); ++j)
        if (optimise::dominates(set[j], set[i])) expected = std::max(expected, ranks[j] + 1);
      RC_ASSERT(ranks[i] == expected);
    }
  }));
}

TEST(Hypervolume, OfKnownSets) {
  const std::vector<double> corner = {0, 0, 0}, one(3, 1.0);
  EXPECT_EQ(hypervolume(corner, 3, one), 1.0);
  EXPECT_EQ(hypervolume({}, 3, one), 0.0);
  const std::vector<double> outside = {1, 0, 0, 2, 2, -1};
  EXPECT_EQ(hypervolume(outside, 3, one), 0.0);
  // k steps of the line f0 + f1 = 1 leave half the square, less half a step's triangles.
  const std::size_t k = 1000;
  std::vector<double> line;
  for (std::size_t i = 0; i <= k; ++i) {
    line.push_back(static_cast<double>(i) / k);
    line.push_back(1 - static_cast<double>(i) / k);
  }
  EXPECT_NEAR(hypervolume(line, 2, std::vector{1.0, 1.0}), 0.5 - 0.5 / k, 1e-12);
}

TEST(Hypervolume, OfTheSphereAgreesWithMonteCarlo) {
  const std::size_t m = 4, k = 60, samples = 200000;
  const auto points = sphere(k, m, 5);
  const std::vector<double> reference(m, 1.0);
  const PointSet set{points, m};
  optimise::NormalStream random(9);
  std::size_t hits = 0;
  std::vector<double> x(m);
  for (std::size_t s = 0; s < samples; ++s) {
    for (double& v : x) v = random.uniform();
    for (std::size_t i = 0; i < k; ++i) {
      if (!optimise::dominates(set[i], x)) continue;
      ++hits;
      break;
    }
  }
  const double share = static_cast<double>(hits) / samples;
  EXPECT_NEAR(hypervolume(points, m, reference), share, 5 * std::sqrt(share * (1 - share) / samples));
}

TEST(Hypervolume, RefusesWhatHasNoMeaning) {
  const std::vector<double> points = {0, 0, 0}, two = {1, 1}, nan = {1, 1, std::nan("")};
  EXPECT_THROW(hypervolume(points, 2, two), Error);
  EXPECT_THROW(hypervolume(points, 3, two), Error);
  EXPECT_THROW(hypervolume(points, 3, nan), Error);
  EXPECT_THROW(hypervolume(points, 0, {}), Error);
  EXPECT_THROW(hypervolume({}, 7, {}), Error);
  const std::vector<double> bottomless = {0, 0, -std::numeric_limits<double>::infinity()};
  EXPECT_THROW(hypervolume(bottomless, 3, std::vector<double>(3, 1.0)), Error);
}

TEST(Ranks, PutNaNLast) {
  const std::vector<double> points = {0, 1, std::nan(""), 0, 5, 5};
  EXPECT_EQ(non_dominated_ranks(points, 2), (std::vector<std::size_t>{0, 2, 1}));
}

}  // namespace
}  // namespace vantage
