// SPDX-License-Identifier: Apache-2.0
#include "trace/embree/range_noise.hpp"

#include <gtest/gtest.h>

#include "support/trace_scenes.hpp"

namespace vantage {
namespace {

Scanner noisy() {
  Scanner scanner;
  scanner.noise = rtc360_noise();
  return scanner;
}

TEST(RangeNoise, SigmaIsTheModels) {
  const auto model = std::make_shared<const NoiseModel>(make_noise_model(noisy(), 3));
  const RangeNoise noise(model);
  RandomStream random(8);
  for (int k = 0; k < 5000; ++k) {
    const float t = test::between(random, -1, 140), r = test::between(random, -0.1, 1.1);
    EXPECT_NEAR(noise.sigma(t, r), model_sigma(*model, t, r), 1e-8);
  }
  EXPECT_FALSE(RangeNoise(std::make_shared<const NoiseModel>()).enabled());
  EXPECT_FALSE(RangeNoise(nullptr).enabled());
}

TEST(RangeNoise, NoPointIsMovedBeyondTheReach) {
  const RangeNoise noise(std::make_shared<const NoiseModel>(make_noise_model(noisy(), 3)));
  RandomStream random(9);
  for (std::uint64_t ray = 0; ray < 50'000; ++ray) {
    const float t = test::between(random, 0.1, 130), r = test::between(random, 0, 1);
    const float moved = std::abs(noise.displaced(t, r, ray, 2) - t) - 1e-5f;  // less the rounding of the sum
    ASSERT_LE(moved, noise.reach());
    ASSERT_LE(moved, noise.reach_within(t));
  }
  EXPECT_LT(noise.reach_within(10), noise.reach());
  EXPECT_LE(noise.reach_within(1e9f), noise.reach() * 1.00001f);
}

}  // namespace
}  // namespace vantage
