// SPDX-License-Identifier: Apache-2.0
#include "trace/embree/range_noise.hpp"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <limits>
#include <vector>

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

TEST(RangeNoise, EightAtOnceAreMovedAsOneByOne) {
  const RangeNoise noise(std::make_shared<const NoiseModel>(make_noise_model(noisy(), 3)));
  std::vector<std::uint32_t> odd{0, 1, 2, 3, 0x7FFFFFFF, 0x7FFFFFFE, 0x40000000, 0x3FFFFFFF};
  for (std::uint32_t bit = 2; bit < 31; ++bit) odd.push_back((1u << bit) + 1), odd.push_back((1u << bit) - 1);
  RandomStream random(11);
  constexpr float infinity = std::numeric_limits<float>::infinity();
  const std::array<float, 6> odd_t{0, 1e-3f, 0.6f, 130, 1e9f, infinity};
  std::uint64_t moved = 0;
  for (std::uint32_t run = 0; run < 20'000; ++run) {
    alignas(32) std::array<float, 8> t, reflectivity, range;
    alignas(32) std::array<std::uint32_t, 8> bits;
    for (std::size_t k = 0; k < 8; ++k) {
      t[k] = random.bits() % 16 == 0 ? odd_t[random.bits() % odd_t.size()] : test::between(random, 0, 140);
      reflectivity[k] =
          random.bits() % 16 == 0 ? static_cast<float>(random.bits() % 3) - 0.5f : test::between(random, 0, 1);
      bits[k] =
          random.bits() % 4 == 0 ? odd[random.bits() % odd.size()] ^ (random.bits() & 0x80000000u) : random.bits();
    }
    Floats8 sigmas;
    noise.find_sigmas(t.data(), reflectivity.data(), sigmas);
    noise.displace_eight(t.data(), sigmas, bits.data(), range.data());
    for (std::size_t k = 0; k < 8; ++k) {
      ASSERT_EQ(std::bit_cast<std::uint32_t>(range[k]),
                std::bit_cast<std::uint32_t>(noise.displaced(t[k], reflectivity[k], bits[k])))
          << "t " << t[k] << ", reflectivity " << reflectivity[k] << ", bits " << bits[k];
      moved += range[k] != t[k];
    }
  }
  EXPECT_GT(moved, 100'000u);
}

TEST(RangeNoise, NoPointIsMovedBeyondTheReach) {
  const RangeNoise noise(std::make_shared<const NoiseModel>(make_noise_model(noisy(), 3)));
  RandomStream random(9);
  for (std::uint64_t ray = 0; ray < 50'000; ++ray) {
    const float t = test::between(random, 0.1, 130), r = test::between(random, 0, 1);
    const float moved = std::abs(noise.displaced(t, r, ray, 2) - t) - 1e-5f;  // less the rounding of the sum
    ASSERT_LE(moved, noise.reach());
    ASSERT_LE(moved, noise.reach_within(t));
    ASSERT_LE(moved, noise.reach_within(t, r));
  }
  EXPECT_LT(noise.reach_within(10, 0.9f), 0.8f * noise.reach_within(10, 0.05f));
  EXPECT_LT(noise.reach_within(10), noise.reach());
  EXPECT_LE(noise.reach_within(1e9f), noise.reach() * 1.00001f);
}

}  // namespace
}  // namespace vantage
