// SPDX-License-Identifier: Apache-2.0
#include "scan/noise_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>

#include "support/temporary_folder.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

Scanner rtc360() {
  Scanner scanner;
  scanner.noise = rtc360_noise();
  return scanner;
}

TEST(TableSigma, IsTheTableAtItsNodes) {
  const NoiseTable t = rtc360_noise();
  for (std::size_t r = 0; r < t.reflectivities.size(); ++r) {
    for (std::size_t d = 0; d < t.distances_m.size(); ++d)
      EXPECT_NEAR(table_sigma(t, t.distances_m[d], t.reflectivities[r]), t.sigma_m[r * t.distances_m.size() + d],
                  1e-18);
  }
}

TEST(TableSigma, IsLinearBetweenNodes) {
  const NoiseTable t = rtc360_noise();
  EXPECT_NEAR(table_sigma(t, 7.5, 0.08), 0.55e-3, 1e-12);
  EXPECT_NEAR(table_sigma(t, 30, 0.21), 0.7e-3, 1e-12);
  // Half way between black and grey at 50 m: (3.75 + 1.4) / 2 mm.
  EXPECT_NEAR(table_sigma(t, 50, 0.145), 2.575e-3, 1e-12);
}

TEST(TableSigma, GoesOnLinearlyBeyondTheNodes) {
  const NoiseTable t = rtc360_noise();
  EXPECT_NEAR(table_sigma(t, 0, 0.89), 0.2e-3, 1e-12);      // 0.1 mm less for 5 m
  EXPECT_NEAR(table_sigma(t, 130, 0.08), 13.75e-3, 1e-12);  // 5 mm, and 70 m at 0.125 mm per metre
  EXPECT_NEAR(table_sigma(t, 60, 1.0), (1 - 1.0 * 11 / 68) * 1e-3, 1e-12);
}

// σ² R is the same at all reflectivities below the lowest of the table, as deep as the regular table has a step.
TEST(TableSigma, GrowsAsTheEchoFadesBelowTheLowestReflectivity) {
  const NoiseTable t = rtc360_noise();
  for (const double distance : {5.0, 17.0, 60.0, 130.0}) {
    const double lowest = table_sigma(t, distance, 0.08);
    for (const double reflectivity : {0.079, 0.04, 0.02, 0.01}) {
      const double sigma = table_sigma(t, distance, reflectivity);
      EXPECT_NEAR(sigma * sigma * reflectivity, lowest * lowest * 0.08, 1e-12) << distance << " m, " << reflectivity;
    }
    EXPECT_EQ(table_sigma(t, distance, 0), table_sigma(t, distance, 0.01)) << "finite where nothing comes back";
  }
  EXPECT_NEAR(table_sigma(t, 60, 0.02), 10e-3, 1e-12) << "a quarter of the light, twice the 5 mm at 8 %";
  const NoiseTable to_black{.distances_m = {10}, .reflectivities = {0, 0.5}, .sigma_m = {3e-3, 1e-3}};
  EXPECT_NEAR(table_sigma(to_black, 10, 0.125), 2.5e-3, 1e-15) << "the table itself reaches black";
  EXPECT_EQ(table_sigma(to_black, 10, 0), 3e-3);
}

TEST(TableSigma, IsNeverBelowZero) {
  const NoiseTable t{.distances_m = {10, 20}, .reflectivities = {0.2, 0.8}, .sigma_m = {1e-3, 3e-3, 0.5e-3, 1e-3}};
  EXPECT_EQ(table_sigma(t, 0, 0.2), 0.0);
  EXPECT_GT(table_sigma(t, 6, 0.2), 0.0);
}

TEST(TableSigma, OneRowOrColumnIsConstantAlongIt) {
  const NoiseTable point{.distances_m = {30}, .reflectivities = {0.5}, .sigma_m = {2.5e-3}};
  for (const double distance : {0.0, 30.0, 500.0}) {
    for (const double reflectivity : {0.0, 0.5, 1.0}) EXPECT_EQ(table_sigma(point, distance, reflectivity), 2.5e-3);
  }
  const NoiseTable row{.distances_m = {10, 20}, .reflectivities = {0.9}, .sigma_m = {1e-3, 2e-3}};
  EXPECT_NEAR(table_sigma(row, 15, 0.1), 1.5e-3, 1e-15);
  EXPECT_EQ(table_sigma({}, 10, 0.5), 0.0);
}

TEST(NoiseModel, IsTheTableAtEveryStep) {
  const Scanner scanner = rtc360();
  const NoiseModel model = make_noise_model(scanner, 7);
  ASSERT_TRUE(model.enabled());
  ASSERT_EQ(model.sigma.size(), 101u * 101u);
  EXPECT_EQ(model.seed, 7u);
  EXPECT_EQ(model.min_range, 0.1f);
  EXPECT_FLOAT_EQ(model.inverse_span, 1 / 129.9f);
  for (int r = 0; r <= 100; ++r) {
    for (int d = 0; d <= 100; ++d) {
      const double expected = table_sigma(scanner.noise, 0.1 + d / 100.0 * 129.9, r / 100.0);
      EXPECT_NEAR(model.sigma[static_cast<std::size_t>(r * 101 + d)], expected,
                  6e-8 * expected + 1e-11);  // a float
      EXPECT_NEAR(model_sigma(model, 0.1 + d / 100.0 * 129.9, r / 100.0), expected, 1e-8);
    }
  }
}

