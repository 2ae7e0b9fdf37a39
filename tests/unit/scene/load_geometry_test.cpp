// SPDX-License-Identifier: Apache-2.0
// Geometry in all ways that glTF can store it: every index width and mode, strides, sparse and quantized accessors,
// node trees and instances.
#include <gtest/gtest.h>

#include <cmath>

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

constexpr int kByte = 5120, kUnsignedByte = 5121, kShort = 5122, kUnsignedShort = 5123, kUnsignedInt = 5125;

// Corners of triangle t, survey frame.
std::array<Vec3, 3> corners(const Scene& scene, std::size_t t) {
  std::array<Vec3, 3> out;
  for (std::size_t c = 0; c < 3; ++c) {
    const Float3& p = scene.data().positions[scene.data().triangles[t][c]];
    out[c] = Vec3{p.x, p.y, p.z} + scene.data().origin;
  }
  return out;
}

Vec3 normal(const Scene& scene, std::size_t t) {
  const auto c = corners(scene, t);
  return cross(c[1] - c[0], c[2] - c[0]);
}

void expect_near(const Vec3& a, const Vec3& b, double tolerance = 1e-6) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

// Five points of a fan around the first, in the glTF xy plane.
const std::vector<float> kFan{0, 0, 0, 2, 0, 0, 2, 1, 0, 1, 2, 0, 0, 2, 0};

TEST(LoadGeometry, YUpBecomesZUp) {
  GlbBuilder builder;
  const int points = builder.positions({1, 2, 3, 4, 2, 3, 1, 7, 3});
  builder.node({{"name", "part"}, {"mesh", builder.mesh({{"attributes", {{"POSITION", points}}}})}});
  const Scene scene = load(builder);
  ASSERT_EQ(scene.triangle_count(), 1u);
  const auto c = corners(scene, 0);
  EXPECT_EQ(c[0], (Vec3{1, -3, 2}));
  EXPECT_EQ(c[1], (Vec3{4, -3, 2}));
  EXPECT_EQ(c[2], (Vec3{1, -3, 7}));
  EXPECT_EQ(scene.meshes()[0].name, "part");
  EXPECT_EQ(scene.meshes()[0].role, Role::surveyed);
  EXPECT_FALSE(scene.has_search_area());
  EXPECT_EQ(scene.bounds().min, (Vec3{1, -3, 2}));
  EXPECT_EQ(scene.bounds().max, (Vec3{4, -3, 7}));
}

