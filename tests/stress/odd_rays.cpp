// SPDX-License-Identifier: Apache-2.0
#include "stress/odd_rays.hpp"

#include <cmath>
#include <numbers>

#include "scan/pattern.hpp"

namespace vantage::test {
namespace {

using std::numbers::pi;

struct OddTriangles {
  std::vector<Vec3> positions;
  std::vector<Triangle> triangles;
  void quad(const Vec3& corner, const Vec3& along, const Vec3& up) {
    const auto first = static_cast<std::uint32_t>(positions.size());
    for (const Vec3& p : {corner, corner + along, corner + along + up, corner + up}) positions.push_back(p);
    triangles.push_back({first, first + 1, first + 2});
    triangles.push_back({first, first + 2, first + 3});
  }
  void box(const Vec3& low, const Vec3& high) {
    const Vec3 s = high - low;
    const Vec3 x{s.x, 0, 0}, y{0, s.y, 0}, z{0, 0, s.z};
    quad(low, y, x);
    quad(low + z, x, y);
    quad(low, x, z);
    quad(low + y, z, x);
    quad(low, z, y);
    quad(low + x, y, z);
  }
};

TraceScene scene_of(const OddTriangles& t, std::shared_ptr<const RayPattern> pattern, double voxel_m) {
  const Scene scene = Scene::from_triangles(t.positions, t.triangles);
  const auto data = std::make_shared<const SceneData>(scene.data());
  return {data,
          std::make_shared<const VoxelGrid>(VoxelGrid::build(*data, voxel_m)),
          {{std::move(pattern), std::make_shared<const NoiseModel>()}},
          0,
          false};
}

std::shared_ptr<RayPattern> pattern_of(double step_degrees, double least, double most) {
  Scanner scanner;
  scanner.vertical_angle = Angle::degrees(360);
  scanner.heading = Angle::degrees(13.7);
  scanner.azimuth_step = scanner.zenith_step = Angle::degrees(step_degrees);
  scanner.min_range_m = least;
  scanner.max_range_m = most;
  return std::make_shared<RayPattern>(make_pattern(scanner));
}

TraceStation at(double x, double y, double z) {
  return {{static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)}, 0};
}

// A room with a box on its floor, and a many-sided tank beside it.
OddTriangles furnished_room() {
  OddTriangles t;
  t.box({-4, -3, 0}, {4, 3, 3});
  t.box({1.1, 0.7, 0.2}, {2.3, 1.9, 1.7});
  const int sides = 24;
  for (int k = 0; k < sides; ++k) {
    const double a = 2 * pi * k / sides, b = 2 * pi * (k + 1) / sides;
    t.quad({-2 + 0.6 * std::cos(a), 0.6 * std::sin(a), 0.1},
           Vec3{0.6 * (std::cos(b) - std::cos(a)), 0.6 * (std::sin(b) - std::sin(a)), 0}, {0, 0, 1.9});
  }
  return t;
}

}  // namespace

