// SPDX-License-Identifier: Apache-2.0
#include "scene/surface_colour.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "support/quad_scene.hpp"

namespace vantage {
namespace {

SceneData scene_with_image(bool repeat) {
  test::QuadScene scene;
  Material material;
  material.image = 0;
  material.repeat_u = material.repeat_v = repeat;
  scene.quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, Role::surveyed, 0.5, material);
  // 2 × 2: black, white / red, half transparent green.
  scene.data().images.push_back({2, 2, {0, 0, 0, 255, 255, 255, 255, 255, 255, 0, 0, 255, 0, 255, 0, 127}});
  return scene.data();
}

TEST(MaterialColour, TexelCentresAreTheTexels) {
  const SceneData scene = scene_with_image(true);
  EXPECT_EQ(pack_srgb(material_colour(scene, scene.materials[0], {0.25f, 0.25f})), 0xFF000000u);
  EXPECT_EQ(pack_srgb(material_colour(scene, scene.materials[0], {0.75f, 0.25f})), 0xFFFFFFFFu);
  EXPECT_EQ(pack_srgb(material_colour(scene, scene.materials[0], {0.25f, 0.75f})), 0xFF0000FFu);
  EXPECT_EQ(pack_srgb(material_colour(scene, scene.materials[0], {0.75f, 0.75f})), 0x7F00FF00u);
}

TEST(MaterialColour, FiltersInLinearLight) {
  const SceneData scene = scene_with_image(false);
  const LinearColour half = material_colour(scene, scene.materials[0], {0.5f, 0.25f});
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(half[i], 0.5, 1e-6);
  EXPECT_EQ(pack_srgb(half), 0xFFBCBCBCu);  // 188, not the 128 of averaged codes
  const LinearColour middle = material_colour(scene, scene.materials[0], {0.5f, 0.5f});
  EXPECT_NEAR(middle[0], 0.5, 1e-6);
  EXPECT_NEAR(middle[1], 0.5, 1e-6);
  EXPECT_NEAR(middle[2], 0.25, 1e-6);
  EXPECT_NEAR(middle[3], (3 + 127 / 255.0) / 4, 1e-6);
}

TEST(MaterialColour, WrapsOrClamps) {
  const SceneData wrapped = scene_with_image(true), clamped = scene_with_image(false);
  for (const float whole : {-3.0f, 0.0f, 5.0f}) {
    EXPECT_EQ(pack_srgb(material_colour(wrapped, wrapped.materials[0], {whole + 0.75f, whole + 0.25f})), 0xFFFFFFFFu)
        << whole;
  }
  EXPECT_NEAR(material_colour(wrapped, wrapped.materials[0], {0.0f, 0.25f})[0], 0.5, 1e-6);  // across the border
  EXPECT_EQ(material_colour(clamped, clamped.materials[0], {0.0f, 0.25f})[0], 0.0f);
  EXPECT_EQ(material_colour(clamped, clamped.materials[0], {9.0f, -4.0f})[0], 1.0f);
  EXPECT_EQ(material_colour(clamped, clamped.materials[0], {std::numeric_limits<float>::infinity(), 0})[0], 0.0f);
}

TEST(SurfaceColour, MultipliesMaterialTextureAndVertices) {
  test::QuadScene built;
  Material material;
  material.base_colour = {0.5f, 0.25f, 1.0f, 0.5f};
  built.quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, Role::surveyed, 0.5, material);
  SceneData scene = built.data();
  EXPECT_EQ(surface_colour(scene, 0, 0, {0.2f, 0.3f}), pack_srgb({0.5f, 0.25f, 1.0f, 0.5f}));
  // Vertices of triangle 0: black, white, blue; weights ½, ¼, ¼.
  scene.colours = {0xFF000000u, 0xFFFFFFFFu, 0xFFFF0000u, 0xFFFFFFFFu};
  const LinearColour expected{0.5f * 0.25f, 0.25f * 0.25f, 0.5f, 0.5f};
  EXPECT_EQ(surface_colour(scene, 0, 0, {0.25f, 0.25f}), pack_srgb(expected));
}

TEST(SurfaceColour, FollowsTextureCoordinates) {
  const SceneData scene = scene_with_image(false);
  // Triangle 0 has corners (0,0), (1,0), (1,1): weights (¼, ½, ¼) meet at (¾, ¼).
  EXPECT_EQ(surface_colour(scene, 0, 0, {0.5f, 0.25f}), 0xFFFFFFFFu);
}

}  // namespace
}  // namespace vantage
