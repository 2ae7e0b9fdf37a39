// SPDX-License-Identifier: Apache-2.0
#include "placement/ground_weights.hpp"

#include <gtest/gtest.h>

#include "support/quad_scene.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

using test::QuadScene;

// A floor of 20 m × 20 m at z = 0.
QuadScene floor() {
  QuadScene scene;
  scene.quad({-10, -10, 0}, {20, 0, 0}, {0, 20, 0});
  return scene;
}

TEST(GroundWeights, LeaveGroundAThird) {
  const Scene scene = floor().quad({0, 0, 0}, {10, 0, 0}, {0, 0, 3}).scene();
  const SearchArea area = SearchArea::build(scene);
  ASSERT_TRUE(ground_is_unmarked(scene, area));
  const GroundWeights found = ground_weights(scene, area);
  EXPECT_EQ(found.ground, std::vector<std::size_t>{0});
  EXPECT_NEAR(found.share, 400.0 / 430, 1e-6);
  // 400 / (400 + w · 30) <= 1/3 from w = 26.7 on
  EXPECT_EQ(found.weights, (std::vector<std::uint32_t>{1, 27}));
  EXPECT_NEAR(found.weighted_share, 400.0 / (400 + 27 * 30), 1e-6);
  EXPECT_TRUE(found.changes);
  EXPECT_NE(found.told.find("quad 0"), std::string::npos) << found.told;
  const Scene weighed = with_weights(scene, found.weights);
  EXPECT_EQ(weighed.meshes()[1].weight, 27u);
  EXPECT_EQ(scene.meshes()[1].weight, 1u);
  EXPECT_NE(weighed.fingerprint(), scene.fingerprint());
  EXPECT_FALSE(ground_is_unmarked(weighed, area)) << "weights that are there already are kept";
}

TEST(GroundWeights, PanesAndMirrorsMarkNothing) {
  for (const bool glass : {false, true}) {
    QuadScene quads =
        floor().quad({0, 0, 0}, {10, 0, 0}, {0, 0, 3}).quad({0, 4, 0}, {5, 0, 0}, {0, 0, 3}, Role::blocking);
    const SearchArea area = SearchArea::build(quads.scene());
    EXPECT_FALSE(ground_is_unmarked(quads.scene(), area)) << "someone made it blocking";
    (glass ? quads.data().meshes[2].glass : quads.data().meshes[2].mirror) = true;
    ASSERT_TRUE(ground_is_unmarked(quads.scene(), area));
    EXPECT_EQ(ground_weights(quads.scene(), area).weights[1], 27u);
  }
}

TEST(GroundWeights, LeaveAloneWhatIsNoTrouble) {
  QuadScene quads = floor();
  for (float x = -9; x < 10; x += 2) quads.quad({x, -9, 0}, {0, 18, 0}, {0, 0, 6});  // 10 walls of 108 m²
  const Scene scene = quads.scene();
  const GroundWeights found = ground_weights(scene, SearchArea::build(scene));
  EXPECT_NEAR(found.share, 400.0 / 1480, 1e-6);
  EXPECT_FALSE(found.changes);
  EXPECT_TRUE(found.told.empty());
}

TEST(GroundWeights, SayWhereGroundCannotBeTold) {
  const Scene scene = floor().scene();
  const GroundWeights found = ground_weights(scene, SearchArea::build(scene));
  EXPECT_NEAR(found.share, 1, 1e-12);
  EXPECT_FALSE(found.changes);
  EXPECT_NE(found.told.find("cannot weigh more"), std::string::npos) << found.told;
}

// Nobody stands on a table, however level it is.
TEST(GroundWeights, TellTablesFromGround) {
  const Scene scene = floor().quad({2, 2, 0.75f}, {1, 0, 0}, {0, 2, 0}).scene();
  const SearchMesh mesh{.positions = {{-10, -10, 0}, {10, -10, 0}, {10, 10, 0}, {-10, 10, 0}},
                        .uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}},
                        .triangles = {{0, 1, 2}, {0, 2, 3}}};
  const GroundWeights found = ground_weights(scene, SearchArea::from_mesh(mesh));
  EXPECT_EQ(found.ground, std::vector<std::size_t>{0});
  EXPECT_EQ(found.weights[1], 255u);
}

TEST(GroundWeights, AreForSitesThatMarkNothing) {
  const Scene blocked = floor().quad({0, 0, 0}, {10, 0, 0}, {0, 0, 3}, Role::blocking).scene();
  EXPECT_FALSE(ground_is_unmarked(blocked, SearchArea::build(blocked)));
  const Scene scene = floor().scene();
  SearchMesh mesh{
      .positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .uvs = {{0, 0}, {1, 0}, {0, 1}}, .triangles = {{0, 1, 2}}};
  EXPECT_FALSE(ground_is_unmarked(scene, SearchArea::from_mesh(mesh)));
  EXPECT_THROW(with_weights(scene, {1, 2}), Error);
  EXPECT_THROW(with_weights(scene, {0}), Error);
}

}  // namespace
}  // namespace vantage
