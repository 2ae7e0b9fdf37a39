// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "core/philox.hpp"
#include "scene/scene_data.hpp"
#include "support/engines.hpp"
#include "support/glb_builder.hpp"
#include "vantage/error.hpp"
#include "vantage/rays.hpp"
#include "vantage/simulator.hpp"

namespace vantage {
namespace {

constexpr std::uint32_t kNone = 0xFFFFFFFFu;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
const Vec3 kFar{431'000.25, 5'812'000.5, 312.75};  // as of a national grid

double between(RandomStream& random, double low, double high) { return low + (high - low) * random.uniform(); }
Vec3 any_vector(RandomStream& random, double size) {
  return {between(random, -size, size), between(random, -size, size), between(random, -size, size)};
}

using Corners = std::array<std::uint32_t, 3>;
struct Soup {
  std::vector<Vec3> positions;
  std::vector<Corners> triangles;
  void add(const Vec3& a, const Vec3& b, const Vec3& c) {
    const auto first = static_cast<std::uint32_t>(positions.size());
    for (const Vec3& p : {a, b, c}) positions.push_back(p);
    triangles.push_back({first, first + 1, first + 2});
  }
  Scene scene() const { return Scene::from_triangles(positions, triangles); }
};

// Triangles of all sizes and shapes, slivers included, around `middle`.
Soup random_soup(std::size_t many, const Vec3& middle) {
  RandomStream random(5);
  Soup soup;
  for (std::size_t k = 0; k < many; ++k) {
    const Vec3 a = middle + any_vector(random, 20);
    const double size = std::pow(10.0, between(random, -2, 1));
    const Vec3 b = a + any_vector(random, size);
    const Vec3 c = k % 5 == 0 ? a + (b - a) * 0.5 + any_vector(random, 1e-3 * size) : a + any_vector(random, size);
    soup.add(a, b, c);
  }
  return soup;
}

// The crossing of a ray with a triangle's plane and its weights (Moeller, Trumbore: Fast, Minimum Storage Ray/Triangle
// Intersection, 1997): other formulas than the tracer's.
struct Crossing {
  double t, least;  // distance, and the least of the three weights
};
Crossing crossing(const Vec3& origin, const Vec3& unit, const std::array<Vec3, 3>& corners) {
  const Vec3 e = corners[1] - corners[0], f = corners[2] - corners[0], p = cross(unit, f);
  const double det = dot(e, p);
  const Vec3 s = origin - corners[0], q = cross(s, e);
  const double u = dot(s, p) / det, v = dot(unit, q) / det;
  return {dot(f, q) / det, std::min({u, v, 1 - u - v})};
}

// Nearest, any and number of hits of every triangle, one after the other.
struct Brute {
  double t = kInfinity;
  std::uint32_t triangle = kNone, count = 0;
  bool doubtful = false;  // an edge is too near to tell, or the triangle is seen edge-on
};
Brute brute_force(const SceneData& scene, const Vec3& origin, const Vec3& direction, double from, double range) {
  const Vec3 unit = direction * (1 / std::sqrt(dot(direction, direction)));
  Brute found;
  for (std::uint32_t k = 0; k < scene.triangle_count(); ++k) {
    const auto corners = scene.corners(k);
    const Crossing at =
        crossing(origin - scene.origin, unit, {widen(corners[0]), widen(corners[1]), widen(corners[2])});
    const bool near_edge = !(std::abs(at.least) > 1e-7),
               near_end = std::abs(at.t - from) < 1e-7 || std::abs(at.t - range) < 1e-7;
    if ((near_edge || near_end) && !(at.least < -1e-6)) found.doubtful = true;
    if (!(at.least >= 0) || at.t <= from || at.t > range) continue;
    ++found.count;
    if (at.t < found.t) found.t = at.t, found.triangle = k;
  }
  return found;
}

TEST(RayTracer, AgreesWithBruteForceInDoublePrecision) {
  for (const Vec3& middle : {Vec3{}, kFar}) {
    const Scene scene = random_soup(1500, middle).scene();
    const RayTracer tracer(scene);
    RandomStream random(9);
    std::vector<Vec3> origins, directions;
    std::vector<double> ranges;
    for (int k = 0; k < 4000; ++k) {
      // From within the scene and from far outside, with directions of any length.
      origins.push_back(middle + any_vector(random, k % 3 == 0 ? 500 : k % 3 == 1 ? 25 : 5e4));
      const Vec3 aim = middle + any_vector(random, 20);
      directions.push_back((k % 2 == 0 ? any_vector(random, 1) : aim - origins.back()) *
                           std::pow(10.0, between(random, -30, 30)));
      ranges.push_back(k % 4 == 0 ? between(random, 1, 40) : kInfinity);
    }
    const Rays rays{origins, directions, ranges};
    const RayOptions options{.from_m = 0.5};
    const RayHits hits = tracer.nearest(rays, options);
    const auto blocked = tracer.blocked(rays, options);
    const auto counts = tracer.count(rays, options);
    ASSERT_EQ(hits.size(), origins.size());
    std::size_t hit = 0, doubtful = 0;
    for (std::size_t k = 0; k < origins.size(); ++k) {
      const Brute expected = brute_force(scene.data(), origins[k], directions[k], options.from_m, ranges[k]);
      ASSERT_EQ(blocked[k] != 0, hits.primitive[k] != kNone) << k;
      ASSERT_EQ(counts[k] > 0, hits.primitive[k] != kNone) << k;
      if (expected.doubtful) {
        ++doubtful;
        continue;
      }
      ASSERT_EQ(hits.primitive[k], expected.triangle) << k;
      ASSERT_EQ(counts[k], expected.count) << k;
      if (expected.triangle == kNone) {
        ASSERT_EQ(hits.range_m[k], kInfinity);
        ASSERT_TRUE(std::isnan(hits.position[k].x));
        ASSERT_EQ(hits.mesh[k], -1);
        continue;
      }
      ++hit;
      ASSERT_NEAR(hits.range_m[k], expected.t, 1e-6 + 1e-9 * expected.t) << k;
      const auto corners = scene.data().corners(hits.primitive[k]);
      const Vec3 a = widen(corners[0]), n = cross(widen(corners[1]) - a, widen(corners[2]) - a);
      const Vec3 normal{hits.normal[k][0], hits.normal[k][1], hits.normal[k][2]};
      ASSERT_NEAR(std::abs(dot(normal, n)), std::sqrt(dot(n, n)), 1e-6 * std::sqrt(dot(n, n)));
      ASSERT_LE(dot(normal, directions[k]), 0);
      ASSERT_NEAR(hits.reflectivity[k],
                  -0.5 * dot(normal, directions[k]) / std::sqrt(dot(directions[k], directions[k])), 1e-6);
      ASSERT_EQ(hits.diffuse[k], 0.5f);
      ASSERT_EQ(hits.mesh[k], 0);
    }
    EXPECT_GT(hit, 800u);
    EXPECT_LT(doubtful, 60u);
  }
}

// A closed box whose faces are fans of many triangles, seen from inside along its corners, edges and diagonals.
TEST(RayTracer, NoRayPassesBetweenTriangles) {
  Soup soup;
  constexpr int n = 16;
  const auto point = [](int face, int i, int j) {
    const double u = -1 + 2.0 * i / n, v = -1 + 2.0 * j / n, w = face % 2 == 0 ? -1 : 1;
    return kFar + (face / 2 == 0 ? Vec3{w, u, v} : face / 2 == 1 ? Vec3{u, w, v} : Vec3{u, v, w}) * 3.3;
  };
  for (int face = 0; face < 6; ++face)
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        soup.add(point(face, i, j), point(face, i + 1, j), point(face, i + 1, j + 1));
        soup.add(point(face, i, j), point(face, i + 1, j + 1), point(face, i, j + 1));
      }
  const Scene scene = soup.scene();
  const RayTracer tracer(scene);
  RandomStream random(3);
  std::vector<Vec3> directions;
  const Vec3 origin = kFar + Vec3{0.1, -0.2, 0.3};
  for (std::uint32_t k = 0; k < scene.triangle_count(); ++k) {
    const auto corners = scene.data().corners(k);
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3 a = widen(corners[c]), b = widen(corners[(c + 1) % 3]), local = origin - scene.data().origin;
      directions.push_back(a - local);
      directions.push_back(a + (b - a) * random.uniform() - local);
    }
  }
  const Rays rays{.origins = {&origin, 1}, .directions = directions};
  const auto blocked = tracer.blocked(rays);
  EXPECT_EQ(std::ranges::count(blocked, 1), static_cast<std::ptrdiff_t>(directions.size()));
  for (const double range : tracer.nearest(rays).range_m) ASSERT_LT(range, 8);
}

// Walls across the x axis at 1, 2 and 3 m; the first is of glass.
Scene walls_with_glass() {
  test::GlbBuilder builder;
  builder.json["asset"]["extras"]["vantage"] = nlohmann::json::object();  // in metres, Y up
  for (const auto& [x, name] : {std::pair{1.0f, "pane"}, {2.0f, "front"}, {3.0f, "back"}}) {
    const int corners = builder.positions({x, -2, -2, x, 2, -2, x, 2, 2, x, -2, -2, x, 2, 2, x, -2, 2});
    builder.node({{"name", name}, {"mesh", builder.mesh({{"attributes", {{"POSITION", corners}}}})}});
  }
  return test::load(builder, {.glass = {"pane"}});
}

TEST(RayTracer, RaysPassGlassUnlessItIsToStopThem) {
  const Scene scene = walls_with_glass();
  const RayTracer tracer(scene);
  const Vec3 origin{0, 0.3, 0.1}, along{5, 0, 0};
  const Rays rays{{&origin, 1}, {&along, 1}};
  const auto name = [&](const RayHits& hits) { return scene.meshes()[static_cast<std::size_t>(hits.mesh[0])].name; };
  EXPECT_EQ(name(tracer.nearest(rays)), "front");
  EXPECT_EQ(tracer.nearest(rays).range_m[0], 2);
  EXPECT_EQ(tracer.count(rays)[0], 2u);
  EXPECT_EQ(name(tracer.nearest(rays, {.glass = true})), "pane");
  EXPECT_EQ(tracer.count(rays, {.glass = true})[0], 3u);
  const double short_range = 1.5;
  EXPECT_EQ(tracer.blocked({rays.origins, rays.directions, {&short_range, 1}})[0], 0);
  EXPECT_EQ(tracer.blocked({rays.origins, rays.directions, {&short_range, 1}}, {.glass = true})[0], 1);
  // A hit counts up to its range, the end included, and only beyond the start.
  const double exact = 2;
  EXPECT_EQ(tracer.count({rays.origins, rays.directions, {&exact, 1}})[0], 1u);
  EXPECT_EQ(name(tracer.nearest(rays, {.from_m = 2})), "back");
  EXPECT_EQ(tracer.nearest(rays, {.from_m = 2}).position[0], (Vec3{3, 0.3, 0.1}));
}

TEST(RayTracer, DirectionsOfAnyLengthAreDirections) {
  const RayTracer tracer(walls_with_glass());
  const Vec3 origin{0, 0.3, 0.1};
  const std::vector<Vec3> directions{{5e-324, 0, 0},
                                     {1e308, 0, 0},
                                     {std::numeric_limits<double>::max(), 0, 0},
                                     {1, -0.0, 1e-300},
                                     {1e-310, 0, 1e-318}};
  const RayHits hits = tracer.nearest({{&origin, 1}, directions});
  for (std::size_t k = 0; k < directions.size(); ++k) EXPECT_NEAR(hits.range_m[k], 2, 1e-9) << k;
}

// A mesh that nodes turn, scale and mirror: stored once or where it stands, a ray meets the same.
TEST(RayTracer, SharedMeshesAreMetWhereTheyStand) {
  test::GlbBuilder builder;
  builder.json["asset"]["extras"]["vantage"] = nlohmann::json::object();  // in metres, Y up
  std::vector<float> corners;
  RandomStream random(8);
  for (int k = 0; k < 60; ++k) {
    const Vec3 a = any_vector(random, 1);
    for (int c = 0; c < 3; ++c) {
      const Vec3 p = a + any_vector(random, 0.6);
      for (const double x : {p.x, p.y, p.z}) corners.push_back(static_cast<float>(x));
    }
  }
  const int mesh = builder.mesh({{"attributes", {{"POSITION", builder.positions(corners)}}}});
  for (int k = 0; k < 30; ++k) {
    const Vec3 at = any_vector(random, 30), turn = any_vector(random, 1);
    const double size = std::pow(10.0, between(random, -1, 1)), mirrored = k % 4 == 0 ? -1 : 1;
    const double length = std::sqrt(1 + dot(turn, turn));
    builder.node({{"mesh", mesh},
                  {"translation", {at.x, at.y, at.z}},
                  {"rotation", {turn.x / length, turn.y / length, turn.z / length, 1 / length}},
                  {"scale", {mirrored * size, size, 1.5 * size}}});
  }
  std::vector<Vec3> origins, directions;
  for (int k = 0; k < 20'000; ++k) {
    origins.push_back(any_vector(random, 60));
    directions.push_back(any_vector(random, 30) - origins.back());
  }
  const auto hits_of = [&](SharedMeshes shared) {
    const Scene scene = test::load(builder, {.shared_meshes = shared});
    EXPECT_EQ(scene.data().shares(), shared == SharedMeshes::always);
    return RayTracer(scene).nearest({origins, directions});
  };
  const RayHits once = hits_of(SharedMeshes::always), each = hits_of(SharedMeshes::never);
  EXPECT_EQ(once.primitive, each.primitive);
  EXPECT_EQ(once.range_m, each.range_m);
  EXPECT_EQ(once.mesh, each.mesh);
  EXPECT_GT(std::ranges::count_if(once.range_m, [](double range) { return range < kInfinity; }), 5000);
}

// Rays meet the same as in the scans of every engine, except for rounding at edges.
TEST(RayTracer, MeetsWhatScansOfEveryEngineMeet) {
  const Scene scene = random_soup(300, kFar).scene();
  const RayTracer tracer(scene);
  const Scanner scanner{.azimuth_step = Angle::degrees(2), .zenith_step = Angle::degrees(2)};
  std::vector<Vec3> directions;
  for (std::uint64_t ray = 0; ray < scanner.rays(); ++ray) {
    const auto [zenith, azimuth] = scanner.angles(ray);
    const double z = zenith.in_radians(), a = azimuth.in_radians();
    directions.push_back({std::sin(z) * std::cos(a), std::sin(z) * std::sin(a), std::cos(z)});
  }
  const double range = scanner.max_range_m;
  const RayHits hits = tracer.nearest({{&kFar, 1}, directions, {&range, 1}}, {.from_m = scanner.min_range_m});
  for (const EngineInfo& engine : test::usable_engines()) {
    SCOPED_TRACE(test::name_of(engine));
    Simulator simulator(scene, scanner,
                        {.engine = engine.engine,
                         .device_index = engine.device_index,
                         .user_size_m = 1,
                         .point_spacing_m = 0.5,
                         .noise = false});
    std::size_t same = 0, other = 0;
    simulator.scan({.position = kFar}, {.outputs = scan_range | scan_ids}, [&](const ScanChunk& chunk) {
      for (std::size_t k = 0; k < chunk.ray_count; ++k) {
        const std::size_t ray = chunk.first_ray + k;
        const bool met = chunk.primitive[k] == hits.primitive[ray] &&
                         (chunk.primitive[k] == kNone || std::abs(chunk.range_m[k] - hits.range_m[ray]) < 1e-3);
        ++(met ? same : other);
      }
    });
    EXPECT_EQ(same + other, scanner.rays());
    EXPECT_LE(other, scanner.rays() / 500);
  }
}

std::string refusal_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), Errc::invalid_argument);
    return error.what();
  }
  return "";
}

