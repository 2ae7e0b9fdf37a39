// SPDX-License-Identifier: Apache-2.0
#include "support/random_sites.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <numeric>
#include <utility>

#include "scene/shared_meshes.hpp"
#include "support/trace_scenes.hpp"

namespace vantage::test {
namespace {

constexpr double goal = 6.5;

// VANTAGE_SEEDS=first..last overrides the default seeds.
std::pair<std::uint64_t, std::uint64_t> seeds(std::uint64_t usual_first, std::uint64_t usual_last) {
  const char* text = std::getenv("VANTAGE_SEEDS");
  unsigned long long first = usual_first, last = usual_last;
  if (text && std::sscanf(text, "%llu..%llu", &first, &last) != 2)
    ADD_FAILURE() << "VANTAGE_SEEDS must be first..last: " << text;
  return {first, last};
}

// A closed ball of connected triangles, with dents that fold it as seen from most places.
std::vector<Float3> bumpy_ball(RandomStream& random, const Float3& centre, float radius) {
  constexpr std::size_t rows = 9, columns = 14;
  std::vector<Float3> corners((rows + 1) * columns);
  for (std::size_t r = 0; r <= rows; ++r)
    for (std::size_t c = 0; c < columns; ++c) {
      if (c > 0 && (r == 0 || r == rows)) {  // a pole is a single place
        corners[r * columns + c] = corners[r * columns];
        continue;
      }
      const double zenith = std::numbers::pi * static_cast<double>(r) / rows,
                   azimuth = 2 * std::numbers::pi * static_cast<double>(c) / columns;
      const double out = static_cast<double>(radius) * (0.5 + 0.5 * random.uniform());
      corners[r * columns + c] = {centre.x + static_cast<float>(out * std::sin(zenith) * std::cos(azimuth)),
                                  centre.y + static_cast<float>(out * std::sin(zenith) * std::sin(azimuth)),
                                  centre.z + static_cast<float>(out * std::cos(zenith))};
    }
  std::vector<Float3> triangles;
  for (std::size_t r = 0; r < rows; ++r)
    for (std::size_t c = 0; c < columns; ++c) {
      const Float3 &a = corners[r * columns + c], &b = corners[r * columns + (c + 1) % columns],
                   &d = corners[(r + 1) * columns + c], &e = corners[(r + 1) * columns + (c + 1) % columns];
      if (r > 0) triangles.insert(triangles.end(), {a, d, b});
      if (r + 1 < rows) triangles.insert(triangles.end(), {b, d, e});
    }
  return triangles;
}

// The site of a scene, with a scanner and heads. `surveyed`: corners of triangles, three each; place(extent): a
// coordinate. `finer`: rays are so many times closer, in a part of the turn.
template <class Place>
RandomSite with_scanner(RandomStream& random, std::uint64_t seed, double scale, std::shared_ptr<const SceneData> scene,
                        const std::vector<Float3>& surveyed, const Place& place, double finer = 1) {
  Scanner scanner;
  scanner.azimuth_step = Angle::degrees((0.8 + random.uniform()) / finer);
  scanner.zenith_step = Angle::degrees((0.8 + random.uniform()) / finer);
  scanner.horizontal_angle = Angle::degrees((seed % 3 == 0 ? 230 : 360) / (finer > 1 ? finer / 2 : 1));
  scanner.vertical_angle = Angle::degrees(seed % 4 == 0 ? 360 : 300);
  scanner.heading = Angle::degrees(360 * random.uniform());
  scanner.min_range_m = 0.1 * scale;
  scanner.max_range_m = seed % 5 == 0 ? 2 * scale : 40 * scale;
  scanner.noise = rtc360_noise();
  for (double& d : scanner.noise.distances_m) d *= scale / 10;
  for (double& d : scanner.noise.sigma_m)
    d *= scale * (seed % 7 == 0 ? 20 : 1);  // also a reach beyond the nearest range
  RandomSite site;
  site.scene = trace_scene(std::move(scene), scanner, (0.08 + 0.15 * random.uniform()) * scale, seed);
  for (std::uint32_t k = 0; k < 7; ++k) {
    Float3 head{place(2.2), place(2.2), place(1.2)};
    if (k == 4) head = surveyed[random.bits() % surveyed.size()];  // at a corner
    if (k == 5) {                                                  // in the plane of a triangle
      const std::size_t t = random.bits() % (surveyed.size() / 3) * 3;
      head = {2 * surveyed[t].x - surveyed[t + 1].x, 2 * surveyed[t].y - surveyed[t + 1].y,
              2 * surveyed[t].z - surveyed[t + 1].z};
    }
    site.stations.push_back({head, k});
  }
  return site;
}

}  // namespace

RandomSite random_site(std::uint64_t seed) {
  RandomStream random(seed, 1);
  const double scale = std::pow(10.0, 2 * random.uniform() - 1), offset = random.bits() % 3 == 0 ? 100 * scale : 0;
  const auto place = [&](double extent) {
    return static_cast<float>(offset + scale * extent * (2 * random.uniform() - 1));
  };
  std::vector<Float3> surveyed, blocking;
  const auto soup = [&](std::vector<Float3>& to, int n, double size) {
    for (int k = 0; k < n; ++k) {
      const Float3 c{place(2), place(2), place(1)};
      const auto near = [&](double s) {
        return Float3{c.x + between(random, -s, s), c.y + between(random, -s, s), c.z + between(random, -s, s)};
      };
      to.push_back(near(size * scale));
      to.push_back(near(size * scale));
      to.push_back(k % 5 == 0 ? Float3{c.x, c.y, std::nextafter(c.z, 1e9f)} : near(size * scale));
    }
  };
  soup(surveyed, 150, 0.3);
  soup(surveyed, 300, 0.04);
  soup(blocking, 100, 0.3);
  const float s = static_cast<float>(scale);
  for (int k = 0; k < 4; ++k) {
    // A wall, sometimes along the axes, and a piece of the other role in exactly the same plane.
    const Float3 corner{place(1.5), place(1.5), place(0.8)};
    const Float3 u = k % 2 ? Float3{s, 0, 0} : Float3{s * 0.7f, s * 0.6f, s * 0.1f}, v{0, 0, s * 0.9f};
    const auto wall = quad(corner, u, v),
               piece = quad(corner, {u.x * 0.5f, u.y * 0.5f, u.z * 0.5f}, {0, 0, s * 0.9f * 0.5f});
    surveyed.insert(surveyed.end(), wall.begin(), wall.end());
    blocking.insert(blocking.end(), piece.begin(), piece.end());
  }

  for (int k = 0; k < 3; ++k) {
    const std::vector<Float3> ball = bumpy_ball(random, {place(1.5), place(1.5), place(0.8)}, 0.5f * s);
    std::vector<Float3>& to = k == 0 ? surveyed : blocking;
    to.insert(to.end(), ball.begin(), ball.end());
  }

  SceneBuilder builder;
  if (seed % 2) builder.mesh(Role::blocking, blocking, 0.7);
  builder.mesh(Role::surveyed, surveyed, 0.4);
  if (seed % 2 == 0) builder.mesh(Role::blocking, blocking, 0.7);
  return with_scanner(random, seed, scale, builder.finish(), surveyed, place);
}

RandomSite random_fine_site(std::uint64_t seed) {
  RandomStream random(seed, 3);
  const double scale = 5;
  const auto place = [&](double extent) { return static_cast<float>(scale * extent * (2 * random.uniform() - 1)); };
  const auto s = static_cast<float>(scale);
  std::vector<Float3> surveyed, blocking;
  const auto add = [](std::vector<Float3>& to, const std::vector<Float3>& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  // A room with boards of two faces, and slats before its walls.
  add(surveyed, quad({-s, -s, -s}, {2 * s, 0, 0}, {0, 2 * s, 0}));
  add(surveyed, quad({-s, -s, -s}, {0, 0, 2 * s}, {0, 2 * s, 0}));
  add(surveyed, quad({-s, -s, -s}, {2 * s, 0, 0}, {0, 0, 2 * s}));
  for (int k = 0; k < 6; ++k) {
    const Float3 corner{place(0.8), place(0.8), place(0.8)};
    const float thick = between(random, 0.002, 0.05) * s;
    const Float3 u = k % 2 ? Float3{s, 0, 0} : Float3{s * 0.7f, s * 0.6f, s * 0.1f}, v{0, 0, s * 0.9f};
    add(surveyed, quad(corner, u, v));
    add(surveyed, quad({corner.x + 0.1f * thick, corner.y + thick, corner.z}, u, v));
    for (int slat = 0; slat < 8; ++slat) {
      const float up = 0.11f * static_cast<float>(slat) * s;
      add(blocking, quad({corner.x, corner.y - 5 * thick, corner.z + up}, u, {0, 0, between(random, 0.02, 0.12) * s}));
    }
  }
  add(surveyed, bumpy_ball(random, {place(1), place(1), place(0.8)}, 0.5f * s));
  add(blocking, bumpy_ball(random, {place(1), place(1), place(0.8)}, 0.3f * s));
  SceneBuilder builder;
  builder.mesh(Role::surveyed, surveyed, 0.05 + 0.8 * random.uniform());
  builder.mesh(Role::blocking, blocking, 0.7);
  if (seed % 2) builder.leaning_normals(random, seed % 4 == 1 ? 0.02 : 0.4);
  return with_scanner(random, seed, 0.2 * scale, builder.finish(), surveyed, place, 10);
}

namespace {

// A scanner of the same ranges as the site's.
Scanner scanner_of_ranges(const RandomSite& site) {
  const RayPattern& pattern = *site.scene.scanners.front().pattern;
  Scanner scanner;
  scanner.min_range_m = static_cast<double>(pattern.min_range);
  scanner.max_range_m = static_cast<double>(pattern.max_range);
  return scanner;
}

}  // namespace

RandomSite random_uneven_site(std::uint64_t seed) {
  RandomStream random(seed, 3);
  RandomSite site = random_site(seed);
  Scanner scanner = scanner_of_ranges(site);
  scanner.azimuth_step = Angle::degrees(0.5 + random.uniform());
  scanner.horizontal_angle = Angle::degrees(seed % 2 == 0 ? 360 : 290);
  scanner.heading = Angle::degrees(360 * random.uniform());
  std::vector<Angle> zeniths;
  for (double zenith = 30 * random.uniform(); zenith < 175; zenith += 0.01 + 3 * random.uniform() * random.uniform())
    zeniths.push_back(Angle::degrees(zenith));
  scanner.set_row_zeniths(zeniths);
  site.scene.scanners.front().pattern = std::make_shared<const RayPattern>(make_pattern(scanner));
  return site;
}

RandomSite random_listed_site(std::uint64_t seed) {
  RandomStream random(seed, 4);
  RandomSite site = random_site(seed);
  Scanner scanner = scanner_of_ranges(site);
  scanner.heading = Angle::degrees(360 * random.uniform());
  constexpr std::size_t kRays = 40'000;
  std::vector<RayAngles> directions;
  for (std::size_t k = 0; k < kRays; ++k) {
    const double turn = static_cast<double>(k) * 0.0379;
    RayAngles angles{Angle::radians(0.5 * std::numbers::pi * (1 - 0.96 * std::sin(0.617 * turn))),
                     Angle::radians(std::remainder(turn, 2 * std::numbers::pi))};
    if (k % 7 == 0)
      angles = {Angle::radians(std::acos(2 * random.uniform() - 1)), Angle::degrees(720 * random.uniform() - 360)};
    if (k % 11 == 0 && k > 0) angles = directions[random.bits() % directions.size()];
    directions.push_back(angles);
  }
  directions[5] = {Angle::degrees(0), Angle::degrees(0)}, directions[6] = {Angle::degrees(180), Angle::degrees(10)};
  scanner.set_directions(directions);
  site.scene.scanners.front().pattern = std::make_shared<const RayPattern>(make_pattern(scanner));
  return site;
}

RandomSite random_placed_site(std::uint64_t seed) {
  RandomStream random(seed, 2);
  const double scale = std::pow(10.0, 2 * random.uniform() - 1), offset = random.bits() % 3 == 0 ? 100 * scale : 0;
  const auto place = [&](double extent) {
    return static_cast<float>(offset + scale * extent * (2 * random.uniform() - 1));
  };
  // In a unit of their own, one with its origin at some distance.
  const double units[] = {1, 1000, 1 / 0.0254};
  const double unit = units[random.bits() % 3] * scale;
  const auto s = static_cast<float>(unit);
  std::vector<Float3> ball = bumpy_ball(random, {0.3f * s, -0.2f * s, 0.1f * s}, 0.5f * s);
  for (int k = 0; k < 60; ++k) {
    const auto near = [&] { return between(random, -0.6, 0.6) * s; };
    const Float3 corner{near(), near(), near()};
    for (int c = 0; c < 3; ++c)
      ball.push_back({corner.x + 0.3f * near(), corner.y + 0.3f * near(), corner.z + 0.3f * near()});
  }
  std::vector<Float3> panel = quad({2 * s, 7 * s, 0}, {s, 0, 0}, {0, 0, 0.9f * s});
  const auto small = bumpy_ball(random, {2.5f * s, 7 * s, 0.4f * s}, 0.3f * s);
  panel.insert(panel.end(), small.begin(), small.end());

  const auto somewhere = [&](const Vec3& middle, double most_unequal) {
    glm::dquat turn(random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5);
    glm::dmat4 matrix(glm::mat3_cast(glm::normalize(turn)));
    if (random.bits() % 3 == 0) matrix = glm::dmat4(1);  // along the axes
    for (int c = 0; c < 3; ++c)
      matrix[c] = matrix[c] *
                  (scale / unit * std::pow(most_unequal, random.uniform() - 0.5) * (random.bits() % 4 == 0 ? -1 : 1));
    const glm::dvec3 moved = glm::dmat3(matrix) * glm::dvec3(middle.x, middle.y, middle.z);
    matrix[3] = glm::dvec4(glm::dvec3(place(1.5), place(1.5), place(0.8)) - moved, 1);
    return place_of(matrix);
  };
  std::vector<MeshPlace> balls, panels;
  for (int k = 0; k < 5; ++k) balls.push_back(somewhere({}, k == 4 ? 12 : 2));
  for (int k = 0; k < 3; ++k) panels.push_back(somewhere({2.5 * unit, 7 * unit, 0.4 * unit}, 1));
  std::vector<Float3> surveyed, blocking;
  for (int k = 0; k < 4; ++k) {
    const Float3 corner{place(1.5), place(1.5), place(0.8)};
    const float side = static_cast<float>(scale);
    const auto wall = quad(corner, {side * 0.7f, side * 0.6f, side * 0.1f}, {0, 0, side * 0.9f});
    (k == 3 ? blocking : surveyed).insert((k == 3 ? blocking : surveyed).end(), wall.begin(), wall.end());
  }
  SceneBuilder builder;
  builder.mesh(Role::surveyed, surveyed, 0.4);
  builder.placed(Role::surveyed, ball, balls, 0.7);
  builder.mesh(Role::blocking, blocking, 0.6);
  builder.placed(seed % 2 ? Role::surveyed : Role::blocking, panel, panels, 0.3);
  const auto scene = builder.finish();
  for (std::uint32_t t = 0; t < scene->triangle_count(); t += 7)
    for (const Float3& corner : scene->corners(t)) surveyed.push_back(corner);
  return with_scanner(random, seed, scale, scene, surveyed, place);
}

RaysTraced expect_every_way_agrees(const std::function<std::unique_ptr<Tracer>(const TraceScene&)>& make,
                                   std::uint64_t first, std::uint64_t last, RandomSite (*site_of)(std::uint64_t seed)) {
  const auto [from, to] = seeds(first, last);
  std::uint64_t points = 0, skipped_rays = 0, all_rays = 0, sampled_rays = 0;
  for (std::uint64_t seed = from; seed <= to; ++seed) {
    RandomSite site = site_of(seed);
    std::vector<std::uint32_t> everything(site.scene.grid->size());
    std::iota(everything.begin(), everything.end(), 0u);
    for (const bool noisy : {false, true}) {
      SCOPED_TRACE("seed " + std::to_string(seed) + (noisy ? ", noise" : ""));
      TraceScene scene = site.scene;
      if (!noisy) scene.scanners[0].noise = std::make_shared<const NoiseModel>();
      const auto tracer = make(scene);
      tracer->set_goal_density(goal);
      PassField all, skipped;
      const NetworkCounts exact = tracer->count(site.stations, 7, {true, false, &all}, {});
      const NetworkCounts part = tracer->count(site.stations, 7, {true, true, &skipped}, {});
      EXPECT_EQ(all.count, skipped.count);
      EXPECT_EQ(all.stations, skipped.stations);
      EXPECT_EQ(exact.points_on_surveyed, part.points_on_surveyed);

      // Each voxel is its own group, so groups are voxels.
      const std::vector<std::vector<TraceStation>> networks{site.stations};
      const std::vector<std::uint32_t> sizes{7};
      // All points, and as many as voxels need.
      for (const std::uint32_t stop_at : {0u, static_cast<std::uint32_t>(std::ceil(goal))}) {
        const NetworkCounts sampled = tracer->count_sampled(
            networks, sizes, {everything, static_cast<std::uint32_t>(everything.size()), true, stop_at}, {})[0];
        EXPECT_EQ(sampled.seen, exact.seen);
        EXPECT_EQ(sampled.shared, exact.shared);
        std::size_t differing = 0;
        for (std::size_t k = 0; k < everything.size(); ++k) {
          const NetworkCounts& voxel = sampled.groups[k];
          std::uint64_t mask = 0;
          for (std::uint32_t i = 0; i < 7; ++i) mask |= voxel.seen[i] << i;
          const bool full = all.count[k] >= goal;
          if (voxel.saturated != full || voxel.partial_points != (full ? 0 : all.count[k]) || mask != all.stations[k])
            ++differing;
        }
        EXPECT_EQ(differing, 0u) << "of " << everything.size() << ", stopped at " << stop_at;
        sampled_rays += sampled.rays;
      }
      points += std::accumulate(exact.points_on_surveyed.begin(), exact.points_on_surveyed.end(), std::uint64_t{0});
      all_rays += exact.rays;
      skipped_rays += part.rays;
    }
    if (testing::Test::HasFailure()) break;
  }
  EXPECT_GT(points, 1000u);
  EXPECT_LE(skipped_rays, all_rays);
  testing::Test::RecordProperty("points", std::to_string(points));
  testing::Test::RecordProperty("rays", std::to_string(all_rays) + " exact, " + std::to_string(skipped_rays) +
                                            " with skipping, " + std::to_string(sampled_rays) + " sampled");
  return {all_rays, skipped_rays};
}

}  // namespace vantage::test
