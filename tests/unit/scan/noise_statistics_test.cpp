// SPDX-License-Identifier: Apache-2.0
// Distribution of the noise of section 3.3: a million rays at each of twelve (distance, reflectivity) points.
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "core/normal_table.hpp"
#include "core/philox.hpp"
#include "scan/noise_model.hpp"
#include "shared/noise_types.h"
#include "trace/embree/range_noise.hpp"
#include "vantage/simulator.hpp"

namespace vantage {
namespace {

constexpr std::uint32_t rays = 1'000'000, columns = 1000;

std::vector<float> draws(std::uint64_t seed, std::uint32_t place, std::uint64_t first_ray = 0) {
  std::vector<float> z(rays);
  const auto table = normal_table();
  tbb::parallel_for(std::uint32_t{0}, rays, [&](std::uint32_t k) {
    const std::uint64_t ray = first_ray + k;
    const auto bits =
        philox4x32(seed, {static_cast<std::uint32_t>(ray), static_cast<std::uint32_t>(ray >> 32), place, noise_stream});
    z[k] = normal_from_bits(bits[0], table);
  });
  return z;
}

double truncated_normal_cdf(double z) {
  const auto phi = [](double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); };
  return (phi(std::clamp(z, -5.0, 5.0)) - phi(-5)) / (phi(5) - phi(-5));
}

double correlation(const std::vector<float>& a, const std::vector<float>& b, std::size_t count, std::size_t shift) {
  double sum = 0;
  for (std::size_t k = 0; k < count; ++k) sum += static_cast<double>(a[k]) * static_cast<double>(b[k + shift]);
  return sum / static_cast<double>(count);
}

TEST(NoiseStatistics, TwelvePointsOfTheTable) {
  Scanner scanner;
  scanner.noise = rtc360_noise();
  const NoiseModel model = make_noise_model(scanner, SimulatorConfig{}.seed);
  const RangeNoise noise(std::make_shared<const NoiseModel>(model));
  std::uint32_t place = 0;
  for (const double distance : {3.0, 12.0, 45.0, 110.0}) {
    for (const double reflectivity : {0.05, 0.24, 0.8}) {
      const double sigma = model_sigma(model, distance, reflectivity);
      ASSERT_GT(sigma, 0.0);
      EXPECT_NEAR(noise.sigma(static_cast<float>(distance), static_cast<float>(reflectivity)), sigma,
                  1e-6 * sigma + 1e-9);
      std::vector<float> z = draws(model.seed, place);
      double mean = 0, squares = 0, farthest = 0, largest_difference = 0;
      for (std::uint32_t k = 0; k < rays; ++k) {
        const float range = static_cast<float>(distance);
        const double moved = static_cast<double>(noise.displaced(range, static_cast<float>(reflectivity), k, place)) -
                             static_cast<double>(range);
        largest_difference = std::max(largest_difference, std::abs(moved - sigma * static_cast<double>(z[k])));
        farthest = std::max(farthest, std::abs(moved));
        mean += moved / rays;
        squares += moved * moved / rays;
      }
      EXPECT_LT(largest_difference, 1e-5);  // last place of the range
      EXPECT_LE(farthest, static_cast<double>(model.reach) + 1e-5);
      const double sample_sigma = std::sqrt(squares - mean * mean);
      EXPECT_NEAR(sample_sigma / sigma, 1.0, 0.01) << distance << " m, " << reflectivity;
      EXPECT_NEAR(sample_sigma / table_sigma(scanner.noise, distance, reflectivity), 1.0, 0.03)
          << distance << " m, " << reflectivity;
      EXPECT_LT(std::abs(mean), 3 * sigma / std::sqrt(rays)) << distance << " m, " << reflectivity;

      // Kolmogorov–Smirnov at significance 1e-4: √n·D < √(−½ ln(½·1e-4)).
      ++place;
      std::sort(z.begin(), z.end());
      double largest = 0;
      for (std::uint32_t k = 0; k < rays; k += 10) {  // every tenth step of the sample: D to 1e-5
        const double expected = truncated_normal_cdf(static_cast<double>(z[k]));
        largest = std::max({largest, (k + 1.0) / rays - expected, expected - static_cast<double>(k) / rays});
      }
      EXPECT_LT(std::sqrt(rays) * largest, std::sqrt(-0.5 * std::log(0.5e-4))) << distance << " m, " << reflectivity;
    }
  }
}

// For any seed: the squared means of 200 samples, in standard errors, add up to χ² of 200 degrees of freedom, whose
// 5·10⁻⁵ quantiles are 131 and 288.
TEST(NoiseStatistics, MeansScatterAsChanceDoes) {
  constexpr std::uint32_t samples = 200, size = 100'000;
  const auto table = normal_table();
  std::vector<double> squares(samples);
  tbb::parallel_for(std::uint32_t{0}, samples, [&](std::uint32_t seed) {
    double sum = 0;
    for (std::uint32_t k = 0; k < size; ++k)
      sum += static_cast<double>(normal_from_bits(philox4x32(seed, {k, 0, 0, noise_stream})[0], table));
    squares[seed] = sum * sum / size;
  });
  double total = 0;
  for (const double square : squares) total += square;
  EXPECT_GT(total, 131);
  EXPECT_LT(total, 288);
}

TEST(NoiseStatistics, NeighboursAreUncorrelated) {
  const std::vector<float> z = draws(1, 0);
  EXPECT_LT(std::abs(correlation(z, z, rays - 1, 1)), 0.005);                                // along rows
  EXPECT_LT(std::abs(correlation(z, z, rays - columns, columns)), 0.005);                    // along columns
  EXPECT_LT(std::abs(correlation(z, draws(1, 1), rays, 0)), 0.005);                          // the next station
  EXPECT_LT(std::abs(correlation(z, draws(2, 0), rays, 0)), 0.005);                          // the next seed
  EXPECT_LT(std::abs(correlation(z, draws(1, 0, std::uint64_t{1} << 32), rays, 0)), 0.005);  // the high word of the ray
}

}  // namespace
}  // namespace vantage