TEST(RayTracer, RefusesWhatIsNoRayByItsRow) {
  const RayTracer tracer(walls_with_glass());
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<Vec3> origins(4), directions(4, Vec3{1, 0, 0});
  std::vector<double> ranges(4, 1);
  const auto refused = [&] { return refusal_of([&] { tracer.nearest({origins, directions, ranges}); }); };
  EXPECT_EQ(refused(), "");
  for (const Vec3& bad : {Vec3{nan, 0, 0}, Vec3{0, kInfinity, 0}, Vec3{0, 0, 1.1e6}}) {
    origins[2] = bad;
    EXPECT_NE(refused().find("origin in row 2, counted from 0,"), std::string::npos) << refused();
  }
  origins[2] = {};
  for (const Vec3& bad : {Vec3{nan, 0, 0}, Vec3{0, kInfinity, 0}, Vec3{0, -0.0, 0}}) {
    directions[3] = bad;
    EXPECT_NE(refused().find("direction in row 3, counted from 0,"), std::string::npos) << refused();
  }
  directions[3] = {0, 0, 1};
  for (const double bad : {nan, 0.0, -1.0}) {
    ranges[1] = bad;
    EXPECT_NE(refused().find("range in row 1, counted from 0,"), std::string::npos) << refused();
  }
  ranges[1] = kInfinity;
  EXPECT_EQ(refused(), "");
  directions.pop_back();
  EXPECT_NE(refused().find("4 origins and 3 directions"), std::string::npos) << refused();
  directions.push_back({1, 0, 0});
  for (const double bad : {nan, -1.0, kInfinity})
    EXPECT_NE(refusal_of([&] { tracer.count({origins, directions}, {.from_m = bad}); }), "");
}

TEST(RayTracer, NoRaysAndStoppedCallsGiveEmptyArrays) {
  const RayTracer tracer(walls_with_glass());
  EXPECT_EQ(tracer.nearest({}).size(), 0u);
  EXPECT_TRUE(tracer.blocked({}).empty());
  const Vec3 origin{0, 0.3, 0.1}, along{5, 0, 0};
  const Rays rays{{&origin, 1}, {&along, 1}};
  std::stop_source stop;
  const Progress progress{.report = [&](double) { stop.request_stop(); }, .stop = stop.get_token()};
  EXPECT_EQ(tracer.nearest(rays, {}, progress).size(), 0u);
  EXPECT_TRUE(tracer.count(rays, {}, progress).empty());
}

}  // namespace
}  // namespace vantage
