// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "core/philox.hpp"
#include "vantage/error.hpp"
#include "vantage/objective.hpp"
#include "vantage/registration.hpp"

namespace vantage {
namespace {

OverlapMatrix complete(std::size_t n, double weight) {
  OverlapMatrix a(n);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 1; j < n; ++j) a.set(i, j, weight);
  }
  return a;
}

// Equation 13, literally.
double clustering_by_definition(const OverlapMatrix& a) {
  const std::size_t n = a.size();
  double largest = 0, sum = 0;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) largest = std::max(largest, a(i, j));
  }
  for (std::size_t i = 0; i < n; ++i) {
    double triangles = 0, pairs = 0;
    for (std::size_t j = 0; j < n; ++j) {
      for (std::size_t k = 0; k < n; ++k) {
        triangles += a(i, j) * a(i, k) * a(j, k);
        if (j != k) pairs += a(i, j) * a(i, k);
      }
    }
    if (pairs > 0 && largest > 0) sum += triangles / pairs / largest;
  }
  return n == 0 ? 0 : sum / static_cast<double>(n);
}

TEST(Coverage, IsEquation8) {
  NetworkCounts counts;
  EXPECT_EQ(coverage(counts, 2.5), 0.0);  // no surveyed voxel at all
  counts.voxels = counts.weight = 10;
  counts.saturated = 4;
  counts.partial_points = 5;
  EXPECT_DOUBLE_EQ(coverage(counts, 2.5), (4 + 5 / 2.5) / 10);
  counts.saturated = 10;
  counts.partial_points = 0;
  EXPECT_EQ(coverage(counts, 2.5), 1.0);
}

// Counts of a cancelled evaluation would look like a measure that is too low.
TEST(Measures, AreRefusedOfCancelledCounts) {
  NetworkCounts counts;
  counts.voxels = counts.weight = 10, counts.saturated = 4, counts.stations = 2;
  counts.seen = {3, 4}, counts.shared = {2};
  const NetworkCounts whole = counts;
  counts.cancelled = true;
  const auto refused = [](const auto& make) {
    try {
      make();
      return false;
    } catch (const Error& error) {
      return error.code() == Errc::invalid_argument && std::string(error.what()).find("cancelled") != std::string::npos;
    }
  };
  EXPECT_TRUE(refused([&] { coverage(counts, 1); }));
  EXPECT_TRUE(refused([&] { overlap_matrix(counts); }));
  EXPECT_TRUE(refused([&] { scan_overlap_matrix(counts); }));
  EXPECT_TRUE(refused([&] { coverage_estimate(counts, 1, 10); }));
  EXPECT_TRUE(refused([&] { overlap_estimate(counts, 10); }));
  EXPECT_TRUE(refused([&] { overlap_standard_errors(counts, 10); }));
  EXPECT_TRUE(refused([&] { registration_error(counts, 10); }));
  EXPECT_TRUE(refused([&] { registration_estimate(counts, 10); }));
  const Objective objective = make_objective("coverage");
  const std::vector<PlacedStation> stations(2);
  EXPECT_TRUE(refused([&] { estimate(objective, {.counts = counts, .stations = stations}); }));
  EXPECT_TRUE(refused([&] { estimate(objective, {.counts = whole, .stations = stations, .surroundings = &counts}); }));
  EXPECT_FALSE(refused([&] { estimate(objective, {.counts = whole, .stations = stations}); }));
}

TEST(Coverage, IsTheWeightedMean) {
  NetworkCounts counts;  // three voxels of weight 1 and one of weight 5: full, half, none; full
  counts.voxels = 4;
  counts.weight = 8;
  counts.saturated = 1 + 5;
  counts.partial_points = 2;
  EXPECT_DOUBLE_EQ(coverage(counts, 4), (1 + 0.5 + 5) / 8);
}

