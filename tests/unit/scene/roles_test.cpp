// SPDX-License-Identifier: Apache-2.0
// Roles, weights, limits of points and diffuse coefficients: extras, patterns, their order, and defaults.
#include <gtest/gtest.h>

#include <map>

#include "scene/glob.hpp"
#include "scene/scene_data.hpp"
#include "support/glb_builder.hpp"
#include "support/temporary_folder.hpp"
#include "vantage/error.hpp"
#include "vantage/scene.hpp"

namespace vantage {
namespace {

using nlohmann::json;
using test::GlbBuilder;
using test::load;

std::map<std::string, Role> roles(const Scene& scene) {
  std::map<std::string, Role> out;
  for (const MeshInfo& mesh : scene.meshes()) out[mesh.name] = mesh.role;
  return out;
}

std::string message(const GlbBuilder& builder, const SceneOptions& options, Errc code) {
  try {
    load(builder, options);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), code);
    return error.what();
  }
  ADD_FAILURE() << "no error";
  return {};
}

TEST(Glob, MatchesAsAShellDoes) {
  EXPECT_TRUE(glob_matches("", ""));
  EXPECT_FALSE(glob_matches("", "a"));
  EXPECT_TRUE(glob_matches("*", ""));
  EXPECT_TRUE(glob_matches("pipe-*", "pipe-3"));
  EXPECT_FALSE(glob_matches("pipe-*", "a pipe-3"));
  EXPECT_TRUE(glob_matches("*-?", "pipe-3"));
  EXPECT_FALSE(glob_matches("*-?", "pipe-33"));
  EXPECT_TRUE(glob_matches("a*b*c", "axxbyybzzc"));
  EXPECT_FALSE(glob_matches("a*b*c", "axxbyybzz"));
  EXPECT_FALSE(glob_matches("Pipe", "pipe"));
  EXPECT_TRUE(glob_matches("**a", "aaa"));
  EXPECT_FALSE(glob_matches(std::string(60, '*') + "b", std::string(10'000, 'a')));
}

TEST(Roles, WithoutMarksAllIsSurveyed) {
  GlbBuilder builder;
  builder.triangle("a");
  builder.triangle("b");
  EXPECT_EQ(roles(load(builder)), (std::map<std::string, Role>{{"a", Role::surveyed}, {"b", Role::surveyed}}));
}

TEST(Roles, OnceSomethingIsMarkedSurveyedTheRestBlocks) {
  GlbBuilder builder;
  builder.triangle("a", {{"role", "surveyed"}});
  builder.triangle("b");
  EXPECT_EQ(roles(load(builder)), (std::map<std::string, Role>{{"a", Role::surveyed}, {"b", Role::blocking}}));
}

TEST(Roles, MarkingOnlyWhatIsNotSurveyedLeavesTheRestSurveyed) {
  GlbBuilder builder;
  builder.triangle("a");
  builder.triangle("b", {{"role", "blocking"}});
  builder.triangle("c", {{"role", "ignore"}});
  builder.triangle("d", {{"role", "search"}});
  const Scene scene = load(builder);
  EXPECT_EQ(roles(scene), (std::map<std::string, Role>{{"a", Role::surveyed}, {"b", Role::blocking}}));
  EXPECT_TRUE(scene.has_search_area());
}

TEST(Roles, NodeComesBeforeMeshBeforeMaterialAndIsInherited) {
  GlbBuilder builder;
  builder.json["materials"] = {{{"extras", {{"vantage", {{"role", "blocking"}, {"diffuse", 0.1}}}}}}};
  const int by_node = builder.triangle("by node", {{"role", "surveyed"}, {"diffuse", 0.3}});
  const int by_mesh = builder.triangle("by mesh");
  const int by_material = builder.triangle("by material");
  builder.json["meshes"][1]["extras"]["vantage"] = {{"role", "surveyed"}, {"diffuse", 0.2}};
  for (std::size_t m = 0; m < 3; ++m) builder.json["meshes"][m]["primitives"][0]["material"] = 0;
  const int parent =
      builder.node({{"name", "parent"}, {"extras", {{"vantage", {{"role", "ignore"}, {"diffuse", 0.4}}}}}});
  const int mesh = builder.mesh(builder.json["meshes"][2]["primitives"][0]);
  builder.child(parent, {{"name", "ignored child"}, {"mesh", mesh}, {"translation", {9, 0, 0}}});
  builder.child(parent, {{"name", "kept child"},
                         {"mesh", mesh},
                         {"translation", {8, 0, 0}},
                         {"extras", {{"vantage", {{"role", "surveyed"}}}}}});
  EXPECT_LT(by_node + by_mesh + by_material, 4);
  const Scene scene = load(builder);
  EXPECT_EQ(roles(scene), (std::map<std::string, Role>{{"by node", Role::surveyed},
                                                       {"by mesh", Role::surveyed},
                                                       {"by material", Role::blocking},
                                                       {"kept child", Role::surveyed}}));
  std::map<std::string, double> diffuse;
  for (const MeshInfo& info : scene.meshes()) diffuse[info.name] = info.diffuse;
  EXPECT_EQ(diffuse, (std::map<std::string, double>{
                         {"by node", 0.3}, {"by mesh", 0.2}, {"by material", 0.1}, {"kept child", 0.4}}));
}

TEST(Roles, PatternsComeBeforeExtras) {
  GlbBuilder builder;
  builder.triangle("pipe-1", {{"role", "ignore"}});
  builder.triangle("pipe-2");
  builder.triangle("ground", {{"role", "surveyed"}});
  const int group = builder.node({{"name", "hall"}});
  builder.child(group, {{"name", "wall"}, {"mesh", 0}, {"translation", {50, 0, 0}}});
  SceneOptions options;
  options.surveyed = {"*"};
  options.blocking = {"ground", "hall"};
  EXPECT_EQ(roles(load(builder, options)), (std::map<std::string, Role>{{"pipe-1", Role::surveyed},
                                                                        {"pipe-2", Role::surveyed},
                                                                        {"ground", Role::blocking},
                                                                        {"wall", Role::surveyed}}))
      << "the wall's own name matches * and is nearer than its parent's";
  options.surveyed = {"pipe-?"};
  EXPECT_EQ(roles(load(builder, options))["wall"], Role::blocking) << "handed down from hall";
  options.ignore = {"pipe-2"};
  EXPECT_EQ(roles(load(builder, options)).count("pipe-2"), 0u);
}

TEST(Roles, ThePatternWithMostLettersHolds) {
  GlbBuilder builder;
  for (const char* name : {"house", "house-roof", "tree"}) builder.triangle(name);
  SceneOptions options;
  options.surveyed = {"house*"};
  options.blocking = {"*"};
  EXPECT_EQ(roles(load(builder, options)),
            (std::map<std::string, Role>{
                {"house", Role::surveyed}, {"house-roof", Role::surveyed}, {"tree", Role::blocking}}));
  options.ignore = {"*roof"};  // four letters against five
  EXPECT_EQ(roles(load(builder, options)).at("house-roof"), Role::surveyed);
  options.ignore = {"*-roof"};  // five against five: the later list wins
  EXPECT_FALSE(roles(load(builder, options)).contains("house-roof"));
  options.weights = {{"house", 3}, {"*", 2}};
  const Scene scene = load(builder, options);
  EXPECT_EQ(scene.meshes()[0].weight, 3u);
  EXPECT_EQ(scene.meshes()[1].weight, 2u);
}

TEST(Roles, UnnamedNodesGoByTheirMesh) {
  GlbBuilder builder;
  builder.triangle("");
  builder.triangle("");
  builder.json["meshes"][0]["name"] = "tank";
  SceneOptions options;
  options.surveyed = {"tank"};
  EXPECT_EQ(roles(load(builder, options)),
            (std::map<std::string, Role>{{"tank", Role::surveyed}, {"node 1", Role::blocking}}));
}

TEST(Roles, APatternThatMatchesNothingIsAnErrorThatListsNodes) {
  GlbBuilder builder;
  builder.triangle("tank");
  SceneOptions options;
  options.blocking = {"grund"};
  const std::string text = message(builder, options, Errc::invalid_argument);
  EXPECT_NE(text.find("grund"), std::string::npos);
  EXPECT_NE(text.find("tank"), std::string::npos);
}

TEST(Roles, WrongMarksAreErrorsThatNameTheNode) {
  for (const json& mark : {json{{"role", "survey"}}, json{{"role", 3}}, json{{"diffuse", 1.5}}, json{{"diffuse", -0.1}},
                           json{{"diffuse", "dark"}}, json("surveyed")}) {
    GlbBuilder builder;
    builder.triangle("tank", mark);
    EXPECT_NE(message(builder, {}, Errc::malformed_file).find("\"tank\""), std::string::npos) << mark;
  }
}

TEST(Weights, FollowTheRulesOfRoles) {
  GlbBuilder builder;
  builder.triangle("wall", {{"weight", 3}});
  builder.triangle("door", {{"weight", 7}});
  builder.triangle("floor");
  const int group = builder.node({{"name", "facade"}, {"extras", {{"vantage", {{"weight", 9}}}}}});
  builder.child(group, {{"name", "statue"}, {"mesh", 0}, {"translation", {50, 0, 0}}});
  const auto weights = [&](const SceneOptions& options) {
    std::map<std::string, std::uint32_t> all;
    const Scene scene = load(builder, options);
    for (const MeshInfo& info : scene.meshes()) all[info.name] = info.weight;
    return all;
  };
  using Weights = std::map<std::string, std::uint32_t>;
  EXPECT_EQ(weights({}), (Weights{{"wall", 3}, {"door", 7}, {"floor", 1}, {"statue", 9}}));
  SceneOptions options;
  options.weights = {{"*oor", 255}, {"door", 2}, {"facade", 4}};
  EXPECT_EQ(weights(options), (Weights{{"wall", 3}, {"door", 2}, {"floor", 255}, {"statue", 4}}));
  const auto plain = load(builder), other = load(builder, options);
  EXPECT_NE(plain.fingerprint(), other.fingerprint());

  options.weights = {{"door", 256}};
  EXPECT_NE(message(builder, options, Errc::invalid_argument).find("256"), std::string::npos);
  options.weights = {{"window", 2}};
  EXPECT_NE(message(builder, options, Errc::invalid_argument).find("window"), std::string::npos);
  for (const json& mark :
       {json{{"weight", 0}}, json{{"weight", 256}}, json{{"weight", 1.5}}, json{{"weight", "high"}}}) {
    GlbBuilder wrong;
    wrong.triangle("tank", mark);
    EXPECT_NE(message(wrong, {}, Errc::malformed_file).find("\"tank\""), std::string::npos) << mark;
  }
}

TEST(PointLimits, OfMeshesFollowTheRulesOfRoles) {
  GlbBuilder builder;
  builder.triangle("wall", {{"detail_mm", 20}, {"accuracy_mm", 3}});
  builder.triangle("flange", {{"detail_mm", 8.5}});
  builder.triangle("floor");
  const int group = builder.node({{"name", "plant"}, {"extras", {{"vantage", {{"accuracy_mm", 1}}}}}});
  builder.child(group, {{"name", "pump"}, {"mesh", 0}, {"translation", {50, 0, 0}}});
  using Limits = std::map<std::string, std::pair<double, double>>;  // in millimetres
  const auto limits = [&](const SceneOptions& options) {
    Limits all;
    const Scene scene = load(builder, options);
    for (const MeshInfo& info : scene.meshes()) all[info.name] = {info.detail_m * 1e3, info.accuracy_m * 1e3};
    return all;
  };
  EXPECT_EQ(limits({}), (Limits{{"wall", {20, 3}}, {"flange", {8.5, 0}}, {"floor", {0, 0}}, {"pump", {0, 1}}}));
  SceneOptions options;
  options.details_mm = {{"fl*", 10}, {"flange", 4}};
  options.accuracies_mm = {{"plant", 2}};
  EXPECT_EQ(limits(options), (Limits{{"wall", {20, 3}}, {"flange", {4, 0}}, {"floor", {10, 0}}, {"pump", {0, 2}}}));
  EXPECT_NE(load(builder).fingerprint(), load(builder, options).fingerprint());

  options.details_mm = {{"wall", 0}};
  EXPECT_NE(message(builder, options, Errc::invalid_argument).find("the detail of \"wall\" is 0"), std::string::npos);
  options.details_mm = {{"window", 2}};
  EXPECT_NE(message(builder, options, Errc::invalid_argument).find("window"), std::string::npos);
  for (const json& mark : {json{{"detail_mm", 0}}, json{{"detail_mm", "fine"}}, json{{"accuracy_mm", -1}}}) {
    GlbBuilder wrong;
    wrong.triangle("tank", mark);
    EXPECT_NE(message(wrong, {}, Errc::malformed_file).find("\"tank\""), std::string::npos) << mark;
  }
}

TEST(Roles, NothingToSurveyIsAnError) {
  GlbBuilder empty;
  EXPECT_NE(message(empty, {}, Errc::malformed_file).find("nothing to survey"), std::string::npos);
  GlbBuilder blocking;
  blocking.triangle("a", {{"role", "blocking"}});
  EXPECT_NE(message(blocking, {}, Errc::malformed_file).find("only block"), std::string::npos);
  GlbBuilder search;
  search.triangle("a", {{"role", "search"}});
  EXPECT_NE(message(search, {}, Errc::malformed_file).find("nothing to survey"), std::string::npos);
}

TEST(Diffuse, ComesFromThePlainBaseColourElseTheDefault) {
  GlbBuilder builder;
  builder.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorFactor", {0.2, 0.4, 0.6, 1}}}}},
                               {{"name", "says nothing"}}};
  for (const char* name : {"coloured", "plain", "bare"}) builder.triangle(name);
  builder.json["meshes"][0]["primitives"][0]["material"] = 0;
  builder.json["meshes"][1]["primitives"][0]["material"] = 1;
  SceneOptions options;
  options.default_diffuse = 0.7;
  const Scene scene = load(builder, options);
  EXPECT_NEAR(scene.meshes()[0].diffuse, 0.2126 * 0.2 + 0.7152 * 0.4 + 0.0722 * 0.6, 1e-6);
  EXPECT_EQ(scene.meshes()[1].diffuse, 0.7);
  EXPECT_EQ(scene.meshes()[2].diffuse, 0.7);
  options.default_diffuse = 1.01;
  EXPECT_THROW(load(builder, options), Error);
}

TEST(SearchArea, KeepsDoublePositionsAndItsUv) {
  GlbBuilder builder;
  builder.triangle("part");
  const int points = builder.positions({0, 1, 0, 4, 1, 0, 0, 1, -4}),
            uv = builder.accessor(std::vector<float>{0, 0, 1, 0, 0, 1}, 5126, "VEC2");
  builder.node({{"name", "floor"},
                {"translation", {500'000.125, 0, -4'500'000}},
                {"mesh", builder.mesh({{"attributes", {{"POSITION", points}, {"TEXCOORD_0", uv}}}})}});
  builder.json["nodes"][0]["translation"] = {500'000, 0, -4'500'000};
  SceneOptions options;
  options.search = {"floor"};
  const Scene scene = load(builder, options);
  const SceneData& data = scene.data();
  EXPECT_EQ(data.search_positions,
            (std::vector<Vec3>{{500'000.125, 4'500'000, 1}, {500'004.125, 4'500'000, 1}, {500'000.125, 4'500'004, 1}}));
  EXPECT_EQ(data.search_uvs, (std::vector<Uv>{{0, 0}, {1, 0}, {0, 1}}));
  EXPECT_EQ(data.search_triangles, (std::vector<Triangle>{{0, 1, 2}}));
  EXPECT_EQ(scene.triangle_count(), 1u) << "the search area is never hit";
}

TEST(SearchArea, WithUvOnlyInPartIsTakenWithoutAny) {
  GlbBuilder builder;
  builder.triangle("part");
  builder.triangle("floor", {{"role", "search"}});
  const int points = builder.positions({0, 1, 0, 4, 1, 0, 0, 1, -4}),
            uv = builder.accessor(std::vector<float>{0, 0, 1, 0, 0, 1}, 5126, "VEC2");
  builder.node({{"extras", {{"vantage", {{"role", "search"}}}}},
                {"mesh", builder.mesh({{"attributes", {{"POSITION", points}, {"TEXCOORD_0", uv}}}})}});
  const Scene scene = load(builder);
  EXPECT_EQ(scene.data().search_triangles.size(), 2u);
  EXPECT_TRUE(scene.data().search_uvs.empty());
  ASSERT_EQ(scene.notes().size(), 1u);
  EXPECT_NE(scene.notes()[0].find("no (u, v)"), std::string::npos);
}

TEST(Defaults, AreHandedOnAsJson) {
  GlbBuilder builder;
  builder.triangle("part");
  EXPECT_EQ(load(builder).defaults_json(), "{}");
  builder.json["asset"]["extras"]["vantage"] = {{"spacing", 0.25}};
  EXPECT_EQ(json::parse(load(builder).defaults_json()), (json{{"spacing", 0.25}}));
}

// As importers describe the rooms of a building: metres, Y up.
TEST(Rooms, AreReadFromNodesThatHaveABox) {
  GlbBuilder builder;
  builder.triangle("part");
  EXPECT_TRUE(load(builder).rooms().empty());
  builder.node(
      {{"extras", {{"vantage", {{"name", "2.04"}, {"long_name", "Office"}, {"box", {{1, 0, -4}, {3, 2.5, -2}}}}}}}});
  builder.node({{"extras", {{"vantage", {{"long_name", "Hall"}, {"box", {{0, 0, 0}, {1, 1, 1}}}}}}}});
  const Scene scene = load(builder);
  ASSERT_EQ(scene.rooms().size(), 2u);
  EXPECT_EQ(scene.rooms()[0].name, "2.04 Office");
  EXPECT_EQ(scene.rooms()[0].box.min, (Vec3{1, 2, 0}));
  EXPECT_EQ(scene.rooms()[0].box.max, (Vec3{3, 4, 2.5}));
  EXPECT_EQ(scene.rooms()[1].name, "Hall");
  builder.node({{"extras", {{"vantage", {{"box", {{0, 0}, {1, 1, 1}}}}}}}});
  EXPECT_THROW(load(builder), Error);
}

}  // namespace
}  // namespace vantage
