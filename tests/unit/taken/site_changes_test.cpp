// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "rooms.hpp"
#include "scene/changed_scene.hpp"
#include "scene/scene_data.hpp"

namespace vantage::test {
namespace {

TEST(SiteChanges, ASiteLikeItsModelHasNone) {
  Site site = site_of(Rooms{.noise_m = 0.005});
  const std::vector<TakenScan> scans{scan_at(site, kInFirst), scan_at(site, kInSecond)};
  const SiteChanges changes = changes_of(site, scans);
  EXPECT_FALSE(changes.any());
  EXPECT_TRUE(changes.things.empty());
  EXPECT_TRUE(changes.seen_through.empty());
}

TEST(SiteChanges, ACupboardIsFoundWithItsPlaceAndSize) {
  Site model = site_of(Rooms{}), real = site_of(Rooms{.things = {kCupboard}});
  const std::vector<TakenScan> scans{scan_at(real, {2, 0.4, 1.85}), scan_at(real, {5.4, 2.5, 1.85})};
  const SiteChanges changes = changes_of(model, scans);
  ASSERT_EQ(changes.things.size(), 1u);
  const Box& box = changes.things[0].box;
  EXPECT_EQ(changes.things[0].scans, 2u);
  const double step = 0.06;  // between rays, at this distance
  EXPECT_NEAR(box.min.x, kCupboard.min.x, step);
  EXPECT_NEAR(box.max.x, kCupboard.max.x, step);
  EXPECT_NEAR(box.min.y, kCupboard.min.y, step);
  EXPECT_NEAR(box.max.y, kCupboard.max.y, step);
  EXPECT_NEAR(box.max.z, kCupboard.max.z, step);
  EXPECT_NEAR(box.min.z, default_tolerance_m, step);  // below, the floor is as near
  EXPECT_TRUE(changes.removed.empty());
  for (const SeenThrough& one : changes.seen_through) ADD_FAILURE() << one.mesh;
}

TEST(SiteChanges, SomebodyWhoStoodStillInOneScanDoesNotCount) {
  const Box person{{3.1, 2.6, 0}, {3.5, 3, 1.75}};
  Site model = site_of(Rooms{}), with = site_of(Rooms{.things = {person}});
  const TakenScan first = scan_at(with, kInFirst), second = scan_at(model, kAcross), again = scan_at(with, kAcross);
  const SiteChanges gone = changes_of(model, std::array{first, second});
  EXPECT_TRUE(gone.things.empty());
  EXPECT_TRUE(gone.cells.empty());
  ASSERT_EQ(gone.passing.size(), 1u);
  EXPECT_NEAR(gone.passing[0].box.max.z, person.max.z, 0.1);
  EXPECT_EQ(gone.passing[0].scans, 1u);
  // The order of scans does not matter. Things that both saw stand there, and so do those that only one could see.
  EXPECT_EQ(changes_of(model, std::array{second, first}).passing.size(), 1u);
  EXPECT_EQ(changes_of(model, std::array{first, again}).things.size(), 1u);
  const SiteChanges alone = changes_of(model, std::array{first, scan_at(model, {11, 4.5, 1.85})});
  EXPECT_EQ(alone.things.size(), 1u);
  EXPECT_TRUE(alone.passing.empty());
}

TEST(SiteChanges, ADoorThatStoodOpenIsTold) {
  Site model = site_of(Rooms{.door_closed = true}), real = site_of(Rooms{});
  const std::vector<TakenScan> scans{scan_at(real, {4.5, 2.4, 1.85})};
  const SiteChanges changes = changes_of(model, scans);
  ASSERT_EQ(changes.seen_through.size(), 1u);
  const SeenThrough& door = changes.seen_through[0];
  EXPECT_EQ(door.mesh, "door leaf");
  EXPECT_TRUE(door.removed);
  EXPECT_NEAR(door.box.min.x, 6.08, 1e-3);
  EXPECT_LT(std::abs(door.box.min.y - 2.01), 0.15);
  EXPECT_LT(std::abs(door.box.max.y - 2.89), 0.15);
  EXPECT_GT(door.area_m2, 0.6 * 0.88 * 2.07);
  EXPECT_TRUE(changes.things.empty());

  Site found = changed_site(model, changes);
  EXPECT_TRUE(std::ranges::none_of(found.scene().meshes(), [](const MeshInfo& m) { return m.name == "door leaf"; }));
  EXPECT_TRUE(found.clash().ray_passes({5, 2.4, 1}, {7, 2.4, 1}));
  EXPECT_FALSE(model.clash().ray_passes({5, 2.4, 1}, {7, 2.4, 1}));
}

TEST(SiteChanges, ADoorThatStaysClosedIsNot) {
  Site site = site_of(Rooms{.door_closed = true});
  const std::vector<TakenScan> scans{scan_at(site, {4.5, 2.4, 1.85})};
  EXPECT_FALSE(changes_of(site, scans).any());
}

TEST(SiteChanges, ADoorThatWasClosedLetsNothingThrough) {
  Site model = site_of(Rooms{}), real = site_of(Rooms{.door_closed = true});
  const std::vector<TakenScan> scans{scan_at(real, {4.5, 2.4, 1.85})};
  const SiteChanges changes = changes_of(model, scans);
  ASSERT_EQ(changes.things.size(), 1u);
  Site found = changed_site(model, changes);
  for (double y = 2.02; y < 2.9; y += 0.02)
    for (double z = 0.02; z < 2.1; z += 0.02) {
      EXPECT_TRUE(model.clash().ray_passes({5.5, y, z}, {6.8, y, z}));
      EXPECT_FALSE(found.clash().ray_passes({5.5, y, z}, {6.8, y, z})) << y << " " << z;
    }
}

TEST(SiteChanges, NobodyStandsInWhatWasFound) {
  Site model = site_of(Rooms{}), real = site_of(Rooms{.things = {kCupboard}});
  const std::vector<TakenScan> scans{scan_at(real, {2, 0.4, 1.85}), scan_at(real, {5.4, 2.5, 1.85})};
  Site found = changed_site(model, changes_of(model, scans));
  const Vec3 inside{kCupboard.centre().x, kCupboard.centre().y, 1.85};
  EXPECT_EQ(model.place_head(inside).station.status, StationStatus::ok);
  EXPECT_NE(found.place_head(inside).station.status, StationStatus::ok);
  EXPECT_EQ(found.place_head(kInFirst).station.status, StationStatus::ok);
  const Vec3 beyond{kCupboard.centre().x, 0.4, 1};
  EXPECT_TRUE(model.clash().ray_passes({3.8, 4, 1}, beyond));
  EXPECT_FALSE(found.clash().ray_passes({3.8, 4, 1}, beyond));
}

TEST(ChangedScene, OneCellIsAClosedCube) {
  Site site = site_of(Rooms{});
  const SolidCells cells{.corner = {1, 1, 1}, .cell_m = 0.25, .cells = {{0, 0, 0}}};
  const Scene scene = changed_scene(site.scene(), cells, {});
  const SceneData& data = scene.data();
  EXPECT_EQ(data.meshes.back().name, kNotInModel);
  EXPECT_EQ(data.meshes.back().role, Role::blocking);
  ASSERT_EQ(data.ranges.back().triangle_count, 12u);
  // The divergence theorem: the volume of what outward triangles enclose.
  double volume = 0;
  Box box;
  for (std::uint32_t k = 0; k < 12; ++k) {
    const Triangle& t = data.triangles[data.ranges.back().first_triangle + k];
    const Vec3 a = widen(data.positions[t[0]]), b = widen(data.positions[t[1]]), c = widen(data.positions[t[2]]);
    volume += dot(a, cross(b, c)) / 6;
    for (const Vec3& p : {a, b, c}) box.extend(data.origin + p);
  }
  EXPECT_NEAR(volume, 0.25 * 0.25 * 0.25, 1e-6);
  EXPECT_NEAR(box.min.x, 1, 1e-6);
  EXPECT_NEAR(box.max.z, 1.25, 1e-6);
  // Two cells beside each other have no face between them.
  const Scene two = changed_scene(site.scene(), {{1, 1, 1}, 0.25, {{0, 0, 0}, {1, 0, 0}}}, {});
  EXPECT_EQ(two.data().ranges.back().triangle_count, 20u);
}

TEST(ChangedScene, UnknownSpaceIsSurveyedWithItsWeight) {
  Site site = site_of(Rooms{});
  const Scene scene = changed_scene(site.scene(), {}, {}, {{1, 1, 1}, 0.25, {{0, 0, 0}}}, 5);
  const MeshInfo& mesh = scene.meshes().back();
  EXPECT_EQ(mesh.name, kUnknown);
  EXPECT_EQ(mesh.role, Role::surveyed);
  EXPECT_EQ(mesh.weight, 5u);
  EXPECT_EQ(mesh.triangle_count, 12u);
  EXPECT_EQ(scene.meshes().size(), site.scene().meshes().size() + 1);
}

TEST(ChangedScene, WithoutChangesItIsTheSame) {
  Site site = site_of(Rooms{.door_closed = true});
  EXPECT_EQ(changed_scene(site.scene(), {}, {}).fingerprint(), site.scene().fingerprint());
}

}  // namespace
}  // namespace vantage::test