TEST(Coverage, IsExactForCountsBeyond32Bits) {
  NetworkCounts counts;
  counts.voxels = counts.weight = 1ull << 40;
  counts.saturated = 1ull << 39;
  counts.partial_points = 1ull << 41;
  EXPECT_EQ(coverage(counts, 8), 0.75);
}

TEST(SharedBy, FindsEveryPair) {
  for (const std::uint32_t n : {2u, 3u, 15u, 64u}) {
    NetworkCounts counts;
    counts.stations = n;
    for (std::uint64_t k = 0; k < n * (n - 1) / 2; ++k) counts.shared.push_back(k);
    std::uint64_t expected = 0;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = i + 1; j < n; ++j, ++expected) {
        EXPECT_EQ(counts.shared_by(i, j), expected);
        EXPECT_EQ(counts.shared_by(j, i), expected);
      }
    }
  }
}

// Random station masks, counted through NetworkCounts and by equations 10 and 11.
TEST(OverlapMatrix, MatchesVoxelMasks) {
  for (const std::uint32_t n : {1u, 2u, 5u, 64u}) {
    RandomStream random(n);
    std::vector<std::uint64_t> masks(300);
    for (auto& mask : masks) {
      for (std::uint32_t s = 0; s < n; ++s) mask |= std::uint64_t{random.uniform() < 0.2} << s;
    }
    NetworkCounts counts;
    counts.voxels = masks.size();
    counts.stations = n;
    counts.seen.assign(n, 0);
    for (std::uint32_t i = 0; i < n; ++i) {
      for (const auto mask : masks) counts.seen[i] += mask >> i & 1;
      for (std::uint32_t j = i + 1; j < n; ++j) {
        counts.shared.push_back(0);
        for (const auto mask : masks) counts.shared.back() += (mask >> i & 1) & (mask >> j & 1);
      }
    }
    const OverlapMatrix overlap = overlap_matrix(counts);
    ASSERT_EQ(overlap.size(), n);
    for (std::uint32_t i = 0; i < n; ++i) {
      EXPECT_EQ(overlap(i, i), 0.0);
      for (std::uint32_t j = 0; j < n; ++j) {
        if (i == j) continue;
        double both = 0, either = 0;
        for (const auto mask : masks) {
          both += static_cast<double>((mask >> i & 1) & (mask >> j & 1));
          either += static_cast<double>((mask >> i & 1) | (mask >> j & 1));
        }
        EXPECT_EQ(overlap(i, j), both / either);
      }
    }
  }
}

TEST(OverlapMatrix, IsZeroWhereNothingWasSeenOrMasksWereOff) {
  NetworkCounts counts;
  counts.stations = 3;
  EXPECT_EQ(overlap_matrix(counts).size(), 3u);
  EXPECT_EQ(overlap_matrix(counts)(0, 2), 0.0);
  counts.seen = {0, 0, 5};
  counts.shared = {0, 0, 0};
  const OverlapMatrix overlap = overlap_matrix(counts);
  EXPECT_EQ(overlap(0, 1), 0.0);  // 0/0
  EXPECT_EQ(overlap(1, 2), 0.0);
  EXPECT_EQ(clustering_coefficient(overlap), 0.0);
}

TEST(Clustering, KnownGraphs) {
  EXPECT_EQ(clustering_coefficient(OverlapMatrix{}), 0.0);
  EXPECT_EQ(clustering_coefficient(complete(1, 0)), 0.0);
  EXPECT_EQ(clustering_coefficient(complete(2, 0.7)), 0.0);
  // A complete graph of equal weights is fully clustered, whatever the weight, down to denormals.
  for (const double weight : {1.0, 0.25, 1e-12, 1e-300}) {
    EXPECT_DOUBLE_EQ(clustering_coefficient(complete(3, weight)), 1.0) << weight;
    EXPECT_DOUBLE_EQ(clustering_coefficient(complete(64, weight)), 1.0) << weight;
  }
  // Stars and paths have no triangles.
  OverlapMatrix star(5);
  for (std::size_t j = 1; j < 5; ++j) star.set(0, j, 0.5);
  EXPECT_EQ(clustering_coefficient(star), 0.0);
}

