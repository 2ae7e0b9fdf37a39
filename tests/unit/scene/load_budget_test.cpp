// SPDX-License-Identifier: Apache-2.0
// Loading checks memory before allocating it, and cuts names.
#include "scene/load_budget.hpp"

#include <gtest/gtest.h>

#include "image/encode.hpp"
#include "scene/scene_data.hpp"
#include "support/glb_builder.hpp"
#include "vantage/error.hpp"
#include "vantage/scene_builder.hpp"

namespace vantage {
namespace {

using nlohmann::json;
using test::GlbBuilder;

constexpr std::uint64_t kMebibyte = 1 << 20;

Scene load_within(const GlbBuilder& builder, std::uint64_t max_memory_bytes) {
  const std::string glb = builder.glb();
  return load_gltf({reinterpret_cast<const std::uint8_t*>(glb.data()), glb.size()},
                   {.max_memory_bytes = max_memory_bytes}, "scene");
}

// Expects one error with these words.
void refuses(const GlbBuilder& builder, std::uint64_t max_memory_bytes, std::initializer_list<const char*> words) {
  try {
    load_within(builder, max_memory_bytes);
    ADD_FAILURE() << "it was loaded";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), Errc::out_of_memory) << error.what();
    for (const char* word : words)
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << word << " in: " << error.what();
  }
}

// A triangle for each texture of these images.
GlbBuilder textured(const json& images, GlbBuilder builder = {}) {
  const int position = builder.positions({0, 0, 0, 1, 0, 0, 0, 1, 0});
  const int uv = builder.accessor(std::vector<float>{0, 0, 1, 0, 0, 1}, 5126, "VEC2");
  builder.json["images"] = images;
  for (std::size_t k = 0; k < images.size(); ++k) {
    builder.json["textures"].push_back({{"source", k}});
    builder.json["materials"].push_back({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", k}}}}}});
    builder.node(
        {{"translation", {0, 0, k}},
         {"mesh", builder.mesh({{"attributes", {{"POSITION", position}, {"TEXCOORD_0", uv}}}, {"material", k}})}});
  }
  return builder;
}

TEST(LoadBudget, CountsWhatIsKeptAndWhatIsGivenBack) {
  LoadBudget budget(100 * kMebibyte, "scene.glb");
  const std::uint64_t left = budget.left();
  EXPECT_LT(left, 100 * kMebibyte);
  budget.require(left, "all of it");
  EXPECT_EQ(budget.left(), left);
  budget.keep(kMebibyte, "a part");
  EXPECT_EQ(budget.left(), left - kMebibyte);
  EXPECT_THROW(budget.require(left, "all of it"), Error);
  EXPECT_THROW(budget.keep(~std::uint64_t{0}, "everything"), Error);
  EXPECT_EQ(budget.left(), left - kMebibyte);
}

TEST(LoadBudget, ABufferViewIsDecodedOnce) {
  GlbBuilder builder;
  const auto jpeg = encode_jpeg({64, 32, std::vector<std::uint8_t>(64 * 32 * 4, 200)}, 90);
  const json one{{"bufferView", builder.view(jpeg.data(), jpeg.size())}},
      other{{"bufferView", builder.view(jpeg.data(), jpeg.size())}};
  const Scene scene = load_within(textured(json::array({one, one, other, one}), builder), 0);
  EXPECT_EQ(scene.data().images.size(), 2u);
  std::vector<std::int32_t> used;
  for (const Material& material : scene.data().materials) used.push_back(material.image);
  EXPECT_EQ(used, (std::vector<std::int32_t>{0, 0, 1, 0}));
}

TEST(LoadBudget, PixelsAreCountedBeforeTheyAreDecoded) {
  GlbBuilder builder;
  const Image picture{2048, 2048, std::vector<std::uint8_t>(std::size_t{2048} * 2048 * 4, 100)};
  const auto jpeg = encode_jpeg(picture, 50);
  const json image{{"bufferView", builder.view(jpeg.data(), jpeg.size())}};
  const GlbBuilder scene = textured(json::array({image}), builder);
  EXPECT_EQ(load_within(scene, 100 * kMebibyte).data().images.size(), 1u);
  const Scene plain = load_within(scene, 60 * kMebibyte);
  EXPECT_TRUE(plain.data().images.empty());
  ASSERT_EQ(plain.notes().size(), 1u);
  for (const char* words : {"texture 0 cannot be read, its material keeps its plain colour and is opaque: ",
                            "scene: decoding texture 0, of 2048 × 2048 pixels,", "the limit is 60 MiB"})
    EXPECT_NE(plain.notes()[0].find(words), std::string::npos) << plain.notes()[0];
}

TEST(LoadBudget, TrianglesAreCountedTimesTheirInstances) {
  GlbBuilder builder;
  builder.triangle("triangle");
  const int places = builder.accessor(-1, std::size_t{1} << 16, 5126, "VEC3");
  builder.json["accessors"][static_cast<std::size_t>(places)].erase("bufferView");
  builder.node({{"mesh", 0},
                {"name", "many"},
                {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", {{"TRANSLATION", places}}}}}}}});
  refuses(builder, 30 * kMebibyte, {"many", "65536 instances"});
  refuses(builder, 40 * kMebibyte, {"65537 triangles on 196611 vertices"});
  EXPECT_EQ(load_within(builder, 100 * kMebibyte).triangle_count(), 1u) << "the others are duplicates";
}

TEST(LoadBudget, PrimitivesAreCountedTimesTheirNodes) {
  GlbBuilder builder;
  builder.triangle("triangle");
  const json primitive = builder.json["meshes"][0]["primitives"][0];
  for (int k = 0; k < 999; ++k) builder.json["meshes"][0]["primitives"].push_back(primitive);
  for (int k = 0; k < 999; ++k) builder.node({{"mesh", 0}});
  refuses(builder, 100 * kMebibyte, {"1000000 primitives placed by nodes"});
}

TEST(LoadBudget, ValuesOfTheJsonAreCounted) {
  GlbBuilder builder;
  builder.triangle("triangle");
  builder.json["extras"] = json::array();
  for (int k = 0; k < 1'000'000; ++k) builder.json["extras"].push_back(json::array());
  refuses(builder, 60 * kMebibyte, {"scene: the JSON"});
  builder.json["extras"] = 0;
  for (int k = 0; k < 100'000; ++k) builder.json["nodes"].push_back(json::object());
  refuses(builder, 100 * kMebibyte, {"100001 nodes"});
}

TEST(LoadBudget, LongNamesAreCutBetweenCharacters) {
  for (std::size_t before = 0; before < 4; ++before) {
    std::string name(before, 'x');
    while (name.size() < 1'000'000) name += "\u20ac";
    GlbBuilder builder;
    builder.triangle(name);
    const Scene scene = load_within(builder, 0);
    const std::string& cut = scene.meshes()[0].name;
    EXPECT_LE(cut.size(), 200u);
    EXPECT_GT(cut.size(), 190u);
    ASSERT_TRUE(cut.ends_with("…"));
    const std::string kept = cut.substr(0, cut.size() - std::string("…").size());
    EXPECT_TRUE(name.starts_with(kept));
    EXPECT_EQ((kept.size() - before) % 3, 0u);
  }
  GlbBuilder builder;
  builder.triangle(std::string(200, 'x'));
  EXPECT_EQ(load_within(builder, 0).meshes()[0].name, std::string(200, 'x'));
}

}  // namespace
}  // namespace vantage
