// SPDX-License-Identifier: Apache-2.0
#include "stress/swept_wall.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "voxel/voxel_grid.hpp"

namespace vantage::test {
namespace {

constexpr double user_size_m = 0.2, spacing_m = 0.04;

struct Triangles {
  std::vector<Vec3> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  void quad(const Vec3& corner, const Vec3& along, const Vec3& up) {
    const auto first = static_cast<std::uint32_t>(positions.size());
    for (const Vec3& p : {corner, corner + along, corner + along + up, corner + up}) positions.push_back(p);
    triangles.push_back({first, first + 1, first + 2});
    triangles.push_back({first, first + 2, first + 3});
  }
};

Vec3 on_axis(int axis, double along, double second, double third) {
  return axis == 0 ? Vec3{along, second, third} : axis == 1 ? Vec3{second, along, third} : Vec3{second, third, along};
}

double component(const Vec3& p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

Scene room(int axis, double place) {
  Triangles t;
  t.quad({-5, -5, 0}, {10, 0, 0}, {0, 0, 5});
  t.quad({5, -5, 0}, {0, 10, 0}, {0, 0, 5});
  t.quad({5, 5, 0}, {-10, 0, 0}, {0, 0, 5});
  t.quad({-5, 5, 0}, {0, -10, 0}, {0, 0, 5});
  t.quad({-5, -5, 0}, {10, 0, 0}, {0, 10, 0});
  t.quad(on_axis(axis, place, -1.53, 1.07), on_axis(axis, 0, 3.1, 0), on_axis(axis, 0, 0, 2.1));
  return Scene::from_triangles(t.positions, t.triangles);
}

}  // namespace

SweepFigures sweep_wall(const EngineInfo& engine, int axis, int steps) {
  const VoxelGrid grid = VoxelGrid::build(room(axis, 1.03).data(), user_size_m);
  const double size = grid.voxel_size(), min = static_cast<double>(grid.min()[static_cast<std::size_t>(axis)]);
  const double face = min + size * std::ceil((1.0 - min) / size);
  Scanner scanner;
  scanner.azimuth_step = scanner.zenith_step = Angle::degrees(1);
  std::vector<double> places;
  for (int step = 0; step <= steps; ++step) places.push_back(face + size * step / steps);
  for (const double at : {face, face + size}) {  // and every float around either face
    float place = static_cast<float>(at);
    for (int ulp = 0; ulp < 3; ++ulp) place = std::nextafter(place, -1e9f);
    for (int ulp = 0; ulp < 7; ++ulp, place = std::nextafter(place, 1e9f)) places.push_back(static_cast<double>(place));
  }
  SweepFigures figures;
  for (const double place : places) {
    Simulator simulator(room(axis, place), scanner,
                        {.engine = engine.engine,
                         .device_index = engine.device_index,
                         .user_size_m = user_size_m,
                         .point_spacing_m = spacing_m});
    VoxelField field;
    simulator.evaluate({{on_axis(axis, axis == 2 ? place + 2.37 : place - 2.37, 0.11, 2.03)}},
                       {.overlap = false, .field = &field});
    double sum = 0, voxels = 0;
    for (std::uint64_t voxel_index = 0; voxel_index < field.count.size(); ++voxel_index) {
      const Vec3 c = simulator.voxel_centre(voxel_index);
      const double second = component(c, axis == 0 ? 1 : 0), third = component(c, axis == 2 ? 1 : 2);
      // The wall's own voxels, one voxel in from its outline: all that it marks on either side of its plane.
      if (std::abs(component(c, axis) - place) > size || second < -1.53 + size || second > 1.57 - size ||
          third < 1.07 + size || third > 3.17 - size)
        continue;
      sum += std::min(field.count[voxel_index] / simulator.goal_density(), 1.0);
      voxels += 1;
    }
    figures.least = std::min(figures.least, sum / voxels);
    figures.most = std::max(figures.most, sum / voxels);
  }
  return figures;
}

}  // namespace vantage::test
