// SPDX-License-Identifier: Apache-2.0
#include "stress/coplanar.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "scan/pattern.hpp"
#include "scene/raw_scene.hpp"
#include "stress/comparison.hpp"

namespace vantage::test {
namespace {

struct Plane {
  Vec3 corner, along, up;  // unit, perpendicular
  Vec3 at(double x, double y) const { return corner + along * x + up * y; }
  Vec3 normal() const { return cross(along, up); }
};

void add(RawScene& raw, const char* name, Role role, const std::vector<Vec3>& positions,
         const std::vector<Triangle>& triangles) {
  const auto base = static_cast<std::uint32_t>(raw.positions.size()),
             count = static_cast<std::uint32_t>(triangles.size());
  raw.ranges.push_back({static_cast<std::uint32_t>(raw.triangles.size()), count, 0});
  raw.meshes.push_back({name, role, 0.5, count});
  for (const Vec3& p : positions) raw.positions.push_back(to_glm(p));
  for (const Triangle& t : triangles) raw.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
}

CoplanarFigures measure(const EngineInfo& engine, std::string name, const Plane& plane, int cells, double gap_m,
                        double step) {
  constexpr double width = 4, height = 3, left = 1.13, right = 2.87, low = 0.91, high = 2.37;
  const Vec3 lift = plane.normal() * gap_m;
  RawScene raw;
  add(raw, "wall", Role::blocking, {plane.at(0, 0), plane.at(width, 0), plane.at(width, height), plane.at(0, height)},
      {{0, 1, 2}, {0, 2, 3}});
  std::vector<Vec3> corners;
  std::vector<Triangle> triangles;
  const auto side = static_cast<std::uint32_t>(cells);
  for (std::uint32_t j = 0; j <= side; ++j)
    for (std::uint32_t i = 0; i <= side; ++i) {
      corners.push_back(plane.at(left + (right - left) * i / cells, low + (high - low) * j / cells) + lift);
      if (i == side || j == side) continue;
      const std::uint32_t a = j * (side + 1) + i, b = a + side + 1;
      triangles.push_back({a, a + 1, b});
      triangles.push_back({a + 1, b + 1, b});
    }
  add(raw, "sheet", Role::surveyed, corners, triangles);
  const std::shared_ptr<const SceneData> scene = finish_scene(std::move(raw), "the sheet on the wall");
  Scanner scanner;
  scanner.azimuth_step = scanner.zenith_step = Angle::degrees(step);
  const auto pattern = std::make_shared<const RayPattern>(make_pattern(scanner));
  const TraceScene site{scene,
                        std::make_shared<const VoxelGrid>(VoxelGrid::build(*scene, 0.1)),
                        {{pattern, std::make_shared<const NoiseModel>()}},
                        0,
                        false};
  const Vec3 head = plane.at(1.7, 1.3) + plane.normal() * 2.3;
  const TraceStation station{{static_cast<float>(head.x), static_cast<float>(head.y), static_cast<float>(head.z)}, 0};
  const auto tracer = make_tracer(engine, site);
  Tracer::RawChunk chunk;
  tracer->scan(station, 0, std::uint64_t{pattern->rows()} * pattern->columns(), Tracer::range | Tracer::primitive,
               chunk);

  CoplanarFigures f;
  f.name = std::move(name);
  f.apart = gap_m > 0;
  f.noted = std::ranges::any_of(
      scene->notes, [](const std::string& note) { return note.find("in one plane with") != std::string::npos; });
  const Vec3 o{station.origin.x, station.origin.y, station.origin.z}, n = plane.normal();
  const Vec3 corner = plane.corner + lift;
  for (std::uint32_t i = 0; i < pattern->rows(); ++i) {
    for (std::uint32_t j = 0; j < pattern->columns(); ++j) {
      const Vec3 d{pattern->sin_zenith[i] * pattern->cos_azimuth[j], pattern->sin_zenith[i] * pattern->sin_azimuth[j],
                   pattern->cos_zenith[i]};
      const double t = dot(n, corner - o) / dot(n, d);
      if (!(t > 0)) continue;
      const Vec3 p = o + d * t - corner;
      const double x = dot(p, plane.along), y = dot(p, plane.up);
      if (x < 1e-3 || x > width - 1e-3 || y < 1e-3 || y > height - 1e-3) continue;
      const std::size_t k = std::size_t{i} * pattern->columns() + j;
      ++f.wall_rays;
      if (chunk.primitive[k] == 0xFFFFFFFFu) {
        ++f.missed;
        continue;
      }
      const bool surveyed = scene->meshes[scene->mesh_of(chunk.primitive[k])].role == Role::surveyed;
      const double within = std::min({x - left, right - x, y - low, high - y});
      if (within < -1e-3) f.strayed += surveyed;
      if (within < 1e-3) continue;
      ++f.sheet_rays;
      f.counted += surveyed;
      f.off_m = std::max(f.off_m, std::abs(dot(n, o + d * static_cast<double>(chunk.range[k]) - corner)));
    }
  }
  return f;
}

}  // namespace

std::vector<CoplanarFigures> measure_coplanar(const EngineInfo& engine, double step) {
  const Plane square{{2, -2, 0}, {0, 1, 0}, {0, 0, 1}};
  const double a = 0.63, b = 0.41;  // turned and leaning
  const Vec3 along{-std::sin(a), std::cos(a), 0};
  const Vec3 up{std::cos(a) * std::sin(b), std::sin(a) * std::sin(b), std::cos(b)};
  const Plane oblique{{2.1, -1.3, 0.2}, along, up};
  return {measure(engine, "in one plane, square to an axis", square, 1, 0, step),
          measure(engine, "in one plane, oblique", oblique, 1, 0, step),
          measure(engine, "the same, sheet in 2048 triangles", oblique, 32, 0, step),
          measure(engine, "0.1 mm before it, oblique", oblique, 1, 1e-4, step),
          measure(engine, "1 mm before it, oblique", oblique, 1, 1e-3, step)};
}

}  // namespace vantage::test
