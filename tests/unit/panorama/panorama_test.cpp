// SPDX-License-Identifier: Apache-2.0
#include "vantage/panorama.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/quad_scene.hpp"
#include "support/temporary_folder.hpp"
#include "vantage/error.hpp"
#include "vantage/simulator.hpp"

namespace vantage {
namespace {

// Red counts columns, green rows; blue marks the first column.
Image counting_image(std::uint32_t width, std::uint32_t height) {
  Image image{width, height, std::vector<std::uint8_t>(std::size_t{4} * width * height, 255)};
  for (std::uint32_t y = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x) {
      std::uint8_t* p = image.rgba.data() + (std::size_t{y} * width + x) * 4;
      p[0] = static_cast<std::uint8_t>(x);
      p[1] = static_cast<std::uint8_t>(y);
      if (x > 0) p[2] = 0;
    }
  }
  return image;
}

std::array<int, 4> pixel(const Image& image, std::uint32_t x, std::uint32_t y) {
  const std::uint8_t* p = image.rgba.data() + (std::size_t{y} * image.width + x) * 4;
  return {p[0], p[1], p[2], p[3]};
}

TEST(Panorama, LooksUpByDirection) {
  const Panorama panorama(counting_image(36, 18), Angle::degrees(90));
  // The heading is the middle, between columns 17 and 18; 10° to the right (falling azimuth) is one column on.
  EXPECT_EQ(panorama.colour(Angle::degrees(5), Angle::degrees(85)) & 0xFFFF, 18u);
  EXPECT_EQ(panorama.colour(Angle::degrees(5), Angle::degrees(95)) & 0xFFFF, 17u);
  EXPECT_EQ(panorama.colour(Angle::degrees(95), Angle::degrees(85)) & 0xFFFF, 18u | 9u << 8);
  EXPECT_EQ(panorama.colour(Angle::degrees(95), Angle::degrees(85 - 720)) & 0xFFFF, 18u | 9u << 8);
}

TEST(Panorama, IsBilinearAndClosesAtTheSeam) {
  const Panorama panorama(counting_image(36, 18));
  const std::uint32_t seam = panorama.colour(Angle::degrees(45), Angle::degrees(180));
  EXPECT_EQ(seam >> 16 & 255, 128u);  // half of the first column's blue
  EXPECT_EQ(panorama.colour(Angle::degrees(45), Angle::degrees(-180)), seam);
  EXPECT_EQ(panorama.colour(Angle::degrees(10), Angle::degrees(-5)) >> 8 & 255, 1u);  // rows ½ and 1½: rounded up
  EXPECT_EQ(panorama.colour(Angle::degrees(0), Angle::degrees(-5)) >> 8 & 255, 0u);   // poles hold the last row
  EXPECT_EQ(panorama.colour(Angle::degrees(180), Angle::degrees(-5)) >> 8 & 255, 17u);
}

TEST(Panorama, RefusesEmptyImages) { EXPECT_THROW(Panorama(Image{}), Error); }

TEST(Panorama, LoadsAPicture) {
  const test::TemporaryFolder folder;
  const Image image = counting_image(40, 20);
  write_png(folder / "a.png", image);
  const Panorama panorama = Panorama::load(folder / "a.png", Angle::degrees(30));
  EXPECT_EQ(panorama.image().rgba, image.rgba);
  EXPECT_EQ(panorama.heading(), Angle::degrees(30));
}

TEST(PanoramaView, NamesRoundTrip) {
  for (const PanoramaView view : panorama_views()) EXPECT_EQ(panorama_view_from_string(to_string(view)), view);
  EXPECT_EQ(panorama_views().size(), 5u);
  EXPECT_THROW(panorama_view_from_string("depth"), Error);
}

// Four walls around the origin, 5 m away and 6 m high, in their own colours: +X red, +Y green, −X blue, −Y white. No
// floor, no roof.
Scene coloured_room() {
  test::QuadScene room;
  const auto material = [](float r, float g, float b) {
    Material m;
    m.base_colour = {r, g, b, 1};
    return m;
  };
  room.quad({5, -5, -3}, {0, 10, 0}, {0, 0, 6}, Role::surveyed, 0.4, material(1, 0, 0));
  room.quad({-5, 5, -3}, {10, 0, 0}, {0, 0, 6}, Role::surveyed, 0.8, material(0, 1, 0));
  room.quad({-5, -5, -3}, {0, 10, 0}, {0, 0, 6}, Role::blocking, 0.4, material(0, 0, 1));
  room.quad({-5, -5, -3}, {10, 0, 0}, {0, 0, 6}, Role::blocking, 0.4, material(1, 1, 1));
  return room.scene();
}

SimulatorConfig embree() {
  SimulatorConfig config;
  config.engine = Engine::embree;
  config.user_size_m = 1;
  config.point_spacing_m = 0.5;
  return config;
}

TEST(PanoramaRenderer, ShowsTheRoomAsOneStandingInItSeesIt) {
  PanoramaRenderer renderer(coloured_room(), {.width = 64, .supersample = 2}, embree());
  const auto images = renderer.render({0, 0, 0}, panorama_views());
  ASSERT_EQ(images.size(), 5u);
  for (const PanoramaImage& image : images) {
    ASSERT_EQ(image.image.width, 64u);
    ASSERT_EQ(image.image.height, 32u);
    ASSERT_EQ(image.image.rgba.size(), 64u * 32u * 4);
  }
  // Looking along +X: +Y is on the left, −Y on the right, −X behind, at both ends.
  const Image& colour = images[0].image;
  const auto ahead = pixel(colour, 32, 16), left = pixel(colour, 16, 16), right = pixel(colour, 48, 16),
             behind = pixel(colour, 0, 16);
  EXPECT_GT(ahead[0], ahead[1] + 60);
  EXPECT_GT(left[1], left[0] + 60);
  EXPECT_GT(behind[2], behind[0] + 20);
  EXPECT_GT(right[0], 150);
  EXPECT_NEAR(right[0], right[1], 25);
  EXPECT_GT(pixel(colour, 32, 0)[2], pixel(colour, 32, 0)[0] + 30);  // blue sky overhead

  // Nearest straight ahead, farthest in the corners: lighter and darker.
  const PanoramaImage& range = images[1];
  EXPECT_NEAR(range.scale_low, 5, 0.1);
  EXPECT_NEAR(range.scale_high, std::hypot(5, 5, 3), 0.5);
  EXPECT_GT(pixel(range.image, 32, 16)[1], pixel(range.image, 24, 16)[1] + 40);

  const Image& normal = images[2].image;
  EXPECT_EQ(pixel(normal, 32, 16), (std::array<int, 4>{0, 128, 128, 255}));  // −X, towards the station
  EXPECT_EQ(pixel(normal, 16, 16), (std::array<int, 4>{128, 0, 128, 255}));

  EXPECT_EQ(images[3].scale_high, 0.8);
  EXPECT_GT(pixel(images[3].image, 16, 16)[1], pixel(images[3].image, 32, 16)[1] + 30);  // R = 0.8 against 0.4
  const auto mesh0 = pixel(images[4].image, 32, 16), mesh1 = pixel(images[4].image, 16, 16);
  EXPECT_GT(std::abs(mesh0[0] - mesh1[0]) + std::abs(mesh0[1] - mesh1[1]) + std::abs(mesh0[2] - mesh1[2]), 60);
}

TEST(PanoramaRenderer, HasNoSeamAndFollowsTheHeading) {
  PanoramaRenderer straight(coloured_room(), {.width = 64}, embree()),
      turned(coloured_room(), {.width = 64, .heading = Angle::degrees(90)}, embree());
  const PanoramaView views[] = {PanoramaView::normal};
  const Image a = straight.render({0, 0, 0}, views)[0].image, b = turned.render({0, 0, 0}, views)[0].image;
  for (std::uint32_t y = 0; y < 32; ++y) {
    for (std::uint32_t x = 0; x < 64; ++x) {
      const auto here = pixel(b, x, y),
                 there = pixel(a, (x + 64 - 16) % 64, y);  // the pixel 16 columns to the left is in the middle
      for (int c = 0; c < 4; ++c) ASSERT_NEAR(here[c], there[c], 1) << x << ", " << y;
    }
    EXPECT_EQ(pixel(a, 0, y), pixel(a, 63, y)) << y;  // one wall crosses the seam
  }
}

TEST(PanoramaRenderer, IsTurnedAsTheStationIs) {
  PanoramaRenderer renderer(coloured_room(), {.width = 64}, embree());
  const auto views = panorama_views();
  const auto of = [&](const StationSetup& setup) { return renderer.render({0, 0, 0}, views, {}, setup); };
  const auto upright = of({}), headed = of({.heading = Angle::degrees(90)}),
             hanging = of({.tilt = Angle::degrees(180)}), lying = of({.tilt = Angle::degrees(90)});
  // The middle faces the heading; a hanging head sees the same upside down and reversed.
  std::array<int, 2> differ{};
  for (std::size_t v = 0; v < views.size(); ++v)
    for (std::uint32_t y = 0; y < 32; ++y)
      for (std::uint32_t x = 0; x < 64; ++x)
        for (std::size_t c = 0; c < 3; ++c) {
          const auto here = pixel(upright[v].image, x, y);
          differ[0] += std::abs(here[c] - pixel(headed[v].image, (x + 16) % 64, y)[c]) > 2;
          differ[1] += std::abs(here[c] - pixel(hanging[v].image, (96 - x - 1) % 64, 31 - y)[c]) > 2;
        }
  EXPECT_LT(differ[0], 60) << "of 30720";
  EXPECT_LT(differ[1], 60);
  // A lying head, its axis along +X, has the red wall overhead, and the sky behind, where −X was.
  const Image& colour = lying[0].image;
  for (const std::uint32_t x : {0u, 20u, 40u}) EXPECT_GT(pixel(colour, x, 0)[0], pixel(colour, x, 0)[1] + 60) << x;
  EXPECT_GT(pixel(colour, 0, 16)[2], pixel(colour, 0, 16)[0] + 30);
  EXPECT_GT(pixel(colour, 16, 16)[1], pixel(colour, 16, 16)[0] + 60) << "+Y stays on the left";
}

TEST(PanoramaRenderer, DoesNotDependOnSubsetsOfViews) {
  PanoramaRenderer renderer(coloured_room(), {.width = 32, .supersample = 3}, embree());
  const auto all = renderer.render({1, 0.5, 0.2}, panorama_views());
  for (std::size_t k = 0; k < all.size(); ++k) {
    const PanoramaView one[] = {panorama_views()[k]};
    EXPECT_EQ(renderer.render({1, 0.5, 0.2}, one)[0].image.rgba, all[k].image.rgba) << to_string(one[0]);
  }
}

TEST(PanoramaRenderer, RefusesBadOptionsAndStops) {
  EXPECT_THROW(PanoramaRenderer(coloured_room(), {.width = 33}, embree()), Error);
  EXPECT_THROW(PanoramaRenderer(coloured_room(), {.width = 64, .supersample = 9}, embree()), Error);
  EXPECT_THROW(PanoramaRenderer(coloured_room(), {.width = 64, .min_range_m = 5, .max_range_m = 4}, embree()), Error);
  std::stop_source stop;
  stop.request_stop();
  PanoramaRenderer renderer(coloured_room(), {.width = 32}, embree());
  EXPECT_TRUE(renderer.render({0, 0, 0}, panorama_views(), {{}, stop.get_token()}).empty());
}

TEST(PanoramaRenderer, NothingInSightIsSkyAndBackdrop) {
  PanoramaRenderer renderer(coloured_room(), {.width = 32, .max_range_m = 2}, embree());
  const auto images = renderer.render({0, 0, 0}, panorama_views());
  ASSERT_EQ(images.size(), 5u);
  EXPECT_EQ(pixel(images[1].image, 3, 8), pixel(images[2].image, 20, 14));
}

// A scan coloured from a picture taken by the same head has the picture's colours.
class ColoursAScan : public testing::TestWithParam<StationSetup> {};
INSTANTIATE_TEST_SUITE_P(Panorama, ColoursAScan,
                         testing::Values(StationSetup{},
                                         StationSetup{.heading = Angle::degrees(30), .tilt = Angle::degrees(70)}));
TEST_P(ColoursAScan, OfTheSameHead) {
  const Scene scene = coloured_room();
  PanoramaRenderer renderer(scene, {.width = 256, .supersample = 1}, embree());
  const PanoramaView views[] = {PanoramaView::normal};
  const Panorama panorama(renderer.render({0, 0, 0}, views, {}, GetParam())[0].image);
  Simulator simulator(scene, test::coarse_scanner(2), embree());
  std::uint64_t points = 0, off = 0;
  simulator.scan({{0, 0, 0}, true, GetParam()},
                 {.outputs = scan_colour | scan_normal,
                  .colour = [&](Angle zenith, Angle azimuth) { return panorama.colour(zenith, azimuth); }},
                 [&](const ScanChunk& chunk) {
                   for (std::size_t k = 0; k < chunk.ray_count; ++k) {
                     if (chunk.colour[k] == 0) continue;
                     ++points;
                     for (int c = 0; c < 3; ++c) {
                       const double expected =
                           127.5 + 127.5 * static_cast<double>(chunk.normal[k][static_cast<std::size_t>(c)]);
                       if (std::abs(static_cast<double>(chunk.colour[k] >> (8 * c) & 255u) - expected) > 2) {
                         ++off;
                         break;
                       }
                     }
                   }
                 });
  EXPECT_GT(points, 4000u);
  EXPECT_LT(off, points / 20);  // only along the walls' edges, where the picture blends
}

}  // namespace
}  // namespace vantage
