// SPDX-License-Identifier: Apache-2.0
#include "placement/place_head.hpp"

#include <gtest/gtest.h>

#include "placement_scenes.hpp"

namespace vantage {
namespace {

using test::origin;

// A floor whose left half only is marked as station area, with a tank and a pillar on it.
class PlaceHead : public testing::Test {
 protected:
  const Scene scene =
      test::Builder().floor(-10, -10, 10, 10, 0).box({-6, 2, 0}, {-2, 6, 4}).box({-5, -5, 0}, {-4.8, -4.8, 3}).scene();
  const ClashChecker clash{scene};
  const SearchArea area = SearchArea::from_mesh(
      {{origin + Vec3{-10, -10, 0}, origin + Vec3{0, -10, 0}, origin + Vec3{0, 10, 0}, origin + Vec3{-10, 10, 0}},
       {{0, 0}, {1, 0}, {1, 1}, {0, 1}},
       {{0, 1, 2}, {0, 2, 3}}});

  PlacedHead placed(const Vec3& local, std::optional<Uv> uv = {}) const {
    return place_head(&area, clash, 1.85, origin + local, uv);
  }
  StationStatus status(const Vec3& local) const { return placed(local).station.status; }
};

TEST_F(PlaceHead, TellsWhatIsWrongApart) {
  EXPECT_EQ(status({-1, 0, 1.85}), StationStatus::ok);
  EXPECT_EQ(status({-1, 0, 2.7}), StationStatus::ok) << "a high tripod";
  EXPECT_EQ(status({-1, 0, 2.9}), StationStatus::off_ground);
  EXPECT_EQ(status({-1, 0, -50}), StationStatus::off_ground);
  EXPECT_EQ(status({1000, 0, 1.85}), StationStatus::off_ground);
  EXPECT_EQ(status({5, 0, 1.85}), StationStatus::outside);
  EXPECT_EQ(status({-4, 4, 1.85}), StationStatus::inside);
  EXPECT_EQ(status({-4.4, -4.9, 1.85}), StationStatus::clash);
  EXPECT_EQ(status({-4, 4, 4 + 1.85}), StationStatus::outside) << "on the tank";
}

TEST_F(PlaceHead, GivesGroundAndUv) {
  const PlacedHead on_area = placed({-1, 0, 2});
  EXPECT_EQ(on_area.station.position, origin + Vec3({-1, 0, 2}));
  EXPECT_NEAR(on_area.station.ground.z, 30, 1e-9);
  ASSERT_TRUE(on_area.has_uv);
  EXPECT_NEAR(on_area.station.uv.u, 0.9, 1e-12);
  const PlacedHead outside = placed({5, 0, 2});
  EXPECT_FALSE(outside.has_uv);
  EXPECT_NEAR(outside.station.ground.z, 30, 1e-9);
  EXPECT_NEAR(placed({1000, 0, 2}).station.ground.z, 30.15, 1e-9) << "the scanner's height below";
}

TEST_F(PlaceHead, TakesTheGroundOfItsUvHoweverHighTheHeadIs) {
  const PlacedHead high = placed({-1, 0, 7}, Uv{0.9, 0.5});
  EXPECT_EQ(high.station.status, StationStatus::ok);
  EXPECT_NEAR(high.station.ground.z, 30, 1e-9);
  EXPECT_EQ(placed({-1, 0, 7}, Uv{0.1, 0.5}).station.status, StationStatus::off_ground) << "another place's (u, v)";
}

TEST_F(PlaceHead, WithoutAnAreaAnyGroundWillDo) {
  EXPECT_EQ(place_head(nullptr, clash, 1.85, origin + Vec3{5, 0, 1.85}).station.status, StationStatus::ok);
  EXPECT_EQ(place_head(nullptr, clash, 1.85, origin + Vec3{5, 0, 9}).station.status, StationStatus::off_ground);
}

TEST(StationStatus, SaysWhoAddsToANetwork) {
  for (const auto status : {StationStatus::ok, StationStatus::off_ground, StationStatus::outside}) {
    EXPECT_TRUE(active({.uv = {}, .position = {}, .status = status}));
    EXPECT_TRUE(active({.uv = {}, .position = {}, .status = status, .existing = true}));
  }
  EXPECT_FALSE(active({.uv = {}, .position = {}, .status = StationStatus::clash}));
  EXPECT_TRUE(active({.uv = {}, .position = {}, .status = StationStatus::clash, .existing = true})) << "it was scanned";
  for (const auto status : {StationStatus::hole, StationStatus::inside})
    EXPECT_FALSE(active({.uv = {}, .position = {}, .status = status, .existing = true}));
  EXPECT_EQ(to_string(StationStatus::off_ground), "off_ground");
  EXPECT_EQ(explain(StationStatus::ok), "");
  EXPECT_NE(explain(StationStatus::inside).find("inside"), std::string::npos);
}

}  // namespace
}  // namespace vantage
