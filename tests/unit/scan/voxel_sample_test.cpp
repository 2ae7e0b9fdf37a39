// SPDX-License-Identifier: Apache-2.0
#include "scan/voxel_sample.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

namespace vantage {
namespace {

TEST(VoxelSample, AllWhereAsManyAsThereAre) {
  for (const std::uint64_t n : {0u, 1u, 2u, 17u}) {
    for (const std::uint64_t more : {0u, 5u}) {
      const auto voxel_indices = voxel_sample(n, n + more, 3);
      ASSERT_EQ(voxel_indices.size(), n);
      for (std::uint32_t k = 0; k < n; ++k) EXPECT_EQ(voxel_indices[k], k);
    }
  }
}

TEST(VoxelSample, DistinctAscendingAndNestedAtEverySize) {
  for (const std::uint64_t population :
       {2u, 3u, 10u, 97u, 128u, 360u, 1597u}) {  // Fibonacci, powers of two, many divisors
    std::vector<std::uint32_t> before;
    for (std::uint64_t size = 0; size <= population; ++size) {
      const auto voxel_indices = voxel_sample(population, size, 9);
      ASSERT_EQ(voxel_indices.size(), size);
      ASSERT_TRUE(std::is_sorted(voxel_indices.begin(), voxel_indices.end()));
      ASSERT_EQ(std::set(voxel_indices.begin(), voxel_indices.end()).size(), size);
      ASSERT_TRUE(voxel_indices.empty() || voxel_indices.back() < population);
      ASSERT_TRUE(std::includes(voxel_indices.begin(), voxel_indices.end(), before.begin(), before.end()));
      before = voxel_indices;
    }
  }
}

// A walk by the golden section leaves gaps of at most three lengths.
TEST(VoxelSample, IsEvenAlongTheOrder) {
  for (const std::uint64_t population : {250'000ull, 1'000'003ull, 39'000'000ull, 4'294'967'290ull}) {
    for (std::uint64_t size = 100; size <= 200'000; size = size * 7 / 4) {
      const auto voxel_indices = voxel_sample(population, size, 1);
      const double mean = static_cast<double>(population) / static_cast<double>(size);
      std::uint64_t longest = population - voxel_indices.back() + voxel_indices.front(), shortest = longest;
      for (std::size_t k = 1; k < voxel_indices.size(); ++k) {
        longest = std::max<std::uint64_t>(longest, voxel_indices[k] - voxel_indices[k - 1]);
        shortest = std::min<std::uint64_t>(shortest, voxel_indices[k] - voxel_indices[k - 1]);
      }
      EXPECT_LE(static_cast<double>(longest), 2.5 * mean) << population << ", " << size;
      EXPECT_GE(static_cast<double>(shortest), 0.15 * mean) << population << ", " << size;
    }
  }
}

TEST(VoxelSample, SeedsDiffer) {
  EXPECT_EQ(voxel_sample(100'000, 100, 1), voxel_sample(100'000, 100, 1));
  EXPECT_NE(voxel_sample(100'000, 100, 1), voxel_sample(100'000, 100, 2));
}

// The error of a smooth field's share is far below that of a simple random sample (1/√size).
TEST(VoxelSample, EstimatesSmoothFieldsWell) {
  constexpr std::uint64_t population = 1'000'000;
  double squares = 0;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const auto voxel_indices = voxel_sample(population, 2000, seed);
    double sum = 0;
    for (const auto voxel_index : voxel_indices) sum += std::sin(voxel_index * 2e-5);
    const double truth = (1 - std::cos(population * 2e-5)) / (population * 2e-5);
    squares += std::pow(sum / 2000 - truth, 2) / 50;
  }
  EXPECT_LT(std::sqrt(squares), 0.1 * 0.7 / std::sqrt(2000.0));
}

// Windows of one walk: the first few of each are part of it, and together they are all indices.
TEST(VoxelSample, WindowsHaveNothingInCommon) {
  constexpr std::uint64_t population = 10'007, size = 1000, seed = 4;
  std::vector<std::uint32_t> all;
  for (std::uint64_t from = 0; from < population; from += size) {
    const auto window = voxel_sample(population, std::min(size, population - from), seed, from);
    all.insert(all.end(), window.begin(), window.end());
    const auto first = voxel_sample(population, 100, seed, from);
    if (window.size() >= first.size()) {
      EXPECT_TRUE(std::ranges::includes(window, first)) << from;
    }
    EXPECT_TRUE(std::ranges::is_sorted(window));
  }
  std::ranges::sort(all);
  std::vector<std::uint32_t> every(population);
  std::iota(every.begin(), every.end(), 0u);
  EXPECT_EQ(all, every);
  // After all of them it repeats.
  EXPECT_EQ(voxel_sample(population, size, seed, population), voxel_sample(population, size, seed));
}

}  // namespace
}  // namespace vantage
