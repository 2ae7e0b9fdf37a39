// SPDX-License-Identifier: Apache-2.0
#include "trace/embree/picture.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "scan/limit_model.hpp"
#include "support/random_sites.hpp"
#include "support/trace_scenes.hpp"
#include "trace/embree/embree_tracer.hpp"

namespace vantage {
namespace {

using Corners = std::vector<Float3>;

struct Compared {
  std::uint64_t rays = 0, hits = 0, differ = 0, traced = 0;
  bool drawable = true;
};

// Draws all rays of a station, and traces them.
Compared compare(const TraceScene& scene, const TraceStation& station, const TileEnds& ends) {
  const StationRays rays(std::make_shared<const EmbreeScene>(scene), scene.scanners[station.scanner]);
  const Picture picture(rays, station, ends);
  Compared compared;
  compared.drawable = picture.drawable();
  if (!picture.drawable()) return compared;
  Picture::Strip strip;
  auto bundle = std::make_unique<RayBundle>();
  for (std::uint32_t b = 0; b < picture.strips(); ++b) {
    picture.draw(b, strip);
    compared.traced += strip.traced;
    compared.rays += strip.rays;
    for (std::uint32_t a = 0; a < ends.tall; ++a) {
      RayTile tile{a * RayTile::kSide, b * RayTile::kSide, 0, 0};
      tile.rows = std::min(RayTile::kSide, rays.pattern().rows() - tile.row);
      tile.columns = std::min(RayTile::kSide, rays.pattern().columns() - tile.column);
      rays.gather(station, tile, ends.of(a, b), *bundle);
      if (ends.of(a, b) > 0) rays.caster().cast(*bundle);
      for (std::uint32_t k = 0; k < bundle->size; ++k) {
        const std::uint32_t drawn = strip.triangles(k % tile.columns)[tile.row + k / tile.columns];
        const std::uint32_t traced = ends.of(a, b) > 0 ? bundle->primitive[k] : RayBundle::kNoHit;
        compared.hits += drawn != Picture::kNone;
        compared.differ += drawn != (traced == RayBundle::kNoHit ? Picture::kNone : traced);
      }
    }
  }
  return compared;
}

Compared compare(const TraceScene& scene, const TraceStation& station) {
  return compare(scene, station, all_tiles(*scene.scanners[station.scanner].pattern));
}

Scanner scanner(double step_deg) {
  Scanner scanner;
  scanner.azimuth_step = scanner.zenith_step = Angle::degrees(step_deg);
  scanner.vertical_angle = Angle::degrees(360);
  scanner.min_range_m = 0.1;
  scanner.max_range_m = 60;
  return scanner;
}

TraceScene scene_of(const Corners& corners, const Scanner& with) {
  return test::trace_scene(test::SceneBuilder().mesh(Role::surveyed, corners).finish(), with, 1);
}

Corners box(const Float3& low, const Float3& high) {
  Corners all;
  const Float3 size{high.x - low.x, high.y - low.y, high.z - low.z};
  const auto add = [&](const Float3& at, const Float3& u, const Float3& v) {
    const Corners side = test::quad(at, u, v);
    all.insert(all.end(), side.begin(), side.end());
  };
  for (const bool far : {false, true}) {
    add({far ? high.x : low.x, low.y, low.z}, {0, size.y, 0}, {0, 0, size.z});
    add({low.x, far ? high.y : low.y, low.z}, {size.x, 0, 0}, {0, 0, size.z});
    add({low.x, low.y, far ? high.z : low.z}, {size.x, 0, 0}, {0, size.y, 0});
  }
  return all;
}

// A room with a table, from inside: the axis meets floor and ceiling, walls cross the seam of the azimuths, and the
// head lies in the planes of edges, in that of the table's top, and straight above a corner.
TEST(Picture, ARoomIsWhatTracingFinds) {
  Corners corners = box({-4, -3, 0}, {5, 6, 2.5});
  const Corners table = box({1, -1, 0.7f}, {2, 1, 0.75f}), cupboard = box({-1, 3, 0}, {1, 3.5, 2});
  corners.insert(corners.end(), table.begin(), table.end());
  corners.insert(corners.end(), cupboard.begin(), cupboard.end());
  const TraceScene scene = scene_of(corners, scanner(0.4));
  const auto turn = make_turn({.heading = Angle::degrees(33), .tilt = Angle::degrees(71)});
  for (const Float3& head : {Float3{0.3f, 0.2f, 1.6f}, {0, 0, 1.5}, {1, -1, 1.7f}, {-2, 0, 0.75f}, {1, 2, 2}})
    for (const bool turned : {false, true}) {
      SCOPED_TRACE(std::to_string(head.x) + (turned ? ", turned" : ""));
      const Compared compared = compare(scene, {head, 0, 0, turned ? turn : std::nullopt});
      EXPECT_TRUE(compared.drawable);
      EXPECT_EQ(compared.differ, 0u);
      EXPECT_EQ(compared.hits, compared.rays);
      EXPECT_LT(static_cast<double>(compared.traced), 0.03 * static_cast<double>(compared.rays));
    }
}

// Sheets far nearer to each other than float tells apart, and in one place.
TEST(Picture, TheNearestOfSheetsIsFoundToTheLastBit) {
  Corners corners;
  for (const float gap : {0.0f, 1e-6f, 3e-6f, 1e-5f, 1e-4f, 2e-4f, 0.0f}) {
    const Corners sheet = test::quad({-8, 3 + gap, -5}, {16, 7, 0}, {0, 0.3f, 10});
    corners.insert(corners.end(), sheet.begin(), sheet.end());
  }
  const Compared compared = compare(scene_of(corners, scanner(0.5)), {{0.1f, 0.2f, 0.3f}});
  EXPECT_EQ(compared.differ, 0u);
  EXPECT_GT(compared.hits, compared.rays / 12);
  EXPECT_LT(compared.traced, compared.rays / 50);
}

TEST(Picture, AHeadInASurfaceIsNotDrawn) {
  const TraceScene scene = scene_of(test::quad({-3, -3, 0}, {6, 0, 0}, {0, 6, 0}), scanner(2));
  EXPECT_FALSE(compare(scene, {{0.5f, 0.25f, 0}}).drawable);
  EXPECT_TRUE(compare(scene, {{0.5f, 0.25f, 0.01f}}).drawable);
  EXPECT_TRUE(compare(scene, {{30, 0.25f, 0}}).drawable);
}

TEST(Picture, RaysOutsideTheEndsHaveNoHit) {
  const TraceScene scene = scene_of(box({-4, -3, 0}, {5, 6, 2.5}), scanner(0.5));
  TileEnds ends = all_tiles(*scene.scanners[0].pattern);
  RandomStream random(5);
  for (float& end : ends.end) end = random.uniform() < 0.5 ? 0.0f : test::between(random, 1, 6);
  const Compared compared = compare(scene, {{0.3f, 0.2f, 1.6f}}, ends);
  EXPECT_EQ(compared.differ, 0u);
  EXPECT_GT(compared.hits, 0u);
  EXPECT_LT(compared.hits, compared.rays);
}

// Rays beside a needle that points at the head hit it or do not, in Embree, as the rays beside them decide.
TEST(Picture, ANeedleThatPointsAtTheHeadIsNotHitFromBeside) {
  Scanner with = scanner(0.7);
  with.min_range_m = 0;
  with.max_range_m = 3;
  const Corners needle{
      {-3.92903209f, -1, -2.9979279f}, {-3.87088799f, -1.97177601f, 0}, {-3.89996004f, -1.485888f, -1.49896395f}};
  const Compared compared = compare(scene_of(needle, with), {{-3.98717618f, -0.0282239914f, -5.99585581f}});
  EXPECT_EQ(compared.differ, 0u);
  EXPECT_LT(compared.hits, 4u);
}

// A float of one of many sizes, or a round one: many scenes have corners that lie exactly above each other.
float coordinate() {
  const int kind = *rc::gen::inRange(0, 4);
  if (kind == 0) return static_cast<float>(*rc::gen::inRange(-3, 4));
  if (kind == 1) return static_cast<float>(*rc::gen::inRange(-1000000, 1000001)) * 1e-8f;
  return static_cast<float>(*rc::gen::inRange(-1000000, 1000001)) * 4e-6f;
}

RC_GTEST_PROP(Picture, OfAnyTrianglesIsWhatTracingFinds, ()) {
  Corners corners;
  const int triangles = *rc::gen::inRange(1, 60);
  for (int k = 0; k < triangles; ++k) {
    const Float3 a{coordinate(), coordinate(), coordinate()}, b{coordinate(), coordinate(), coordinate()};
    Float3 c{coordinate(), coordinate(), coordinate()};
    const int kind = *rc::gen::inRange(0, 6);
    if (kind == 0) c = {a.x + 0.5f * (b.x - a.x), a.y + 0.5f * (b.y - a.y), a.z + 0.5f * (b.z - a.z)};  // nearly a line
    if (kind == 1) c = {b.x, b.y, std::nextafter(b.z, 100.0f)};
    if (kind == 2) c = {a.x, a.y, b.z};  // upright
    corners.insert(corners.end(), {a, b, c});
  }
  Scanner with = scanner(*rc::gen::inRange(70, 150) * 0.01);
  with.min_range_m = *rc::gen::inRange(0, 3) * 0.4;
  with.max_range_m = *rc::gen::inRange(0, 2) == 0 ? 3 : 60;
  with.horizontal_angle = Angle::degrees(*rc::gen::inRange(0, 3) == 0 ? 230 : 360);
  with.heading = Angle::degrees(*rc::gen::inRange(0, 4) * 45);
  Float3 head{coordinate(), coordinate(), coordinate()};
  const int place = *rc::gen::inRange(0, 6);
  const Float3 &a = corners[0], &b = corners[1], &c = corners[2];
  if (place == 0) head = {2 * a.x - b.x, 2 * a.y - b.y, 2 * a.z - b.z};  // in the plane of the first triangle
  if (place == 1) head = {a.x, a.y, a.z + 1};                            // above a corner
  if (place == 2)                                                        // just off a surface
    head = {(a.x + b.x + c.x) / 3, (a.y + b.y + c.y) / 3, (a.z + b.z + c.z) / 3 + 1e-4f};
  TraceStation station{head};
  if (*rc::gen::inRange(0, 3) == 0)
    station.turn = make_turn(
        {.heading = Angle::degrees(*rc::gen::inRange(0, 360)), .tilt = Angle::degrees(*rc::gen::inRange(0, 181))});
  const Compared compared = compare(scene_of(corners, with), station);
  RC_TAG(std::string(compared.drawable ? "drawn" : "in a surface"));
  RC_ASSERT(compared.differ == 0u);
}

void expect_equal(const NetworkCounts& a, const NetworkCounts& b) {
  EXPECT_EQ(a.rays, b.rays);
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.points_on_surveyed, b.points_on_surveyed);
  EXPECT_EQ(a.seen, b.seen);
  EXPECT_EQ(a.shared, b.shared);
  ASSERT_EQ(a.dropped.size(), b.dropped.size());
  for (std::size_t k = 0; k < a.dropped.size(); ++k) EXPECT_EQ(a.dropped[k].points, b.dropped[k].points);
}

// Noise, limits, skipping, turned stations: the counts of drawing and tracing, voxel by voxel.
TEST(Picture, CountsAreThoseOfTracing) {
  std::uint64_t points = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const test::RandomSite site = test::random_site(seed);
    std::vector<TraceStation> stations = site.stations;
    stations[1].turn = make_turn({.heading = Angle::degrees(20), .tilt = Angle::degrees(120)});
    const auto n = static_cast<std::uint32_t>(stations.size());
    for (const bool noisy : {false, true})
      for (const bool limited : {false, true}) {
        TraceScene scene = site.scene;
        if (!noisy) scene.scanners[0].noise = std::make_shared<const NoiseModel>();
        if (limited) {
          LimitModel limits;
          limits.meshes.assign(scene.scene->meshes.size(), {.least_cosine_square = 0.2f});
          scene.scanners[0].limits = std::make_shared<const LimitModel>(limits);
        }
        scene.whole_scans = WholeScans::drawn;
        const auto drawing = make_embree_tracer(scene);
        scene.whole_scans = WholeScans::traced;
        const auto tracing = make_embree_tracer(scene);
        for (const bool skip : {false, true}) {
          SCOPED_TRACE("seed " + std::to_string(seed) + (noisy ? ", noise" : "") + (limited ? ", limits" : "") +
                       (skip ? ", skipping" : ""));
          PassField drawn, traced;
          expect_equal(drawing->count(stations, n, {true, skip, &drawn}, {}),
                       tracing->count(stations, n, {true, skip, &traced}, {}));
          EXPECT_EQ(drawn.count, traced.count);
          EXPECT_EQ(drawn.stations, traced.stations);
          for (const std::uint32_t count : drawn.count) points += count;
        }
      }
  }
  EXPECT_GT(points, 10'000u);
}

template <class Value>
void expect_same_bits(const std::vector<Value>& a, const std::vector<Value>& b, const char* name) {
  ASSERT_EQ(a.size(), b.size()) << name;
  EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(Value)), 0) << name;
}