std::vector<OddRays> odd_rays(double step) {
  std::vector<OddRays> all;
  const OddTriangles room = furnished_room();
  all.push_back({"station inside a box, inside a tank",
                 scene_of(room, pattern_of(step, 0.1, 60), 0.1),
                 {at(1.7, 1.3, 0.9), at(-2, 0.02, 1)}});
  // On the wall x = 4, the box's top, its edge and its corner; then 1e-6 m (4 ulp at 4 m: 2e-6) off.
  const std::vector<TraceStation> on{at(4, 0.3, 1.2), at(1.7, 1.3, 1.7), at(1.1, 1.3, 1.7), at(1.1, 0.7, 1.7)};
  const std::vector<TraceStation> off{at(4 - 1e-6, 0.3, 1.2), at(1.7, 1.3, 1.7 + 1e-6), at(1.7, 1.3, 1.7 - 1e-6),
                                      at(1.1 - 1e-6, 1.3, 1.1)};
  all.push_back({"station on a surface, d_min 0.1 m", scene_of(room, pattern_of(step, 0.1, 60), 0.1), on});
  all.push_back({"station on a surface, d_min 0", scene_of(room, pattern_of(step, 0, 60), 0.1), on, true});
  all.push_back({"station 1e-6 m off a surface, d_min 0.1 m", scene_of(room, pattern_of(step, 0.1, 60), 0.1), off});
  all.push_back({"station 1e-6 m off a surface, d_min 0", scene_of(room, pattern_of(step, 0, 60), 0.1), off, true});

  // A full sphere of rays and a wall 2 m away: the rings where the range begins and ends lie on the wall.
  OddTriangles wall;
  wall.quad({2, -6, -6}, {0, 12, 0}, {0, 0, 12});
  all.push_back({"d_min and d_max across a wall", scene_of(wall, pattern_of(step, 2.5, 5), 0.1), {at(0, 0, 0)}});
  // Straight ahead, the hit is at exactly d_min, or d_max.
  for (const bool least : {true, false}) {
    auto straight = std::make_shared<RayPattern>();
    for (int k = -50; k <= 50; ++k) {
      straight->sin_zenith.push_back(static_cast<float>(std::cos(k * 1e-8)));
      straight->cos_zenith.push_back(static_cast<float>(k * 1e-8));
      straight->cos_azimuth.push_back(1);
      straight->sin_azimuth.push_back(static_cast<float>(k * 1e-8));
    }
    straight->min_range = least ? 2.0f : 0.5f;
    straight->max_range = least ? 9.0f : 2.0f;
    all.push_back({least ? "hits at exactly d_min" : "hits at exactly d_max",
                   scene_of(wall, straight, 0.1),
                   {at(0, 0, 0)},
                   true});
  }

  // Ground seen at 80° to 89.99° from its normal, up to 8594 m away.
  OddTriangles ground;
  for (int i = 0; i < 20; ++i)
    for (int j = 0; j < 20; ++j)
      ground.quad({-10'000 + 1000.0 * i, -10'000 + 1000.0 * j, 0}, {1000, 0, 0}, {0, 1000, 0});
  auto grazing = std::make_shared<RayPattern>();
  for (int k = 0; k <= 120; ++k) {
    const double from_plane = 10 * std::pow(0.001, k / 120.0) * pi / 180;  // 10° to 0.01°
    grazing->sin_zenith.push_back(static_cast<float>(std::cos(from_plane)));
    grazing->cos_zenith.push_back(static_cast<float>(-std::sin(from_plane)));
  }
  for (double a = 0.05; a < 360; a += 2 * step) {
    grazing->cos_azimuth.push_back(static_cast<float>(std::cos(a * pi / 180)));
    grazing->sin_azimuth.push_back(static_cast<float>(std::sin(a * pi / 180)));
  }
  grazing->min_range = 1;
  grazing->max_range = 9000;
  all.push_back({"grazing, 80° to 89.99°", scene_of(ground, grazing, 500), {at(0.3, 0.2, 1.5)}});

  // Straight up and down, and within 1e-7 to 0.1° of that, in a room with vertices of floor and ceiling there.
  auto poles = std::make_shared<RayPattern>();
  for (const double sign : {1.0, -1.0}) {
    poles->sin_zenith.push_back(0);
    poles->cos_zenith.push_back(static_cast<float>(sign));
    for (int k = 0; k < 60; ++k) {
      const double zenith = 1e-7 * std::pow(17'000, k / 59.0);
      poles->sin_zenith.push_back(static_cast<float>(std::sin(zenith)));
      poles->cos_zenith.push_back(static_cast<float>(sign * std::cos(zenith)));
    }
  }
  for (int k = 0; k < 360; ++k) {
    poles->cos_azimuth.push_back(static_cast<float>(std::cos(k * pi / 180)));
    poles->sin_azimuth.push_back(static_cast<float>(std::sin(k * pi / 180)));
  }
  poles->min_range = 0.1f;
  poles->max_range = 60;
  all.push_back({"poles", scene_of(room, poles, 0.1), {at(0.31, 0.17, 1.2), at(0, 0, 1.5)}});
  return all;
}

}  // namespace vantage::test