TEST(Clustering, TriangleOfThreeWeights) {
  // Node 0 has links 1 and ½, the opposite link is ¼: C_0 = ¼, C_1 = ½, C_2 = 1 (maximum weight 1).
  OverlapMatrix a(3);
  a.set(0, 1, 1.0);
  a.set(0, 2, 0.5);
  a.set(1, 2, 0.25);
  EXPECT_DOUBLE_EQ(clustering_coefficient(a), (0.25 + 0.5 + 1.0) / 3);
  // The maximum is over all pairs: a stronger link elsewhere lowers every station's share, and its own two ends add
  // nothing.
  OverlapMatrix b(5);
  b.set(0, 1, 0.5);
  b.set(0, 2, 0.25);
  b.set(1, 2, 0.125);
  b.set(3, 4, 1.0);
  EXPECT_DOUBLE_EQ(clustering_coefficient(b), (0.125 + 0.25 + 0.5) / 5);
}

TEST(Clustering, UnweightedGraphIsEquation12) {
  // A triangle 0-1-2 with a tail 2-3: C = (1 + 1 + 1/3 + 0) / 4.
  OverlapMatrix a(4);
  for (const auto& [i, j] : {std::pair{0, 1}, {0, 2}, {1, 2}, {2, 3}}) a.set(i, j, 1.0);
  EXPECT_DOUBLE_EQ(clustering_coefficient(a), (1 + 1 + 1.0 / 3) / 4);
}

TEST(Clustering, SkippedStationsStillCount) {
  // Three stations of equal overlap among six.
  OverlapMatrix a(6);
  for (const auto& [i, j] : {std::pair{0, 1}, {0, 2}, {1, 2}}) a.set(i, j, 0.3);
  EXPECT_DOUBLE_EQ(clustering_coefficient(a), 0.5);
}

TEST(Clustering, MatchesItsDefinitionOnRandomGraphs) {
  RandomStream random(11);
  for (int round = 0; round < 200; ++round) {
    const std::size_t n = 1 + random.bits() % 64;
    const double density = random.uniform();
    OverlapMatrix a(n);
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = i + 1; j < n; ++j) a.set(i, j, random.uniform() < density ? random.uniform() : 0.0);
    }
    const double c = clustering_coefficient(a);
    EXPECT_NEAR(c, clustering_by_definition(a), 1e-13) << "round " << round;
    EXPECT_GE(c, 0.0);
    EXPECT_LE(c, 1.0);
  }
}

TEST(StationCount, IsEquation7) {
  EXPECT_EQ(station_count_from_alpha(0, 4, 12), 4u);
  EXPECT_EQ(station_count_from_alpha(1, 4, 12), 12u);
  EXPECT_EQ(station_count_from_alpha(0.5, 4, 12), 8u);
  EXPECT_EQ(station_count_from_alpha(1.0 / 16, 4, 12), 5u);  // 4.5 is rounded up
  EXPECT_EQ(station_count_from_alpha(std::nextafter(1.0 / 16, 0.0), 4, 12), 4u);
  EXPECT_EQ(station_count_from_alpha(std::nextafter(0.5, 0.0), 4, 5), 4u);  // adding ½ first would round this up
  EXPECT_EQ(station_count_from_alpha(-3, 4, 12), 4u);
  EXPECT_EQ(station_count_from_alpha(7, 4, 12), 12u);
  EXPECT_EQ(station_count_from_alpha(std::numeric_limits<double>::quiet_NaN(), 4, 12), 4u);
  EXPECT_EQ(station_count_from_alpha(0.7, 6, 6), 6u);
}

}  // namespace
}  // namespace vantage
