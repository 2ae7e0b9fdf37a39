// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <numeric>

#include "rooms.hpp"
#include "taken/real_counts.hpp"
#include "vantage/error.hpp"

namespace vantage::test {
namespace {

PlacedStation planned_at(Site& site, const Vec3& head) { return site.place_head(head).station; }

TEST(RealCounts, EqualTheSimulatedOnesOfTheSameStation) {
  Site site = site_of(Rooms{});
  Simulator& simulator = site.simulator();
  std::vector<std::uint32_t> voxels(simulator.voxel_count());
  std::iota(voxels.begin(), voxels.end(), 0u);
  std::vector<std::uint32_t> simulated(voxels.size());
  simulator.scan({.position = kInFirst}, {.outputs = scan_position | scan_voxel}, [&](const ScanChunk& chunk) {
    for (const std::uint32_t voxel : chunk.voxel)
      if (voxel < simulated.size()) ++simulated[voxel];
  });
  const std::vector<std::uint32_t> real = RealCounts(simulator, voxels, 0.1).of(scan_at(site, kInFirst));
  std::uint64_t whole = 0, differ = 0;
  for (std::size_t v = 0; v < voxels.size(); ++v) {
    whole += simulated[v];
    differ += simulated[v] > real[v] ? simulated[v] - real[v] : real[v] - simulated[v];
  }
  EXPECT_GT(whole, 100'000u);
  // Points on faces between voxels are rounded to one of both.
  EXPECT_LT(differ, whole / 1000);
}

TEST(RealCounts, PointsOnOtherThingsDoNotCount) {
  Site model = site_of(Rooms{}), real = site_of(Rooms{.things = {kCupboard}});
  const TakenScan scan = scan_at(real, kInFirst);
  std::vector<std::uint32_t> voxels(model.simulator().voxel_count());
  std::iota(voxels.begin(), voxels.end(), 0u);
  const auto of_model = RealCounts(model.simulator(), voxels, 0.1).of(scan_at(model, kInFirst));
  const auto counted = RealCounts(model.simulator(), voxels, 0.1).of(scan);
  const auto sum = [](const std::vector<std::uint32_t>& c) { return std::accumulate(c.begin(), c.end(), 0ull); };
  EXPECT_LT(sum(counted), 0.99 * static_cast<double>(sum(of_model)));
}

TEST(NextStations, StandInTheRoomThatWasNotScanned) {
  Site site = site_of(Rooms{});
  const std::vector<TakenScan> scans{scan_at(site, kInFirst), scan_at(site, kAcross)};
  const std::vector<PlacedStation> planned{planned_at(site, {2.3, 2.2, 1.85}), planned_at(site, {3.5, 1, 1.85}),
                                           planned_at(site, kInSecond)};
  const auto answer = next_stations(site, scans, {}, planned, {.capture = 0.85, .link = 0});
  ASSERT_TRUE(answer);
  EXPECT_GT(answer->captured.value, 0.4);
  EXPECT_LT(answer->captured.value, 0.65);
  EXPECT_NEAR(answer->captured.value + answer->not_seen, 1, 1e-6);
  EXPECT_TRUE(answer->enough);
  ASSERT_FALSE(answer->next.empty());
  EXPECT_GT(answer->next[0].station.position.x, 6.2);
  EXPECT_GE(answer->captured_then, 0.85);
  EXPECT_GT(answer->visit.minutes, 0);
  double captured = answer->captured.value;
  for (const NextStation& next : answer->next) {
    EXPECT_NEAR(next.captured, captured + next.gain, 1e-6);
    captured = next.captured;
  }
  EXPECT_NEAR(captured, answer->captured_then, 1e-9);

  EXPECT_EQ(answer->planned[0].taken_as, std::optional<std::size_t>(0));  // 0.36 m from the first
  EXPECT_FALSE(answer->planned[1].taken_as);
  EXPECT_FALSE(answer->planned[1].chosen);
  EXPECT_GT(answer->planned[2].gain, 5 * answer->planned[1].gain);
}

TEST(NextStations, AreLinkedToWhatIsThere) {
  Site site = site_of(Rooms{});
  const std::vector<TakenScan> scans{scan_at(site, kInFirst)};
  const auto answer = next_stations(site, scans, {}, {}, {.capture = 0.85, .link = 0.25});
  ASSERT_TRUE(answer);
  EXPECT_TRUE(answer->linked);
  for (std::size_t k = 0; k < answer->next.size(); ++k) {
    EXPECT_GE(answer->next[k].overlap, 0.25);
    ASSERT_TRUE(answer->next[k].linked_to);
    EXPECT_LT(*answer->next[k].linked_to, scans.size() + k);
  }
}

TEST(NextStations, SayWhatTheyTieTogether) {
  Site site = site_of(Rooms{});
  const std::vector<TakenScan> scans{scan_at(site, kInFirst), scan_at(site, kInSecond)};
  // Enough is captured, but no chain of such links joins the scans of two rooms.
  const auto answer = next_stations(site, scans, {}, {}, {.capture = 0.5, .link = 0.3});
  ASSERT_TRUE(answer);
  ASSERT_TRUE(answer->linked);
  ASSERT_FALSE(answer->next.empty());
  std::size_t ties = 0;
  for (std::size_t k = 0; k < answer->next.size(); ++k) {
    if (!answer->next[k].ties) continue;
    ++ties;
    EXPECT_LT(*answer->next[k].ties, scans.size() + k);
  }
  EXPECT_EQ(ties, 1u);
}

TEST(NextStations, EnoughIsEnough) {
  Site site = site_of(Rooms{});
  const std::vector<TakenScan> scans{scan_at(site, kInFirst), scan_at(site, kInSecond)};
  const auto answer = next_stations(site, scans, {}, {}, {.capture = 0.5, .link = 0});
  ASSERT_TRUE(answer);
  EXPECT_TRUE(answer->next.empty());
  EXPECT_TRUE(answer->enough);
  EXPECT_EQ(answer->captured_then, answer->captured.value);
}

TEST(NextStations, ThingsHideWhatTheyStandBefore) {
  Site model = site_of(Rooms{}), real = site_of(Rooms{.things = {kCupboard}});
  const std::vector<TakenScan> scans{scan_at(real, {2, 3.5, 1.85}), scan_at(real, {5, 4, 1.85})};
  const SiteChanges changes = changes_of(model, scans);
  ASSERT_EQ(changes.things.size(), 1u);
  Site found = changed_site(model, changes);
  const Vec3 inside{kCupboard.centre().x, kCupboard.centre().y, 1.85};
  const std::vector<PlacedStation> planned{planned_at(model, inside)};
  const auto answer = next_stations(found, scans, changes, planned, {.capture = 0.9, .link = 0});
  ASSERT_TRUE(answer);
  ASSERT_EQ(answer->hidden_by.size(), 1u);
  EXPECT_GT(answer->hidden_by[0], 0.002);
  EXPECT_NEAR(answer->captured.value + answer->hidden_by[0] + answer->not_seen, 1, 1e-6);
  EXPECT_NE(answer->planned[0].status, StationStatus::ok);
  EXPECT_FALSE(answer->planned[0].chosen);
  for (const NextStation& next : answer->next) {
    const Vec3& p = next.station.position;
    EXPECT_FALSE(p.x > 3.2 && p.x < 4.4 && p.y > 0.9 && p.y < 1.5) << p.x << " " << p.y;
  }
}

TEST(NextStations, RefuseWhatMakesNoSense) {
  Site site = site_of(Rooms{});
  EXPECT_THROW(next_stations(site, {}, {}, {}), Error);
  const std::vector<TakenScan> scans{scan_at(site, kInFirst)};
  EXPECT_THROW(next_stations(site, scans, {}, {}, {.capture = 0}), Error);
  EXPECT_THROW(next_stations(site, scans, {}, {}, {.link = 2}), Error);
}

}  // namespace
}  // namespace vantage::test