// Scans in chunks of any rows, too, with glass that weakens echoes or returns the beam.
TEST(Picture, ScansAreThoseOfTracing) {
  constexpr std::uint32_t outputs = Tracer::range | Tracer::position | Tracer::normal | Tracer::reflectivity |
                                    Tracer::primitive | Tracer::barycentric | Tracer::voxel;
  std::uint64_t points = 0, on_glass = 0, stations_drawn = 0;
  const auto compare_scans = [&](const TraceScene& scene, std::span<const TraceStation> stations) {
    const RayPattern& pattern = *scene.scanners[0].pattern;
    TraceScene with = scene;
    with.whole_scans = WholeScans::drawn;
    const auto drawing = make_embree_tracer(with);
    const StationRays rays(std::make_shared<const EmbreeScene>(with), scene.scanners[0]);
    with.whole_scans = WholeScans::traced;
    const auto tracing = make_embree_tracer(with);
    Tracer::RawChunk drawn, traced;
    // Stations take turns, and then are scanned one by one.
    const std::uint32_t middle = pattern.rows() / 2;
    for (const std::uint32_t begin : {middle, 0u})
      for (const TraceStation& station : stations) {
        stations_drawn += Picture::where_it_pays(rays, station, all_tiles(pattern)) != nullptr;
        for (std::uint32_t row = begin, many = 1; row < (begin == 0 ? pattern.rows() : middle + 1);
             row += many, many = 2 * many + 3) {
          many = std::min(many, pattern.rows() - row);
          SCOPED_TRACE("rows from " + std::to_string(row));
          const std::uint64_t columns = pattern.columns();
          drawing->scan(station, row * columns, many * columns, outputs, drawn);
          tracing->scan(station, row * columns, many * columns, outputs, traced);
          expect_same_bits(drawn.range, traced.range, "range");
          expect_same_bits(drawn.position, traced.position, "position");
          expect_same_bits(drawn.normal, traced.normal, "normal");
          expect_same_bits(drawn.reflectivity, traced.reflectivity, "reflectivity");
          expect_same_bits(drawn.primitive, traced.primitive, "primitive");
          expect_same_bits(drawn.barycentric, traced.barycentric, "barycentric");
          expect_same_bits(drawn.voxel, traced.voxel, "voxel");
          for (const std::uint32_t triangle : drawn.primitive) {
            points += triangle != RayBundle::kNoHit;
            on_glass += triangle != RayBundle::kNoHit && triangle >= scene.scene->opaque_count();
          }
        }
      }
  };
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    test::RandomSite site = test::random_site(seed);
    site.stations[1].turn = make_turn({.heading = Angle::degrees(20), .tilt = Angle::degrees(120)});
    LimitModel limits;
    limits.meshes.assign(site.scene.scene->meshes.size(), {.least_cosine_square = 0.2f});
    if (seed % 2 == 0) site.scene.scanners[0].limits = std::make_shared<const LimitModel>(limits);
    if (seed > 2) site.scene.scanners[0].noise = std::make_shared<const NoiseModel>();
    compare_scans(site.scene, site.stations);
  }
  Scanner with = scanner(0.5);
  with.detection_range_m = 9;
  with.detection_reflectivity = 0.5;
  const Corners room = box({-4, -3, 0}, {5, 6, 2.5});
  const auto scene =
      std::make_shared<SceneData>(*test::SceneBuilder()
                                       .mesh(Role::surveyed, room)
                                       .mesh(Role::blocking, test::quad({3, -3, 0}, {0, 9, 0}, {0, 0, 2.5f}))
                                       .finish());
  scene->meshes[1].glass = true;
  TraceScene behind_glass = test::trace_scene(scene, with, 1);
  behind_glass.scanners[0].limits = std::make_shared<const LimitModel>(make_limit_model(*scene, with, {}));
  ASSERT_TRUE(behind_glass.scanners[0].limits->glass);
  compare_scans(behind_glass, std::vector<TraceStation>{{{0.3f, 0.2f, 1.6f}}});
  EXPECT_GT(points, 100'000u);
  EXPECT_GT(on_glass, 0u);
  EXPECT_GT(stations_drawn, 10u);
}

// Drawing has to look at every triangle, and most pay for themselves only where they are larger than a few rays.
TEST(Picture, PaysWhereTrianglesHaveEnoughRays) {
  EXPECT_TRUE(Picture::pays(3'000, 1'000'000));
  EXPECT_FALSE(Picture::pays(3'000'000, 1'000'000));
}

}  // namespace
}  // namespace vantage
