// SPDX-License-Identifier: Apache-2.0
#include "trace/embree/run_steps.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>

#include "support/trace_scenes.hpp"

namespace vantage {
namespace {

struct Found {
  std::uint64_t rays = 0, settled = 0;
};

// Goes along all runs of a station's picture. Checks that each ray is in one call, and each settled ray's point, noise
// included, in the voxel that it was settled in.
void go_along(const TraceScene& scene, const TraceStation& station, Found& found) {
  const StationRays rays(std::make_shared<const EmbreeScene>(scene), scene.scanners[0]);
  const TileEnds ends = all_tiles(rays.pattern());
  const Picture picture(rays, station, ends);
  ASSERT_TRUE(picture.drawable());
  const RunSteps steps(rays, station, picture);
  const RayPattern& pattern = rays.pattern();
  const auto hits = std::make_unique<Hits>();
  Picture::Strip strip;
  for (std::uint32_t s = 0; s < picture.strips(); ++s) {
    picture.draw(s, strip);
    for (std::uint32_t j = 0; j < strip.columns; ++j) {
      const std::uint32_t column = strip.first + j;
      for (std::uint32_t row = 0, end; row < pattern.rows(); row = end) {
        const std::uint32_t triangle = strip.triangles(j)[row];
        for (end = row + 1; end < pattern.rows() && strip.triangles(j)[end] == triangle;) ++end;
        if (triangle == Picture::kNone || !steps.pay(end - row)) continue;
        const Planes::Seen plane = rays.planes().seen(triangle, station.origin);
        std::uint32_t next = row;
        const auto settled = [&](const Float3& point, std::uint32_t many) {
          const auto cell = rays.grid().cell_of(point);
          for (const std::uint32_t last = next + many; next < last;) {
            hits->size = 0;
            for (; next < last && hits->size < RayBundle::kCapacity; ++next) {
              Float3 d{pattern.sin_zenith[next] * pattern.cos_azimuth[column],
                       pattern.sin_zenith[next] * pattern.sin_azimuth[column], pattern.cos_zenith[next]};
              if (station.turn) d = (*station.turn)(d);
              const std::uint64_t ray = rays.ray(next, column);
              const std::uint32_t k = hits->size++;
              hits->x[k] = d.x, hits->y[k] = d.y, hits->z[k] = d.z, hits->primitive[k] = triangle;
              hits->ray_low[k] = static_cast<std::uint32_t>(ray);
              hits->ray_high[k] = static_cast<std::uint32_t>(ray >> 32);
              const Float3 safe{RayCaster::safe(d.x), RayCaster::safe(d.y), RayCaster::safe(d.z)};
              rays.planes().distances<1>(plane, triangle, station.origin, &safe.x, &safe.y, &safe.z, hits->t + k);
            }
            rays.find_ranges(station, *hits, false);
            for (std::uint32_t k = 0; k < hits->size; ++k)
              ASSERT_EQ(rays.grid().cell_of(hits->point(station.origin, k)), cell) << "column " << column;
          }
          found.settled += many;
        };
        steps.along(row, end, column, triangle, plane, rays.surface().facet(triangle), settled,
                    [&](std::uint32_t from, std::uint32_t to) {
                      ASSERT_EQ(from, next);
                      ASSERT_LT(from, to);
                      next = to;
                    });
        ASSERT_EQ(next, end);
        found.rays += end - row;
      }
    }
  }
}

Scanner dense_scanner(double step_deg) {
  Scanner scanner;
  scanner.azimuth_step = Angle::degrees(2.5);
  scanner.zenith_step = Angle::degrees(step_deg);
  scanner.vertical_angle = Angle::degrees(300);
  scanner.min_range_m = 0.3;
  scanner.max_range_m = 130;
  return scanner;
}

// A slanted room with a ramp, voxels of many sizes, heads near the walls, upright and turned.
TEST(RunSteps, SettledPointsLieInTheirVoxel) {
  RandomStream random(11);
  for (int round = 0; round < 24; ++round) {
    const float tilt = test::between(random, -0.4, 0.4), wide = test::between(random, 3, 30);
    const auto room =
        test::SceneBuilder()
            .mesh(Role::surveyed, test::quad({-wide, -wide, 0}, {2 * wide, 0, tilt}, {0, 2 * wide, -tilt}), 0.2)
            .mesh(Role::surveyed, test::quad({-wide, 2, -1}, {2 * wide, tilt, 0}, {tilt, 0, 4}), 0.9)
            .mesh(Role::surveyed, test::quad({2, -wide, -1}, {tilt, 2 * wide, 0}, {0, tilt, 4}), 0.05)
            .finish();
    Scanner scanner = dense_scanner(test::between(random, 0.02, 0.06));
    if (round % 3 != 0) scanner.noise = rtc360_noise();
    if (round % 3 == 2) scanner.detection_range_m = 20;
    const TraceScene scene = test::trace_scene(room, scanner, test::between(random, 0.03, 0.6), 3);
    TraceStation station{
        {test::between(random, -2, 1.5), test::between(random, -2, 1.5), test::between(random, 1.2, 2)}};
    if (round % 2 == 1)
      station.turn = make_turn({.heading = Angle::degrees(test::between(random, 0, 360)),
                                .tilt = Angle::degrees(test::between(random, 0, 120))});
    SCOPED_TRACE("round " + std::to_string(round));
    Found found;
    go_along(scene, station, found);
    if (HasFatalFailure()) return;
    EXPECT_GT(found.rays, 10'000u);
  }
}

TEST(RunSteps, MostPointsOfADenseScanAreSettled) {
  const auto room = test::SceneBuilder()
                        .mesh(Role::surveyed, test::quad({-5, -5, 0.01f}, {10, 0, 0}, {0, 10, 0}))
                        .mesh(Role::surveyed, test::quad({-5, 3, 0}, {10, 0, 0}, {0, 0, 4}))
                        .finish();
  Scanner scanner = dense_scanner(0.034);
  scanner.noise = rtc360_noise();
  Found found;
  go_along(test::trace_scene(room, scanner, 0.1, 3), {{0.1f, 0.2f, 1.8f}}, found);
  EXPECT_GT(found.settled, found.rays / 2);
  found = {};
  scanner.zenith_step = Angle::degrees(0.5);  // fewer rays than steps take
  go_along(test::trace_scene(room, scanner, 0.1, 3), {{0.1f, 0.2f, 1.8f}}, found);
  EXPECT_LT(found.settled, found.rays / 20);
}

}  // namespace
}  // namespace vantage
