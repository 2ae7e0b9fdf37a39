// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "rooms.hpp"
#include "scene/changed_scene.hpp"
#include "taken/depth_picture.hpp"

namespace vantage::test {
namespace {

std::vector<Vec3> middles(const UnknownSpace& space) {
  std::vector<Vec3> all;
  for (const auto& cell : space.cells)
    all.push_back(space.corner + Vec3{cell[0] + 0.5, cell[1] + 0.5, cell[2] + 0.5} * space.cell_m);
  return all;
}

TEST(DepthPicture, TellsWhatLiesBeforeAndBehind) {
  Site site = site_of(Rooms{.things = {kCupboard}});
  const DepthPicture picture(scan_at(site, {2, 1.2, 1.2}));
  EXPECT_NEAR(picture.beyond({2.6, 1.2, 1.2}), 0.6, 0.05);  // to the cupboard
  EXPECT_NEAR(picture.beyond({5, 1.2, 1.2}), -1.8, 0.05);   // behind it
  EXPECT_NEAR(picture.beyond({2, 4, 1.2}), 1, 0.05);        // to the wall
  EXPECT_LT(picture.beyond({9, 1.2, 1.2}), -1);             // in the other room
  const TakenScan nothing{.head = {2, 2, 2}};
  EXPECT_LT(DepthPicture(nothing).beyond({3, 2, 2}), -1e9);
}

TEST(UnknownSpace, IsBehindADoorAndBehindThings) {
  Site site = site_of(Rooms{.things = {kCupboard}});
  const UnknownSpace space = unknown_space(site, std::array{scan_at(site, {2, 2, 1.2})});
  const std::vector<Vec3> cells = middles(space);
  const auto in = [&](const Box& box) {
    return std::ranges::count_if(cells, [&](const Vec3& p) {
      return p.x > box.min.x && p.x < box.max.x && p.y > box.min.y && p.y < box.max.y && p.z > box.min.z &&
             p.z < box.max.z;
    });
  };
  EXPECT_GT(in({{6.2, 0, 0}, {12.2, 5, 2}}), 20) << "the part of the second room that the doorway hides";
  EXPECT_GT(in({{3.2, 0, 0}, {6, 0.9, 2}}), 3) << "behind the cupboard";
  EXPECT_EQ(in({{0.1, 1.6, 0}, {3.1, 4.9, 2}}), 0) << "seen, the tripod's place included";
  EXPECT_TRUE(std::ranges::is_sorted(space.cells));
}

TEST(UnknownSpace, EndsWhenAllIsSeen) {
  Site site = site_of(Rooms{});
  const std::array some{scan_at(site, kInFirst)};
  const std::array all{some[0], scan_at(site, kInSecond), scan_at(site, {11, 4, 1.85}), scan_at(site, kAcross)};
  EXPECT_GT(unknown_space(site, some).cells.size(), 20u);
  EXPECT_LT(unknown_space(site, all).cells.size(), 10u);
}

TEST(UnknownSpace, ANextStationUncoversIt) {
  const Box screen{{3, 0, 0}, {3.1, 3.5, 2.6}};
  Site site = site_of(Rooms{.things = {screen}, .door_closed = true});
  const std::array scans{scan_at(site, {1.5, 1.5, 1.85})};
  SiteChanges changes;
  changes.unknown = unknown_space(site, scans);
  ASSERT_GT(changes.unknown.cells.size(), 10u);
  Site found = changed_site(site, changes);
  const auto answer = next_stations(found, scans, changes, {}, {.capture = 0.9, .link = 0, .unknown = true});
  ASSERT_TRUE(answer);
  EXPECT_GT(answer->unknown, 0.02);
  EXPECT_NEAR(answer->captured.value + answer->not_seen + answer->unknown, 1, 1e-6);
  ASSERT_FALSE(answer->next.empty());
  const std::vector<Vec3> cells = middles(changes.unknown);
  std::ptrdiff_t most = 0;
  for (const NextStation& next : answer->next)
    most = std::max(most, std::ranges::count_if(
                              cells, [&](const Vec3& p) { return site.clash().ray_passes(next.station.position, p); }));
  EXPECT_GT(most, std::ssize(cells) / 2) << "one of them sees most of it";
}

}  // namespace
}  // namespace vantage::test
