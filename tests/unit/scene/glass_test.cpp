// SPDX-License-Identifier: Apache-2.0
// Which meshes are of glass, and that these come last; and which are mirrors.
#include <gtest/gtest.h>

#include <algorithm>

#include "scene/scene_data.hpp"
#include "support/glb_builder.hpp"
#include "vantage/error.hpp"
#include "vantage/scene.hpp"

namespace vantage {
namespace {

using nlohmann::json;
using test::GlbBuilder;

const json kTransmits = {{"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 0.9}}}}}};

json blended(double alpha) {
  return {{"alphaMode", "BLEND"}, {"pbrMetallicRoughness", {{"baseColorFactor", {0.2, 0.4, 0.6, alpha}}}}};
}

// Nodes "pane" with that material and "wall" without, in this order, half a square metre each.
GlbBuilder pane_and_wall(const json& material) {
  GlbBuilder builder;
  builder.json["materials"] = {material};
  const int pane = builder.triangle("pane");
  builder.json["nodes"][pane]["translation"] = {0, 0, 3};
  builder.json["meshes"][0]["primitives"][0]["material"] = 0;
  builder.triangle("wall");
  return builder;
}

const MeshInfo& mesh(const Scene& scene, const std::string& name) {
  const auto found = std::ranges::find(scene.meshes(), name, &MeshInfo::name);
  EXPECT_NE(found, scene.meshes().end());
  return *found;
}

bool is_glass(const GlbBuilder& builder, SceneOptions options = {}) {
  options.unit = Unit::metre, options.up = UpAxis::y;
  return mesh(load(builder, options), "pane").glass;
}

TEST(Glass, IsWhatTransmitsOrIsMostlyTransparent) {
  EXPECT_TRUE(is_glass(pane_and_wall(kTransmits)));
  EXPECT_TRUE(is_glass(pane_and_wall(blended(0.3))));
  EXPECT_TRUE(is_glass(pane_and_wall(blended(0.5))));
  EXPECT_FALSE(is_glass(pane_and_wall(blended(0.7))));
  EXPECT_FALSE(is_glass(pane_and_wall({{"name", "plain"}})));
  json opaque = blended(0.3);
  opaque["alphaMode"] = "OPAQUE";  // whose alpha is ignored
  EXPECT_FALSE(is_glass(pane_and_wall(opaque)));
  json hardly = kTransmits;
  hardly["extensions"]["KHR_materials_transmission"]["transmissionFactor"] = 0.01;
  EXPECT_FALSE(is_glass(pane_and_wall(hardly)));
}

TEST(Glass, ExtrasAndPatternsComeBeforeTheMaterial) {
  GlbBuilder clear = pane_and_wall(kTransmits), plain = pane_and_wall({{"name", "plain"}});
  EXPECT_FALSE(is_glass(clear, {.glass = {"opaque"}}));
  EXPECT_TRUE(is_glass(plain, {.glass = {"pan*"}}));
  plain.json["nodes"][0]["extras"] = {{"vantage", {{"glass", true}}}};
  EXPECT_TRUE(is_glass(plain));
  EXPECT_FALSE(is_glass(plain, {.surveyed = {"pane"}}));
  clear.json["nodes"][0]["extras"] = {{"vantage", {{"glass", false}}}};
  EXPECT_FALSE(is_glass(clear));
  EXPECT_TRUE(is_glass(clear, {.glass = {"pane"}}));
  clear.json["nodes"][0]["extras"] = {{"vantage", {{"glass", 1}}}};
  EXPECT_THROW(is_glass(clear), Error);
  EXPECT_THROW(is_glass(plain, {.glass = {"nothing of the kind"}}), Error);
}

TEST(Glass, IsSurveyedWhereItIsNamedItself) {
  GlbBuilder builder;
  builder.json["materials"] = {kTransmits};
  const int window = builder.node({{"name", "window"}});
  const int pane = builder.triangle("pane");
  builder.json["scenes"][0]["nodes"].erase(1);
  builder.json["nodes"][window]["children"] = {pane};
  builder.json["meshes"][0]["primitives"][0]["material"] = 0;
  builder.triangle("wall");
  SceneOptions options{.surveyed = {"window", "wall"}, .unit = Unit::metre, .up = UpAxis::y};
  const Scene named_above = load(builder, options);
  EXPECT_TRUE(mesh(named_above, "pane").glass);
  EXPECT_EQ(mesh(named_above, "pane").role, Role::blocking);
  options.surveyed = {"pane"};
  const Scene named = load(builder, options);
  EXPECT_FALSE(mesh(named, "pane").glass);
  EXPECT_EQ(mesh(named, "pane").role, Role::surveyed);
  EXPECT_EQ(mesh(named, "wall").role, Role::blocking);
  EXPECT_EQ(named.data().opaque_triangles().size(), 2u);
}

TEST(Glass, ComesLastAndIsTold) {
  const Scene scene = load(pane_and_wall(kTransmits), {.unit = Unit::metre, .up = UpAxis::y});
  ASSERT_EQ(scene.meshes().size(), 2u);
  EXPECT_EQ(scene.meshes()[0].name, "wall");
  EXPECT_EQ(scene.meshes()[0].role, Role::surveyed);
  EXPECT_EQ(scene.meshes()[1].role, Role::blocking);
  EXPECT_EQ(scene.triangle_count(), 2u);
  EXPECT_EQ(scene.data().opaque_triangles().size(), 1u);
  ASSERT_EQ(scene.notes().size(), 1u);
  EXPECT_EQ(
      scene.notes()[0],
      "rays pass 0.5 m² of glass, each face counted, which stops people and links: \"pane\"; the word opaque for the "
      "setting glass stops rays too");
  const Scene opaque = load(pane_and_wall(kTransmits), {.glass = {"opaque"}, .unit = Unit::metre, .up = UpAxis::y});
  EXPECT_EQ(opaque.data().opaque_triangles().size(), 2u);
  EXPECT_TRUE(opaque.notes().empty());
  EXPECT_NE(opaque.fingerprint(), scene.fingerprint());
}

TEST(Glass, AloneLeavesNothingToSurvey) {
  GlbBuilder builder;
  builder.json["materials"] = {kTransmits};
  builder.triangle("pane");
  builder.json["meshes"][0]["primitives"][0]["material"] = 0;
  try {
    load(builder, {.unit = Unit::metre, .up = UpAxis::y});
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("nothing to survey"), std::string::npos) << error.what();
  }
}

json metal(json factors) { return {{"pbrMetallicRoughness", std::move(factors)}}; }

bool is_mirror(const GlbBuilder& builder, SceneOptions options = {}) {
  options.unit = Unit::metre, options.up = UpAxis::y;
  return mesh(load(builder, options), "pane").mirror;
}

TEST(Mirror, IsPolishedMetal) {
  EXPECT_TRUE(is_mirror(pane_and_wall(metal({{"metallicFactor", 1}, {"roughnessFactor", 0}}))));
  EXPECT_TRUE(is_mirror(pane_and_wall(metal({{"roughnessFactor", 0.05}})))) << "metallic is the default";
  EXPECT_FALSE(is_mirror(pane_and_wall(metal({{"metallicFactor", 1}})))) << "rough is the default";
  EXPECT_FALSE(is_mirror(pane_and_wall(metal({{"metallicFactor", 0}, {"roughnessFactor", 0}}))));
  EXPECT_FALSE(is_mirror(pane_and_wall(metal({{"metallicFactor", 1}, {"roughnessFactor", 0.2}}))));
  EXPECT_FALSE(is_mirror(pane_and_wall({{"name", "plain"}})));
}

TEST(Mirror, ExtrasAndPatternsComeBeforeTheMaterial) {
  GlbBuilder polished = pane_and_wall(metal({{"roughnessFactor", 0}})), plain = pane_and_wall({{"name", "plain"}});
  EXPECT_FALSE(is_mirror(polished, {.mirror = {"none"}}));
  EXPECT_FALSE(is_mirror(polished, {.surveyed = {"pane"}}));
  EXPECT_TRUE(is_mirror(plain, {.mirror = {"pan*"}}));
  EXPECT_FALSE(is_mirror(plain, {.glass = {"pane"}, .mirror = {"pane"}})) << "glass comes first";
  plain.json["nodes"][0]["extras"] = {{"vantage", {{"mirror", true}}}};
  EXPECT_TRUE(is_mirror(plain));
  EXPECT_THROW(is_mirror(plain, {.mirror = {"nothing of the kind"}}), Error);
  plain.json["nodes"][0]["extras"] = {{"vantage", {{"mirror", "yes"}}}};
  EXPECT_THROW(is_mirror(plain), Error);
}

TEST(Mirror, BlocksAndIsTold) {
  const Scene scene = load(pane_and_wall(metal({{"roughnessFactor", 0}})), {.unit = Unit::metre, .up = UpAxis::y});
  EXPECT_EQ(mesh(scene, "pane").role, Role::blocking);
  EXPECT_EQ(mesh(scene, "wall").role, Role::surveyed);
  EXPECT_TRUE(std::ranges::any_of(scene.notes(), [](const std::string& note) {
    return note ==
           "0.5 m² are mirrors, of which scans show ghosts and no points: \"pane\"; the word none for the "
           "setting mirror makes them matt";
  }));
}

}  // namespace
}  // namespace vantage