TEST(NoiseModel, LookUpIsBilinearAndClamped) {
  const Scanner scanner = rtc360();
  const NoiseModel model = make_noise_model(scanner, 1);
  // The table's own bends lie between steps, so a step's width bounds the difference. Below the lowest reflectivity a
  // step's chord lies above the curve, by less than 5 % from 0.01 on: (1 + √½) / 2 · √1.5 at 0.015.
  for (double distance = 1; distance < 130; distance += 0.37) {
    for (double reflectivity = 0; reflectivity <= 1; reflectivity += 0.013) {
      const double exact = table_sigma(scanner.noise, distance, reflectivity);
      EXPECT_NEAR(model_sigma(model, distance, reflectivity), exact, (reflectivity < 0.08 ? 0.05 : 0.02) * exact + 5e-5)
          << distance << " m, " << reflectivity;
    }
  }
  EXPECT_EQ(model_sigma(model, 500, 0.5), model_sigma(model, 130, 0.5));
  EXPECT_EQ(model_sigma(model, 0, 0.5), model_sigma(model, 0.1, 0.5));
  EXPECT_EQ(model_sigma(model, 20, 1.5), model_sigma(model, 20, 1));
}

TEST(NoiseModel, ReachBoundsEveryDisplacement) {
  const NoiseModel model = make_noise_model(rtc360(), 1);
  const float largest = *std::max_element(model.sigma.begin(), model.sigma.end());
  EXPECT_GE(model.reach, 5 * largest);
  EXPECT_LE(model.reach, 5 * largest * 1.000001f);
}

// Points that are detected have the σ of the table; others have none, so their σ does not matter, and is not larger.
TEST(NoiseModel, KnowsNoDarkerSurfaceThanIsDetected) {
  Scanner scanner = rtc360(), every = rtc360();
  scanner.detection_range_m = 60, scanner.detection_reflectivity = 0.08;
  const NoiseModel model = make_noise_model(scanner, 1), all = make_noise_model(every, 1);
  for (double distance = 0.2; distance < 130; distance += 0.31)
    for (double reflectivity = 0.001; reflectivity <= 1; reflectivity += 0.0037) {
      const double sigma = model_sigma(model, distance, reflectivity),
                   expected = model_sigma(all, distance, reflectivity);
      if (distance <= 60 * std::sqrt(reflectivity / 0.08)) {
        EXPECT_EQ(sigma, expected) << distance << " m, " << reflectivity;
      } else {
        EXPECT_LE(sigma, expected) << distance << " m, " << reflectivity;
      }
    }
  EXPECT_LT(model.reach, all.reach / 4);
  // σ is that of the last step before white where nothing is detected.
  scanner.detection_range_m = 10, scanner.detection_reflectivity = 0.9;
  EXPECT_NEAR(model_sigma(make_noise_model(scanner, 1), 100, 0.3), model_sigma(all, 100, 0.99), 1e-9);
}

TEST(NoiseModel, IsOffWithoutATableOrWithZeros) {
  EXPECT_FALSE(make_noise_model(Scanner{}, 1).enabled());
  EXPECT_EQ(make_noise_model(Scanner{}, 1).reach, 0.0f);
  Scanner zeros;
  zeros.noise = {.distances_m = {10}, .reflectivities = {0.5}, .sigma_m = {0.0}};
  EXPECT_FALSE(make_noise_model(zeros, 1).enabled());
  EXPECT_EQ(model_sigma(make_noise_model(zeros, 1), 10, 0.5), 0.0);
}

// A surface of 0.5 at 60° is one of 0.25: both tables say the same.
TEST(LoadNoise, ByAngleIsByTheReflectivityThatIsLeft) {
  const test::TemporaryFolder folder;
  const auto load = [&](const std::string& text) {
    std::ofstream(folder / "noise.csv") << text;
    return load_noise((folder / "noise.csv").string());
  };
  const NoiseTable by_angle = load("incidence_deg@0.5,5,20\n0,0.0004,0.001\n60,0.0006,0.0016\n"),
                   by_reflectivity = load("reflectivity,5,20\n0.25,0.0006,0.0016\n0.5,0.0004,0.001\n");
  ASSERT_EQ(by_angle.reflectivities.size(), 2u);
  for (std::size_t k = 0; k < 2; ++k) EXPECT_NEAR(by_angle.reflectivities[k], by_reflectivity.reflectivities[k], 1e-15);
  EXPECT_EQ(by_angle.sigma_m, by_reflectivity.sigma_m);
  EXPECT_EQ(by_angle.distances_m, by_reflectivity.distances_m);
  for (const char* const bad :
       {"incidence_deg,5\n0,0.001\n", "incidence_deg@0,5\n0,0.001\n", "incidence_deg@0.5,5\n90,0.001\n",
        "incidence_deg@0.5,5\n-1,0.001\n", "incidence_deg@0.5,5\n60,0.001\n0,0.002\n"})
    EXPECT_THROW(load(bad), Error) << bad;
}

}  // namespace
}  // namespace vantage
