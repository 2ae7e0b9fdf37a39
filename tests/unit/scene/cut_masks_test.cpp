// SPDX-License-Identifier: Apache-2.0
#include "scene/cut_masks.hpp"

#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <string>

#include "support/glb_builder.hpp"
#include "support/temporary_folder.hpp"
#include "vantage/simulator.hpp"

namespace vantage {
namespace {

using nlohmann::json;

Image picture(std::uint32_t size, const std::function<double(double, double)>& alpha) {
  Image image{size, size, {}};
  for (std::uint32_t y = 0; y < size; ++y)
    for (std::uint32_t x = 0; x < size; ++x) {
      const double a = alpha((x + 0.5) / size, (y + 0.5) / size);
      for (const double value : {1.0, 1.0, 1.0, a})
        image.rgba.push_back(static_cast<std::uint8_t>(std::lround(255 * std::clamp(value, 0.0, 1.0))));
    }
  return image;
}

// A square of `side` metres in the plane z = 2 with the whole picture on it, of two triangles.
RawScene square(Image image, double side = 1) {
  RawScene raw;
  raw.positions = {{0, 0, 2}, {side, 0, 2}, {side, side, 2}, {0, side, 2}};
  raw.texcoords = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  raw.triangles = {{0, 1, 2}, {0, 2, 3}};
  raw.ranges = {{0, 2, 0}};
  raw.meshes = {{.name = "screen", .triangle_count = 2}};
  raw.materials = {Material{.image = 0}};
  raw.images = {std::move(image)};
  return raw;
}

glm::dvec3 twice_area(const RawScene& raw, const Triangle& t) {
  return cross(raw.positions[t[1]] - raw.positions[t[0]], raw.positions[t[2]] - raw.positions[t[0]]);
}

double area(const RawScene& raw) {
  double sum = 0;
  for (const Triangle& t : raw.triangles) sum += length(twice_area(raw, t)) / 2;
  return sum;
}

void cut(RawScene& raw, double cutoff, double texel_m = kMaskTexel_m, std::size_t most = kMostMaskTriangles) {
  cut_masks(raw, {cutoff}, LoadBudget(0, "test"), texel_m, most);
}

double smooth_disc(double u, double v) { return 0.5 + 20 * (0.3 - std::hypot(u - 0.5, v - 0.5)); }

TEST(CutMasks, ADiscKeepsItsAreaPlaceAndNormal) {
  for (const double texel : {0.004, 0.01, 0.02}) {
    RawScene raw = square(picture(256, smooth_disc));
    raw.normals.assign(4, {0, 0, 1});
    cut(raw, 0.5, texel);
    EXPECT_NEAR(area(raw), std::numbers::pi * 0.09, texel < 0.005 ? 2e-4 : 2e-3) << texel;
    ASSERT_EQ(raw.normals.size(), raw.positions.size());
    ASSERT_EQ(raw.texcoords.size(), raw.positions.size());
    for (const Triangle& t : raw.triangles) {
      EXPECT_GT(twice_area(raw, t).z, 0);
      for (const std::uint32_t v : t) {
        const glm::dvec3& p = raw.positions[v];
        EXPECT_LT(std::hypot(p.x - 0.5, p.y - 0.5), 0.3 + texel / 2);
        EXPECT_DOUBLE_EQ(p.z, 2);
        EXPECT_NEAR(static_cast<double>(raw.texcoords[v].x), p.x, 1e-6);
        EXPECT_EQ(raw.normals[v].z, 1.0f);
      }
    }
    ASSERT_EQ(raw.notes.size(), 1u);
    EXPECT_TRUE(raw.notes[0].starts_with("rays pass the holes of masked textures: 0.71")) << raw.notes[0];
    EXPECT_NE(raw.notes[0].find(" of 1 m² are empty"), std::string::npos) << raw.notes[0];
    EXPECT_EQ(raw.meshes[0].triangle_count, raw.triangles.size());
  }
}

// Whatever way the picture lies on the triangle, faces keep their side.
TEST(CutMasks, MirroredPicturesKeepTheFacesSide) {
  RawScene raw = square(picture(64, [](double u, double v) { return u + v < 0.6 ? 1.0 : 0.0; }));
  for (Float2& uv : raw.texcoords) uv.x = 1 - uv.x;
  cut(raw, 0.5, 0.02);
  EXPECT_NEAR(area(raw), 0.18, 0.01);
  for (const Triangle& t : raw.triangles) {
    EXPECT_GT(twice_area(raw, t).z, 0);
    for (const std::uint32_t v : t) EXPECT_LT(1 - raw.positions[v].x + raw.positions[v].y, 0.65);
  }
}

TEST(CutMasks, FilledAndEmptyTrianglesNeedNoTexels) {
  RawScene filled = square(picture(64, [](double, double) { return 0.6; }));
  cut(filled, 0.5);
  EXPECT_EQ(filled.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
  EXPECT_EQ(filled.positions.size(), 4u);
  RawScene empty = square(picture(64, [](double, double) { return 0.4; }));
  cut(empty, 0.5);
  EXPECT_TRUE(empty.triangles.empty());
  EXPECT_TRUE(empty.meshes.empty());
  RawScene faint = square(picture(64, [](double, double) { return 0.6; }));
  faint.materials[0].base_colour[3] = 0.8f;  // 0.48 together
  cut(faint, 0.5);
  EXPECT_TRUE(faint.triangles.empty());
  RawScene opaque = square(picture(64, smooth_disc));
  cut(opaque, 0);
  EXPECT_EQ(opaque.triangles.size(), 2u);
  EXPECT_TRUE(opaque.notes.empty());
}

TEST(CutMasks, VertexColoursCount) {
  RawScene raw = square(picture(64, [](double, double) { return 1.0; }));
  raw.colours = {0x00FFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0x00FFFFFF};  // alpha is x
  cut(raw, 0.25);
  EXPECT_NEAR(area(raw), 0.75, 1e-3);
  ASSERT_EQ(raw.colours.size(), raw.positions.size());
}

// Leaves finer than the texels that are cut: the share of the holes stays, whatever the size on the surface.
TEST(CutMasks, AveragesKeepTheShareOfHoles) {
  std::mt19937 rng(5);
  std::uniform_real_distribution<double> any(0, 1);
  const Image leaves = picture(512, [&](double, double) { return any(rng) < 0.3 ? 0.0 : 1.0; });
  RawScene full = square(leaves, 5);  // of the texture's own texels
  cut(full, 0.5);
  const double share = area(full) / 25;
  EXPECT_NEAR(share, 0.7, 0.05);
  for (const double side : {0.1, 0.5, 1.0, 2.0}) {
    RawScene raw = square(leaves, side);
    cut(raw, 0.5);
    EXPECT_NEAR(area(raw) / (side * side), share, side < 0.2 ? 0.05 : 0.01) << side;
  }
}

TEST(CutMasks, TooManyTrianglesMakeItCoarser) {
  RawScene fine = square(picture(256, smooth_disc)), coarse = square(picture(256, smooth_disc));
  cut(fine, 0.5, 0.004);
  cut(coarse, 0.5, 0.004, fine.triangles.size() / 2);
  EXPECT_LE(coarse.triangles.size(), fine.triangles.size() / 2);
  EXPECT_NEAR(area(coarse), std::numbers::pi * 0.09, 0.02);
  EXPECT_NE(coarse.notes.at(0).find("; finer ones would be too many"), std::string::npos);
  EXPECT_EQ(fine.notes.at(0).find("; finer ones"), std::string::npos);
}

TEST(CutMasks, ATextureThatRepeatsIsCutEverywhere) {
  RawScene raw = square(picture(64, [](double u, double) { return u < 0.5 ? 1.0 : 0.0; }), 4);
  for (Float2& uv : raw.texcoords) uv = {uv.x * 8 - 3, uv.y * 8 + 100};
  cut(raw, 0.5);
  EXPECT_NEAR(area(raw), 8, 0.1);
}

TEST(CutMasks, BrokenCoordinatesStayOpaque) {
  RawScene raw = square(picture(64, smooth_disc));
  raw.texcoords[0].x = std::numeric_limits<float>::quiet_NaN();
  raw.texcoords[3].x = 1e30f;
  cut(raw, 0.5);
  EXPECT_EQ(raw.triangles.size(), 2u);
}

std::vector<std::uint8_t> png(const Image& picture) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION, image.format = PNG_FORMAT_RGBA;
  image.width = picture.width, image.height = picture.height;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::vector<std::uint8_t> out(size);
  EXPECT_TRUE(png_image_write_to_memory(&image, out.data(), &size, 0, picture.rgba.data(), 0, nullptr));
  out.resize(size);
  return out;
}

// A wall 6 m behind a screen of leaves, both square on; the head stands 2 m before the screen.
TEST(CutMasks, AScreenOfLeavesLetsItsShareOfRaysThrough) {
  std::mt19937 rng(9);
  std::uniform_real_distribution<double> any(0, 1);
  // Holes of 4 × 4 texels.
  std::vector<std::uint8_t> hole(64 * 64);
  for (std::uint8_t& h : hole) h = any(rng) < 0.3;
  const Image leaves = picture(256, [&](double u, double v) {
    return hole[static_cast<std::size_t>(v * 64) * 64 + static_cast<std::size_t>(u * 64)] ? 0.0 : 1.0;
  });
  for (const char* mode : {"MASK", "BLEND"}) {
    test::GlbBuilder builder;
    const auto quad = [&](const char* name, float z, float half, json material) {
      const int points = builder.positions({-half, -half, z, half, -half, z, half, half, z, -half, half, z});
      const int uv = builder.accessor(std::vector<float>{0, 0, 1, 0, 1, 1, 0, 1}, 5126, "VEC2");
      const int indices = builder.accessor(std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3}, 5123, "SCALAR");
      json primitive = {{"attributes", {{"POSITION", points}, {"TEXCOORD_0", uv}}}, {"indices", indices}};
      if (!material.is_null()) primitive["material"] = material;
      builder.node({{"name", name}, {"mesh", builder.mesh(primitive)}});
    };
    const auto bytes = png(leaves);
    builder.json["images"] = {{{"bufferView", builder.view(bytes.data(), bytes.size())}, {"mimeType", "image/png"}}};
    builder.json["textures"] = {{{"source", 0}}};
    builder.json["materials"] = {
        {{"alphaMode", mode}, {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    quad("screen", -2, 1, 0);
    quad("wall", -8, 20, nullptr);
    const Scene scene = load(builder, {.surveyed = {"wall"}, .unit = Unit::metre, .up = UpAxis::y});
    Scanner scanner;
    scanner.azimuth_step = scanner.zenith_step = Angle::degrees(0.1);
    Simulator simulator(scene, scanner, {.engine = Engine::embree});
    std::uint64_t on_screen = 0, through = 0;
    const ScanPoints points = simulator.scan_points({Vec3{0, 0, 0}}, {.outputs = scan_position | scan_ids});
    for (std::size_t k = 0; k < points.position.size(); ++k) {
      const Vec3& p = points.position[k];  // Z up: the screen lies at y = 2, the wall at y = 8
      const double at_screen = 2 / p.y;
      if (std::abs(p.x * at_screen) > 0.99 || std::abs(p.z * at_screen) > 0.99 || p.y < 0) continue;
      ++on_screen;
      through += scene.meshes()[static_cast<std::size_t>(points.mesh[k])].name == "wall";
    }
    ASSERT_GT(on_screen, 100'000u);
    // Four standard errors of 4 096 independent holes.
    EXPECT_NEAR(static_cast<double>(through) / static_cast<double>(on_screen), 0.3, 4 * std::sqrt(0.3 * 0.7 / 4096))
        << mode;
  }
}

// Missing, of a format that is not read, and not there at all.
TEST(CutMasks, ATextureThatCannotBeReadIsToldAndLeavesItsSurfaceOpaque) {
  const std::string ktx = "\xABKTX 20\xBB\r\n\x1A\n and so on";
  for (const int which : {0, 1, 2}) {
    test::GlbBuilder builder;
    const int points = builder.positions({-1, -1, -2, 1, -1, -2, 0, 1, -2});
    const int uv = builder.accessor(std::vector<float>{0, 0, 1, 0, 1, 1}, 5126, "VEC2");
    if (which == 0) builder.json["images"] = {{{"uri", "leaves.png"}}};
    if (which == 1)
      builder.json["images"] = {{{"bufferView", builder.view(ktx.data(), ktx.size())}, {"mimeType", "image/ktx2"}}};
    json texture = {{"source", 0}};
    if (which == 1) texture = {{"extensions", {{"KHR_texture_basisu", {{"source", 0}}}}}};
    if (which < 2) builder.json["textures"] = json::array({texture});
    builder.json["materials"] = {
        {{"alphaMode", "MASK"}, {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    builder.node(
        {{"name", "screen"},
         {"mesh", builder.mesh({{"attributes", {{"POSITION", points}, {"TEXCOORD_0", uv}}}, {"material", 0}})}});
    const Scene scene = load(builder, {.unit = Unit::metre, .up = UpAxis::y});
    EXPECT_EQ(scene.triangle_count(), 1u) << which;
    EXPECT_EQ(std::ranges::count_if(scene.notes(),
                                    [](const std::string& note) {
                                      return note.starts_with("texture 0 ") &&
                                             note.find("is opaque") != std::string::npos;
                                    }),
              1)
        << which;
    for (const std::string& note : scene.notes()) EXPECT_EQ(note.find("holes"), std::string::npos) << note;
  }
}

}  // namespace
}  // namespace vantage
