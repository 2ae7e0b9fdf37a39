// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "rooms.hpp"

namespace vantage::test {
namespace {

double apart(const Vec3& a, const Vec3& b) { return std::sqrt(dot(a - b, a - b)); }

double worst_offset(const TakenScan& a, const TakenScan& b) {
  double worst = 0;
  for (std::size_t k = 0; k < a.thinned.size(); ++k)
    for (std::size_t c = 0; c < 3; ++c)
      worst = std::max(worst, std::abs(static_cast<double>(a.thinned[k].offset[c] - b.thinned[k].offset[c])));
  return worst;
}

const glm::dvec3 kHalfDegree = normalize(glm::dvec3{1, -2, 3}) * Angle::degrees(0.5).in_radians();
const Vec3 kFiveCentimetres{0.03, -0.036, 0.018};

TEST(FitScan, RecoversARoughPose) {
  Site site = site_of(Rooms{});
  const TakenScan truth = scan_at(site, kInFirst);
  std::vector<TakenScan> scans{moved(truth, kHalfDegree, kFiveCentimetres)};
  ASSERT_GT(worst_offset(scans[0], truth), 0.01);
  ASSERT_TRUE(fit_to_model(site, scans));
  const ScanFit& fit = scans[0].fit;
  EXPECT_TRUE(fit.fitted) << fit.why;
  EXPECT_LT(apart(scans[0].head, truth.head), 1e-4);
  EXPECT_LT(worst_offset(scans[0], truth), 1e-4);
  EXPECT_NEAR(fit.shift_m, apart(kFiveCentimetres, {}), 1e-4);
  EXPECT_NEAR(fit.turn.in_degrees(), 0.5, 0.01);
  EXPECT_LT(fit.residual_m, 1e-4);
  EXPECT_GT(fit.near_share, 0.999);
}

TEST(FitScan, NoiseAndWhatIsNotInTheModelDisturbLittle) {
  Site model = site_of(Rooms{}), real = site_of(Rooms{.things = {kCupboard}, .noise_m = 0.005});
  const TakenScan truth = scan_at(real, kInFirst);
  std::vector<TakenScan> scans{moved(truth, kHalfDegree, kFiveCentimetres)};
  ASSERT_TRUE(fit_to_model(model, scans));
  EXPECT_TRUE(scans[0].fit.fitted) << scans[0].fit.why;
  EXPECT_LT(apart(scans[0].head, truth.head), 0.002);
  EXPECT_LT(worst_offset(scans[0], truth), 0.004);
  // Half of the range noise and more, as walls are met at a slant.
  EXPECT_GT(scans[0].fit.residual_m, 0.002);
  EXPECT_LT(scans[0].fit.residual_m, 0.006);
  EXPECT_LT(scans[0].fit.near_share, 0.98);
}

TEST(FitScan, AScanOfAnotherPlaceKeepsItsPose) {
  Site site = site_of(Rooms{});
  const TakenScan truth = scan_at(site, kInFirst);
  const auto refused = [&](const glm::dvec3& turn, const Vec3& shift, const char* why) {
    const TakenScan rough = moved(truth, turn, shift);
    std::vector<TakenScan> scans{rough};
    ASSERT_TRUE(fit_to_model(site, scans));
    EXPECT_FALSE(scans[0].fit.fitted);
    EXPECT_NE(scans[0].fit.why.find(why), std::string::npos) << scans[0].fit.why;
    EXPECT_EQ(scans[0].head, rough.head);
    EXPECT_EQ(worst_offset(scans[0], rough), 0);
  };
  refused({}, {500, 0, 0}, "does not fit the model, only 0.0 % of its points");
  refused({0.12, 0, 0}, {}, "too far to be sure");
}

}  // namespace
}  // namespace vantage::test