TEST(LoadGeometry, IndicesOfEveryWidthGiveTheSameTriangles) {
  const std::vector<std::uint8_t> narrow{0, 1, 2, 0, 2, 3};
  std::vector<Scene> scenes;
  for (const int type : {kUnsignedByte, kUnsignedShort, kUnsignedInt}) {
    GlbBuilder builder;
    const int points = builder.positions(kFan);
    const int indices =
        type == kUnsignedByte ? builder.accessor(narrow, type, "SCALAR")
        : type == kUnsignedShort
            ? builder.accessor(std::vector<std::uint16_t>(narrow.begin(), narrow.end()), type, "SCALAR")
            : builder.accessor(std::vector<std::uint32_t>(narrow.begin(), narrow.end()), type, "SCALAR");
    builder.node({{"mesh", builder.mesh({{"attributes", {{"POSITION", points}}}, {"indices", indices}})}});
    scenes.push_back(load(builder));
  }
  for (const Scene& scene : scenes) {
    EXPECT_EQ(scene.data().triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
    EXPECT_EQ(scene.data().positions.size(), 4u) << "the unused fifth point goes";
    EXPECT_EQ(scene.data().positions, scenes[0].data().positions);
  }
}

TEST(LoadGeometry, WithoutIndicesEveryThreePointsAreATriangle) {
  GlbBuilder builder;
  const int points = builder.positions({0, 0, 0, 1, 0, 0, 0, 1, 0, 5, 0, 0, 6, 0, 0, 5, 1, 0, 9, 9, 9});
  builder.node({{"mesh", builder.mesh({{"attributes", {{"POSITION", points}}}})}});
  const Scene scene = load(builder);
  EXPECT_EQ(scene.data().triangles, (std::vector<Triangle>{{0, 1, 2}, {3, 4, 5}}));
  ASSERT_EQ(scene.notes().size(), 1u);
  EXPECT_NE(scene.notes()[0].find("left-over"), std::string::npos);
}

TEST(LoadGeometry, StripsAndFansKeepTheirWinding) {
  for (const bool indexed : {false, true}) {
    GlbBuilder builder;
    // a strip along x: all triangles must face glTF's +z
    const int strip = builder.positions({0, 0, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0, 2, 0, 0});
    const int fan = builder.positions({0, 5, 0, 2, 5, 0, 2, 6, 0, 1, 7, 0, 0, 7, 0});
    json strip_primitive{{"attributes", {{"POSITION", strip}}}, {"mode", 5}},
        fan_primitive{{"attributes", {{"POSITION", fan}}}, {"mode", 6}};
    if (indexed)
      for (json* primitive : {&strip_primitive, &fan_primitive})
        (*primitive)["indices"] = builder.accessor(std::vector<std::uint16_t>{0, 1, 2, 3, 4}, kUnsignedShort, "SCALAR");
    builder.node({{"mesh", builder.mesh(strip_primitive)}});
    builder.node({{"mesh", builder.mesh(fan_primitive)}});
    const Scene scene = load(builder);
    ASSERT_EQ(scene.triangle_count(), 6u);
    for (std::size_t t = 0; t < 3; ++t)
      EXPECT_GT(normal(scene, t).y, 0) << "strip triangle " << t;  // (0,1,2): clockwise seen from glTF +z
    for (std::size_t t = 3; t < 6; ++t) EXPECT_LT(normal(scene, t).y, 0) << "fan triangle " << t;
  }
}

TEST(LoadGeometry, StripsTurnOnRepeatedIndicesWithoutANote) {
  GlbBuilder builder;
  const int points = builder.positions({0, 0, 0, 0, 1, 0, 1, 0, 0, 5, 0, 0, 5, 1, 0, 6, 0, 0});
  const int indices = builder.accessor(std::vector<std::uint16_t>{0, 1, 2, 2, 3, 3, 4, 5}, kUnsignedShort, "SCALAR");
  builder.node({{"mesh", builder.mesh({{"attributes", {{"POSITION", points}}}, {"indices", indices}, {"mode", 5}})}});
  const Scene scene = load(builder);
  EXPECT_EQ(scene.triangle_count(), 2u);
  EXPECT_TRUE(scene.notes().empty());
}

TEST(LoadGeometry, PointsAndLinesAreIgnoredWithANote) {
  GlbBuilder builder;
  builder.triangle("part");
  const int points = builder.positions(kFan);
  for (const int mode : {0, 1, 2, 3})
    builder.node({{"mesh", builder.mesh({{"attributes", {{"POSITION", points}}}, {"mode", mode}})}});
  builder.node({{"mesh", builder.mesh({{"attributes", {{"TEXCOORD_0", points}}}})}});
  const Scene scene = load(builder);
  EXPECT_EQ(scene.triangle_count(), 1u);
  ASSERT_EQ(scene.notes().size(), 2u);
  EXPECT_EQ(scene.notes()[0].find("4 primitives of points or lines"), 0u);
  EXPECT_EQ(scene.notes()[1].find("1 primitives without positions"), 0u);
}

TEST(LoadGeometry, InterleavedAttributes) {
  GlbBuilder builder;
  // position, normal and 4 bytes of padding per vertex
  std::vector<float> vertices;
  for (const auto& p : {std::array{0.F, 0.F, 0.F}, {3.F, 0.F, 0.F}, {0.F, 3.F, 0.F}}) {
    vertices.insert(vertices.end(), p.begin(), p.end());
    vertices.insert(vertices.end(), {0, 0, 2, -99});
  }
  const int view = builder.view(vertices.data(), vertices.size() * 4, 28);
  const int points = builder.accessor(view, 3, 5126, "VEC3"),
            normals = builder.accessor(view, 3, 5126, "VEC3", false, 12);
  builder.node({{"mesh", builder.mesh({{"attributes", {{"POSITION", points}, {"NORMAL", normals}}}})}});
  const Scene scene = load(builder);
  EXPECT_EQ(corners(scene, 0)[1], (Vec3{3, 0, 0}));
  EXPECT_EQ(corners(scene, 0)[2], (Vec3{0, 0, 3}));
  EXPECT_EQ(scene.data().normals, (std::vector<Float3>(3, {0, -1, 0})));
}

TEST(LoadGeometry, SparseAccessorsReplaceOrFill) {
  for (const bool with_base : {true, false}) {
    GlbBuilder builder;
    const int base = with_base ? builder.positions({0, 0, 0, 1, 0, 0, 9, 9, 9}) : builder.accessor(-1, 3, 5126, "VEC3");
    const std::vector<std::uint16_t> places =
        with_base ? std::vector<std::uint16_t>{2} : std::vector<std::uint16_t>{1, 2};
    const std::vector<float> values = with_base ? std::vector<float>{0, 4, 0} : std::vector<float>{1, 0, 0, 0, 4, 0};
    const int index_view = builder.view(places.data(), places.size() * 2),
              value_view = builder.view(values.data(), values.size() * 4);
    builder.json["accessors"][static_cast<std::size_t>(base)]["sparse"] = {
        {"count", places.size()},
        {"indices", {{"bufferView", index_view}, {"componentType", kUnsignedShort}}},
        {"values", {{"bufferView", value_view}}}};
    builder.node({{"mesh", builder.mesh({{"attributes", {{"POSITION", base}}}})}});
    const Scene scene = load(builder);
    EXPECT_EQ(corners(scene, 0)[0], (Vec3{0, 0, 0}));
    EXPECT_EQ(corners(scene, 0)[1], (Vec3{1, 0, 0}));
    EXPECT_EQ(corners(scene, 0)[2], (Vec3{0, 0, 4}));
  }
}

TEST(LoadGeometry, QuantizedAttributes) {
  GlbBuilder builder;
  builder.json["extensionsUsed"] = builder.json["extensionsRequired"] = {"KHR_mesh_quantization"};
  const int plain =
      builder.accessor(std::vector<std::uint16_t>{0, 0, 0, 1000, 0, 0, 0, 500, 0}, kUnsignedShort, "VEC3");
  const int scaled =
      builder.accessor(std::vector<std::int16_t>{0, 0, 0, 32767, 0, 0, 0, -32768, 0}, kShort, "VEC3", true);
  const int bytes = builder.accessor(
      builder.view(std::vector<std::int8_t>{-127, 0, 0, 99, 127, 0, 0, 99, 0, 127, 0, 99}.data(), 12, 4), 3, kByte,
      "VEC3", true);
  const int normals =
      builder.accessor(builder.view(std::vector<std::int8_t>{0, 0, 127, 0, 0, 0, 127, 0, 0, 0, 127, 0}.data(), 12, 4),
                       3, kByte, "VEC3", true);
  builder.node({{"scale", {0.01, 0.01, 0.01}},
                {"mesh", builder.mesh({{"attributes", {{"POSITION", plain}, {"NORMAL", normals}}}})}});
  builder.node({{"mesh", builder.mesh({{"attributes", {{"POSITION", scaled}, {"NORMAL", normals}}}})}});
  builder.node({{"translation", {0, 0, 5}}, {"mesh", builder.mesh({{"attributes", {{"POSITION", bytes}}}})}});
  const Scene scene = load(builder);
  expect_near(corners(scene, 0)[1], {10, 0, 0});
  expect_near(corners(scene, 0)[2], {0, 0, 5});
  expect_near(corners(scene, 1)[1], {1, 0, 0});
  expect_near(corners(scene, 1)[2], {0, 0, -1});
  expect_near(corners(scene, 2)[0], {-1, -5, 0});
  EXPECT_EQ(scene.data().normals[0], (Float3{0, -1, 0}));
  EXPECT_EQ(scene.data().normals[8], (Float3{0, 0, 0})) << "a mesh without normals beside one that has them";
}

TEST(LoadGeometry, GpuInstancesStandWhereTheirAttributesSay) {
  GlbBuilder builder;
  builder.json["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
  const int node = builder.triangle("bolts");
  const int places = builder.positions({0, 0, 0, 10, 0, 0, 0, 0, 20});
  const int turns = builder.accessor(std::vector<std::int16_t>{0, 0, 0, 32767, 0, 0, 23170, 23170, 0, 0, 0, 32767},
                                     kShort, "VEC4", true);
  const int scales = builder.positions({1, 1, 1, 1, 1, 1, 2, 2, 2});
  auto& entry = builder.json["nodes"][static_cast<std::size_t>(node)];
  entry["translation"] = {0, 100, 0};
  entry["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
      {"TRANSLATION", places}, {"ROTATION", turns}, {"SCALE", scales}};
  const Scene scene = load(builder);
  ASSERT_EQ(scene.triangle_count(), 3u);
  ASSERT_EQ(scene.meshes().size(), 1u);
  EXPECT_EQ(scene.meshes()[0].triangle_count, 3u);
  expect_near(corners(scene, 0)[1], {1, 0, 100}, 1e-4);
  expect_near(corners(scene, 1)[1], {10, 0, 101}, 1e-4);  // turned by 90° about glTF z: x becomes up
  expect_near(corners(scene, 1)[2], {9, 0, 100}, 1e-4);
  expect_near(corners(scene, 2)[1], {2, -20, 100}, 1e-4);
}

TEST(LoadGeometry, MatricesAndTrsComposeAlike) {
  const double a = 0.3;
  GlbBuilder matrix, trs;
  for (GlbBuilder* builder : {&matrix, &trs}) {
    const int child = builder->triangle("part");
    builder->json["scenes"][0]["nodes"] = json::array();
    builder->json["nodes"][static_cast<std::size_t>(child)].erase("translation");
    builder->json["nodes"][static_cast<std::size_t>(child)]["scale"] = {1, 3, 1};
    const int root = builder->node({{"children", {child}}});
    auto& node = builder->json["nodes"][static_cast<std::size_t>(root)];
    if (builder == &matrix) {
      node["matrix"] = {
          2 * std::cos(a), 2 * std::sin(a), 0, 0, -2 * std::sin(a), 2 * std::cos(a), 0, 0, 0, 0, 2, 0, 5, 6, 7, 1};
    } else {
      node["translation"] = {5, 6, 7};
      node["rotation"] = {0, 0, std::sin(a / 2), std::cos(a / 2)};
      node["scale"] = {2, 2, 2};
    }
  }
  const Scene first = load(matrix), second = load(trs);
  for (std::size_t c = 0; c < 3; ++c) expect_near(corners(first, 0)[c], corners(second, 0)[c], 1e-5);
  expect_near(corners(first, 0)[1], {5 + 2 * std::cos(a), -7, 6 + 2 * std::sin(a)}, 1e-5);
  expect_near(corners(first, 0)[2], {5 - 6 * std::sin(a), -7, 6 + 6 * std::cos(a)}, 1e-5);
}

TEST(LoadGeometry, NegativeScalesKeepNormalsOutward) {
  GlbBuilder builder;
  const int points = builder.positions({0, 0, 0, 1, 0, 0, 0, 1, 0}),
            normals = builder.positions({0, 0, 1, 0, 0, 1, 0, 0, 1});
  const int mesh = builder.mesh({{"attributes", {{"POSITION", points}, {"NORMAL", normals}}}});
  builder.node({{"mesh", mesh}});
  builder.node({{"mesh", mesh}, {"scale", {-2, 1, 1}}, {"translation", {10, 0, 0}}});
  builder.node({{"mesh", mesh}, {"scale", {1, 1, -3}}, {"translation", {20, 0, 0}}});
  const Scene scene = load(builder);
  const double expected_y[3] = {-1, -1, 1};  // the third is mirrored along its own normal
  for (std::size_t t = 0; t < 3; ++t) {
    const Float3& n = scene.data().normals[scene.data().triangles[t][0]];
    EXPECT_NEAR(n.y, expected_y[t], 1e-6);
    EXPECT_GT(normal(scene, t).y * expected_y[t], 0) << "winding and normal must agree for instance " << t;
  }
  ASSERT_EQ(scene.notes().size(), 1u);
  EXPECT_EQ(scene.notes()[0].find("2 meshes are mirrored"), 0u);
}

TEST(LoadGeometry, NormalsGoThroughTheInverseTranspose) {
  GlbBuilder builder;
  // a plane x + y = 1 of glTF, squeezed along y: its normal tilts towards y
  const int points = builder.positions({1, 0, 0, 0, 1, 0, 1, 0, 1}),
            normals = builder.positions({1, 1, 0, 1, 1, 0, 1, 1, 0});
  builder.node(
      {{"scale", {1, 0.25, 1}}, {"mesh", builder.mesh({{"attributes", {{"POSITION", points}, {"NORMAL", normals}}}})}});
  const Scene scene = load(builder);
  const Float3& n = scene.data().normals[0];
  EXPECT_NEAR(n.x, 1 / std::sqrt(17.0), 1e-6);
  EXPECT_NEAR(n.z, 4 / std::sqrt(17.0), 1e-6);
  const Vec3 g = normal(scene, 0);
  EXPECT_NEAR(std::abs(g.x * static_cast<double>(n.z) - g.z * static_cast<double>(n.x)), 0, 1e-6)
      << "parallel to the geometric normal";
}

TEST(LoadGeometry, ScenesAreChosen) {
  GlbBuilder builder;
  builder.triangle("first");
  builder.triangle("second");
  builder.json["scenes"] = {{{"nodes", {0}}}, {{"nodes", {1}}}};
  builder.json["scene"] = 1;
  EXPECT_EQ(load(builder).meshes()[0].name, "second");
  SceneOptions options;
  options.scene_index = 0;
  EXPECT_EQ(load(builder, options).meshes()[0].name, "first");
  builder.json.erase("scene");
  EXPECT_EQ(load(builder).meshes()[0].name, "first");
  builder.json.erase("scenes");
  EXPECT_EQ(load(builder).meshes().size(), 2u) << "without scenes, all roots";
  options.scene_index = 2;
  EXPECT_THROW(load(builder, options), Error);
}

TEST(LoadGeometry, HiddenNodesAreLeftOutWithTheirChildren) {
  GlbBuilder builder;
  builder.triangle("seen");
  const int hidden = builder.triangle("hidden");
  builder.json["nodes"][static_cast<std::size_t>(hidden)]["extensions"]["KHR_node_visibility"]["visible"] = false;
  builder.child(hidden, {{"name", "below"}, {"mesh", 0}, {"translation", {5, 0, 0}}});
  builder.json["extensionsRequired"] = {"KHR_node_visibility"};
  const Scene scene = load(builder);
  ASSERT_EQ(scene.meshes().size(), 1u);
  EXPECT_EQ(scene.meshes()[0].name, "seen");
  EXPECT_EQ(std::ranges::count(scene.notes(), "1 nodes are hidden by the file, and are left out with all below them"),
            1);
}

// 3D Tiles put the centre of a tile into an extension, or into a table before the GLB; Z is up in it.
TEST(LoadGeometry, TilesStandAroundTheirCentre) {
  constexpr double kX = 1'215'000.25, kY = -4'736'000.5, kZ = 4'081'000.125;
  GlbBuilder builder;
  builder.node(
      {{"mesh", builder.mesh({{"attributes", {{"POSITION", builder.positions({1, 2, 3, 4, 2, 3, 1, 7, 3})}}}})}});
  GlbBuilder extended = builder;
  extended.json["extensions"]["CESIUM_RTC"]["center"] = {kX, kY, kZ};
  extended.json["extensionsUsed"] = extended.json["extensionsRequired"] = {"CESIUM_RTC"};
  const SceneOptions as_glTF{.unit = Unit::metre, .up = UpAxis::y};
  const Scene scene = load(extended, as_glTF);
  expect_near(corners(scene, 0)[0], {kX + 1, kY - 3, kZ + 2});

  const std::string glb = builder.glb();
  const std::string features = R"({"BATCH_LENGTH":0,"RTC_CENTER":[1215000.25,-4736000.5,4081000.125]}  )";
  std::string tile = "b3dm";
  const auto word = [&](std::size_t value) {
    for (int i = 0; i < 4; ++i) tile += static_cast<char>(value >> (8 * i) & 0xFF);
  };
  for (const std::size_t value : {std::size_t{1}, 28 + features.size() + glb.size(), features.size(), std::size_t{0},
                                  std::size_t{0}, std::size_t{0}})
    word(value);
  tile += features + glb;
  const test::TemporaryFolder folder;
  test::write_bytes(folder / "tile.b3dm", tile);
  EXPECT_EQ(Scene::load(folder / "tile.b3dm", as_glTF).fingerprint(), scene.fingerprint());
  test::write_bytes(folder / "cut.b3dm", tile.substr(0, 40));
  EXPECT_THROW(Scene::load(folder / "cut.b3dm"), Error);
  extended.json["extensions"]["CESIUM_RTC"]["center"] = {kX, kY};
  EXPECT_THROW(load(extended), Error);
}

TEST(LoadGeometry, DataUrisMayHaveParametersAndBuffersMayBeEmpty) {
  GlbBuilder builder;
  builder.triangle("part");
  const Scene scene = load(builder);
  const std::string data = test::base64(builder.binary);
  for (const char* type : {"application/octet-stream", "application/gltf-buffer;charset=utf-8", "model/part;x=1"}) {
    json document = builder.json;
    document["buffers"] = {
        {{"byteLength", builder.binary.size()}, {"uri", std::string("data:") + type + ";base64," + data}},
        {{"byteLength", 0}, {"uri", "data:application/octet-stream;base64,"}},
        {{"byteLength", 0}}};
    const test::TemporaryFolder folder;
    test::write_bytes(folder / "scene.gltf", document.dump());
    EXPECT_EQ(Scene::load(folder / "scene.gltf").fingerprint(), scene.fingerprint()) << type;
  }
}

TEST(LoadGeometry, DeepNodeChainsDoNotOverflowTheStack) {
  GlbBuilder builder;
  int parent = builder.node({{"name", "root"}});
  for (int i = 0; i < 20'000; ++i) parent = builder.child(parent, {{"translation", {0.001, 0, 0}}});
  const int mesh = builder.mesh({{"attributes", {{"POSITION", builder.positions({0, 0, 0, 1, 0, 0, 0, 1, 0})}}}});
  builder.json["nodes"][static_cast<std::size_t>(parent)]["mesh"] = mesh;
  expect_near(corners(load(builder), 0)[0], {20, 0, 0}, 1e-5);
}

TEST(LoadGeometry, AShiftedSceneHasTheSameLocalCoordinates) {
  // irregular points within 40 m around 0
  std::vector<float> xyz;
  for (int i = 0; i < 300; ++i)
    xyz.insert(xyz.end(), {20 * std::sin(1.7F * static_cast<float>(i)), 4 * std::sin(2.3F * static_cast<float>(i)),
                           20 * std::cos(0.9F * static_cast<float>(i))});
  const auto make = [&](const Vec3& shift) {
    GlbBuilder builder;
    builder.node({{"translation", {shift.x, shift.y, shift.z}},
                  {"mesh", builder.mesh({{"attributes", {{"POSITION", builder.positions(xyz)}}}})}});
    return load(builder);
  };
  const Scene plain = make({0, 0, 0});
  EXPECT_EQ(plain.data().origin, (Vec3{0, 0, 0}));
  for (const Vec3& shift : {Vec3{1000, 0, 0}, Vec3{100'000, 300, -100'000}, Vec3{500'000, 0, -4'500'000}}) {
    const Scene moved = make(shift);
    EXPECT_EQ(moved.data().origin, (Vec3{shift.x, -shift.z, shift.y}));
    ASSERT_EQ(moved.data().positions.size(), plain.data().positions.size());
    double largest = 0;
    for (std::size_t v = 0; v < plain.data().positions.size(); ++v) {
      const Float3 &a = plain.data().positions[v], &b = moved.data().positions[v];
      largest = std::max({largest, std::abs(static_cast<double>(a.x - b.x)), std::abs(static_cast<double>(a.y - b.y)),
                          std::abs(static_cast<double>(a.z - b.z))});
    }
    EXPECT_LE(largest, 2e-6) << "one float step at 20 m";
    EXPECT_EQ(moved.triangle_count(), plain.triangle_count());
    EXPECT_NEAR(moved.bounds().min.y, plain.bounds().min.y - shift.z, 1e-8);
    EXPECT_TRUE(moved.notes().empty()) << moved.notes()[0];
  }
}

TEST(LoadGeometry, ScalesFromMillimetresToKilometres) {
  for (const double scale : {0.001, 1000.0}) {
    GlbBuilder builder;
    builder.node({{"scale", {scale, scale, scale}},
                  {"mesh", builder.mesh({{"attributes", {{"POSITION", builder.positions(kFan)}}}, {"mode", 6}})}});
    const Scene scene = load(builder);
    EXPECT_EQ(scene.triangle_count(), 3u);
    EXPECT_EQ(scene.data().origin, (Vec3{0, 0, 0}));
    EXPECT_NEAR(scene.bounds().size().x, 2 * scale, 1e-6 * scale);
    EXPECT_TRUE(scene.notes().empty());
  }
}

TEST(LoadGeometry, CoordinatesBakedIntoFloatsAreNamedWithTheirLoss) {
  GlbBuilder builder;
  builder.node({{"mesh", builder.mesh({{"attributes",
                                        {{"POSITION", builder.positions({500'000, 10, -4'500'000, 500'010, 10,
                                                                         -4'500'000, 500'000, 20, -4'500'000})}}}})}});
  const Scene scene = load(builder);
  ASSERT_EQ(scene.notes().size(), 1u);
  EXPECT_NE(scene.notes()[0].find("only to 0.5 m"), std::string::npos) << scene.notes()[0];
  EXPECT_EQ(corners(scene, 0)[1], (Vec3{500'010, 4'500'000, 10}));
}

TEST(LoadGeometry, ATwentyThousandTriangleFileOfManyNodesKeepsTheirOrder) {
  GlbBuilder builder;
  const int mesh = builder.mesh({{"attributes", {{"POSITION", builder.positions(kFan)}}}, {"mode", 6}});
  for (int i = 0; i < 2000; ++i)
    builder.node({{"name", "n" + std::to_string(i)}, {"mesh", mesh}, {"translation", {3 * i, 0, 0}}});
  const Scene scene = load(builder);
  ASSERT_EQ(scene.meshes().size(), 2000u);
  EXPECT_EQ(scene.triangle_count(), 6000u);
  for (const std::uint32_t t : {0u, 2u, 3u, 2999u, 5999u}) EXPECT_EQ(scene.data().mesh_of(t), t / 3);
  EXPECT_EQ(scene.meshes()[1999].name, "n1999");
}

// Two strips, or fans, that a restart index parts.
TEST(LoadGeometry, RestartIndicesBeginAnotherStripOrFan) {
  for (const char* extension : {"KHR_mesh_primitive_restart", "EXT_mesh_primitive_restart"})
    for (const int mode : {5, 6})
      for (const int type : {kUnsignedByte, kUnsignedShort, kUnsignedInt}) {
        GlbBuilder builder;
        const int points = builder.positions({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0, 1, 2, 0});
        const std::vector<std::uint32_t> wide{0, 1, 2, 0xFFFFFFFF, 2, 3, 4};
        const std::vector<std::uint16_t> middle(wide.begin(), wide.end());
        const std::vector<std::uint8_t> narrow(wide.begin(), wide.end());
        const int indices = type == kUnsignedByte    ? builder.accessor(narrow, type, "SCALAR")
                            : type == kUnsignedShort ? builder.accessor(middle, type, "SCALAR")
                                                     : builder.accessor(wide, type, "SCALAR");
        builder.node(
            {{"mesh", builder.mesh({{"attributes", {{"POSITION", points}}}, {"indices", indices}, {"mode", mode}})}});
        EXPECT_THROW(load(builder), Error);  // glTF itself has no restarts
        builder.json["extensionsUsed"] = builder.json["extensionsRequired"] = {extension};
        const Scene scene = load(builder);
        ASSERT_EQ(scene.triangle_count(), 2u);
        for (std::uint32_t t = 0; t < 2; ++t) EXPECT_NEAR(normal(scene, t).y, -1, 1e-6);
      }
}

TEST(LoadGeometry, PositionsMayBeDoubles) {
  GlbBuilder builder;
  const std::vector<double> points{500'000.123, 10, -4'500'000.456, 500'010, 10, -4'500'000, 500'000, 20, -4'500'000};
  builder.node({{"mesh", builder.mesh({{"attributes", {{"POSITION", builder.accessor(points, 5130, "VEC3")}}}})}});
  builder.json["extensionsUsed"] = builder.json["extensionsRequired"] = {"KHR_accessor_float64"};
  const Scene scene = load(builder, {.unit = Unit::metre, .up = UpAxis::y});
  expect_near(corners(scene, 0)[0], {500'000.123, 4'500'000.456, 10});
  EXPECT_TRUE(scene.notes().empty());
}

// Levels may be roots of the scene, too, and a level may be all that a scene shows.
TEST(LoadGeometry, CoarserLevelsOfDetailAreLeftOut) {
  GlbBuilder builder;
  const int fine = builder.triangle("fine"), coarse = builder.triangle("coarse"), coarser = builder.triangle("coarser");
  builder.json["nodes"][static_cast<std::size_t>(fine)]["extensions"]["MSFT_lod"]["ids"] = {coarse, coarser};
  builder.json["extensionsUsed"] = builder.json["extensionsRequired"] = {"MSFT_lod"};
  const Scene scene = load(builder);
  ASSERT_EQ(scene.meshes().size(), 1u);
  EXPECT_EQ(scene.meshes()[0].name, "fine");
  ASSERT_FALSE(scene.notes().empty());
  EXPECT_EQ(scene.notes()[0], "2 nodes are coarser levels of detail of others, and are left out");
  builder.json["scenes"][0]["nodes"] = {coarse};
  EXPECT_EQ(load(builder).meshes()[0].name, "coarse");
}

}  // namespace
}  // namespace vantage
