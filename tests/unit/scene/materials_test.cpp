// SPDX-License-Identifier: Apache-2.0
// Colours of points: base colour, texture, vertex colours.
#include <gtest/gtest.h>
#include <png.h>

#include <cmath>
#include <numbers>

#include "scene/scene_data.hpp"
#include "support/glb_builder.hpp"
#include "support/temporary_folder.hpp"
#include "vantage/scene.hpp"

namespace vantage {
namespace {

using nlohmann::json;
using test::GlbBuilder;

const std::vector<std::uint8_t> kPixels{255, 0, 0,   0, 255, 0,
                                        0,   0, 255, 9, 8,   7};  // 2 × 2 RGB, row by row from the top
const std::vector<std::uint8_t> kRgba{255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 9, 8, 7, 255};

std::vector<std::uint8_t> png() {
  png_image image{};
  image.version = PNG_IMAGE_VERSION, image.format = PNG_FORMAT_RGB;
  image.width = image.height = 2;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::vector<std::uint8_t> out(size);
  EXPECT_TRUE(png_image_write_to_memory(&image, out.data(), &size, 0, kPixels.data(), 0, nullptr)) << image.message;
  out.resize(size);
  return out;
}

// A textured triangle with TEXCOORD_0 and _1.
GlbBuilder textured() {
  GlbBuilder builder;
  const int points = builder.positions({0, 0, 0, 1, 0, 0, 0, 1, 0});
  const int uv = builder.accessor(std::vector<float>{0, 0, 1, 0, 0, 1}, 5126, "VEC2");
  const int other = builder.accessor(std::vector<std::uint16_t>{65535, 0, 0, 65535, 0, 0}, 5123, "VEC2", true);
  builder.json["textures"] = {{{"source", 0}}};
  builder.json["materials"] = {
      {{"pbrMetallicRoughness", {{"baseColorFactor", {0.25, 0.5, 1, 1}}, {"baseColorTexture", {{"index", 0}}}}}}};
  builder.node(
      {{"mesh", builder.mesh({{"attributes", {{"POSITION", points}, {"TEXCOORD_0", uv}, {"TEXCOORD_1", other}}},
                              {"material", 0}})}});
  return builder;
}

Scene load_with_picture(const GlbBuilder& builder) {
  const test::TemporaryFolder folder;
  const auto bytes = png();
  test::write_bytes(folder / "with space.png", {bytes.begin(), bytes.end()});
  builder.write_glb(folder / "scene.glb");
  return Scene::load(folder / "scene.glb");
}

const Material& material(const Scene& scene) { return scene.data().materials[scene.data().ranges[0].material]; }

TEST(Materials, TexturesFromABufferADataUriAndAFile) {
  std::vector<json> images;
  GlbBuilder embedded = textured();
  const auto bytes = png();
  images.push_back({{"bufferView", embedded.view(bytes.data(), bytes.size())}, {"mimeType", "image/png"}});
  images.push_back({{"uri", "data:image/png;base64," + test::base64(bytes)}});
  images.push_back({{"uri", "with%20space.png"}});
  for (const json& image : images) {
    GlbBuilder builder = embedded;
    builder.json["images"] = {image};
    const Scene scene = load_with_picture(builder);
    ASSERT_EQ(scene.data().images.size(), 1u) << image;
    EXPECT_EQ(material(scene).image, 0);
    EXPECT_EQ(scene.data().images[0].width, 2u);
    EXPECT_EQ(scene.data().images[0].rgba, kRgba);
    EXPECT_EQ(scene.data().texcoords, (std::vector<Float2>{{0, 0}, {1, 0}, {0, 1}}));
    EXPECT_EQ(material(scene).base_colour, (std::array<float, 4>{0.25F, 0.5F, 1, 1}));
    EXPECT_EQ(scene.meshes()[0].diffuse, 0.5) << "the factor only tints a texture, so it gives no luminance";
    EXPECT_TRUE(scene.notes().empty());
  }
}

TEST(Materials, ATextureThatCannotBeReadCostsOnlyColour) {
  for (const json& image : {json{{"uri", "absent.png"}}, json{{"uri", "data:image/png;base64,AAAA"}},
                            json{{"bufferView", 99}}, json{{"name", "nothing"}}}) {
    GlbBuilder builder = textured();
    builder.json["images"] = {image};
    const Scene scene = load_with_picture(builder);
    EXPECT_EQ(material(scene).image, -1);
    EXPECT_EQ(material(scene).base_colour[0], 0.25F);
    ASSERT_EQ(scene.notes().size(), 1u) << image;
    EXPECT_NE(scene.notes()[0].find("texture 0"), std::string::npos);
  }
}

TEST(Materials, TextureSetTransformAndWrapping) {
  GlbBuilder builder = textured();
  builder.json["images"] = {{{"uri", "with%20space.png"}}};
  builder.json["samplers"] = {{{"wrapS", 33071}}};
  builder.json["textures"][0]["sampler"] = 0;
  auto& texture = builder.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"];
  texture["texCoord"] = 1;
  const Scene second_set = load_with_picture(builder);
  EXPECT_EQ(second_set.data().texcoords, (std::vector<Float2>{{1, 0}, {0, 1}, {0, 0}}));
  EXPECT_FALSE(material(second_set).repeat_u);
  EXPECT_TRUE(material(second_set).repeat_v);
  // The lower left quadrant of the image, turned clockwise by 90°: the example of the extension's text.
  texture["extensions"]["KHR_texture_transform"] = {
      {"offset", {0, 1}}, {"rotation", std::numbers::pi / 2}, {"scale", {0.5, 0.5}}, {"texCoord", 0}};
  const Scene transformed = load_with_picture(builder);
  const std::vector<Float2> expected{{0, 1}, {0, 0.5F}, {0.5F, 1}};
  for (std::size_t v = 0; v < 3; ++v) {
    EXPECT_NEAR(transformed.data().texcoords[v].x, expected[v].x, 1e-6);
    EXPECT_NEAR(transformed.data().texcoords[v].y, expected[v].y, 1e-6);
  }
}

TEST(Materials, VertexColoursOfEveryType) {
  const auto with_colours = [](GlbBuilder& builder, int accessor) {
    builder.triangle("plain");
    builder.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = accessor;
    builder.triangle("without");
    return load_with_picture(builder).data().colours;
  };
  GlbBuilder floats, bytes, shorts;
  const auto from_floats =
      with_colours(floats, floats.accessor(std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 2}, 5126, "VEC3"));
  EXPECT_EQ(from_floats,
            (std::vector<std::uint32_t>{0xFF0000FF, 0xFF00FF00, 0xFFFF0000, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF}));
  const auto from_bytes = with_colours(
      bytes, bytes.accessor(std::vector<std::uint8_t>{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}, 5121, "VEC4", true));
  EXPECT_EQ(from_bytes[0], 0x04030201u);
  EXPECT_EQ(from_bytes[2], 0x0C0B0A09u);
  const auto from_shorts = with_colours(
      shorts,
      shorts.accessor(std::vector<std::uint16_t>{0, 65535, 257, 0, 0, 0, 0, 0, 0, 0, 0, 0}, 5123, "VEC4", true));
  EXPECT_EQ(from_shorts[0], 0x0001FF00u);
}

}  // namespace
}  // namespace vantage
