// SPDX-License-Identifier: Apache-2.0
#include "voxel/flat_windows.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include "clipped_voxels.hpp"
#include "trace/registration_sums.hpp"
#include "voxel/voxel_surfaces.hpp"
#include "voxel_scenes.hpp"

namespace vantage {
namespace {

constexpr double window_m = 0.25, half = window_m / 2;

std::vector<std::uint32_t> every_index(const VoxelGrid& grid, std::uint32_t stride = 1) {
  std::vector<std::uint32_t> voxel_indices;
  for (std::uint32_t voxel_index = 0; voxel_index < grid.size(); voxel_index += stride)
    voxel_indices.push_back(voxel_index);
  return voxel_indices;
}

// An open tube along Z, of `around` × `up` rectangles.
SceneData tube(double radius, double height, int around, int up) {
  SceneData scene;
  std::vector<Float3> positions;
  std::vector<Triangle> triangles;
  for (int j = 0; j <= up; ++j)
    for (int i = 0; i < around; ++i) {
      const double t = 2 * std::numbers::pi * i / around;
      positions.push_back({static_cast<float>(radius * std::cos(t)), static_cast<float>(radius * std::sin(t)),
                           static_cast<float>(height * j / up)});
    }
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(j * around + i % around); };
  for (int j = 0; j < up; ++j)
    for (int i = 0; i < around; ++i) {
      triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  test::add_mesh(scene, positions, triangles);
  return scene;
}

// Area of the surface in voxels that registration uses.
double counted(const SceneData& scene, const VoxelGrid& grid, const RegistrationModel& model = {}) {
  RayPattern pattern;
  pattern.zenith_step = pattern.azimuth_step = 0.001;
  const auto voxel_indices = every_index(grid);
  SurfaceFinder finder(scene, grid);
  const Patches patches = make_patches(finder, grid, voxel_indices, pattern, model);
  const auto surfaces = voxel_surfaces(scene, grid, voxel_indices);
  double some = 0, all = 0;
  for (std::size_t k = 0; k < surfaces.size(); ++k) {
    all += static_cast<double>(surfaces[k].extent);
    if (patches.patches[k].variance > 0) some += static_cast<double>(surfaces[k].extent);
  }
  return some / all;
}

// With long slivers, and with triangles far smaller than a window.
TEST(FlatWindows, HoldNothingOfAPipeHoweverFineVoxelsAre) {
  for (const int up : {1, 60})
    for (const double user_size : {0.1, 0.05, 0.02, 0.01}) {
      SCOPED_TRACE(user_size);
      const SceneData pipe = tube(0.1, 1, 48, up);
      const VoxelGrid grid = VoxelGrid::build(pipe, user_size);
      EXPECT_EQ(counted(pipe, grid), 0) << up;
      if (user_size == 0.02) {
        const auto alone = voxel_surfaces(pipe, grid, every_index(grid));
        EXPECT_GT(std::ranges::count_if(alone, [](const VoxelSurface& s) { return s.share > 0.9f; }),
                  static_cast<std::ptrdiff_t>(grid.size() / 2))
            << "by the voxel alone most are planes";
      }
    }
}

TEST(FlatWindows, HoldAllOfATankHoweverFineVoxelsAre) {
  for (const int up : {1, 60})
    for (const double user_size : {0.2, 0.1, 0.05}) {
      const SceneData tank = tube(1.5, 2, 200, up);
      EXPECT_GT(counted(tank, VoxelGrid::build(tank, user_size)), 0.99) << user_size << ' ' << up;
    }
}

// Scans have normals over larger neighbourhoods in a coarse model than in a fine one.
TEST(FlatWindows, AreHalfAPatchWide) {
  const SceneData pipe = tube(0.1, 1, 48, 60);
  const VoxelGrid grid = VoxelGrid::build(pipe, 0.02);
  EXPECT_EQ(counted(pipe, grid, {.patch_m = 0.5}), 0);
  EXPECT_GT(counted(pipe, grid, {.patch_m = 0.1}), 0.9);
}

TEST(FlatWindows, OfAThinWallHoldBothFaces) {
  for (const double thickness : {0.1, 0.06})
    for (const int cut : {1, 40}) {
      SceneData scene;
      test::add_patch(scene, {0, 0, 0}, {0, 2, 0}, {0, 0, 2}, cut, cut);
      test::add_patch(scene, {-thickness, 0, 0}, {0, 0, 2}, {0, 2, 0}, cut, cut);
      const VoxelGrid grid = VoxelGrid::build(scene, 0.04);
      int front = 0, back = 0;
      for (const VoxelSurface& surface : voxel_surfaces(scene, grid, every_index(grid), window_m)) {
        EXPECT_NEAR(surface.share, 1, 1e-6);
        (static_cast<double>(surface.point.x) > -thickness / 2 ? front : back)++;
      }
      EXPECT_GT(front, 1000);
      EXPECT_GT(back, 1000);
      EXPECT_EQ(counted(scene, grid), 1);
    }
}

// Large triangles are clipped exactly; small ones count by their middles, within a few percent.
TEST(FlatWindows, OfAWallOnAFloorHoldMoreThanHalf) {
  for (const int cut : {1, 100}) {
    SceneData scene;
    test::add_patch(scene, {0, 0, 0}, {2, 0, 0}, {0, 2, 0}, cut, cut);
    test::add_patch(scene, {0, 0, 0}, {0, 2, 0}, {0, 0, 2}, cut, cut);
    const VoxelGrid grid = VoxelGrid::build(scene, 0.04);
    int near = 0;
    for (const VoxelSurface& surface : voxel_surfaces(scene, grid, every_index(grid), window_m)) {
      const double x = static_cast<double>(surface.point.x), y = static_cast<double>(surface.point.y),
                   z = static_cast<double>(surface.point.z), up = std::max(x, z);
      if (up < grid.voxel_size() || up > 2 - half || y < half || y > 2 - half) continue;
      // The plane extends half + up beyond the edge; the other plane is half a window.
      const double expected = up < half ? (half + up) / (2 * half + up) : 1;
      EXPECT_NEAR(surface.share, expected, cut == 1 ? 1e-4 : 0.08) << up;
      near += up < half;
    }
    EXPECT_GT(near, 100);
  }
}

// Clips every triangle to every window with another clipper.
TEST(FlatWindows, HaveTheSharesThatClippingLeaves) {
  std::mt19937 rng(5);
  SceneData scene;
  const auto large = test::random_triangles(rng, 300, 1.0f, 0.4f);
  test::add_mesh(scene, large, test::separate_triangles(large.size()));
  test::add_mesh(scene, test::random_triangles(rng, 50, 1.0f, 0.4f), test::separate_triangles(150), Role::blocking);
  const VoxelGrid grid = VoxelGrid::build(scene, 0.05);
  for (const double side : {0.06, 0.25, 0.9}) {
    const auto voxel_indices = every_index(grid, 37);
    const auto surfaces = voxel_surfaces(scene, grid, voxel_indices);
    const auto shares = FlatWindows(scene, grid, side).shares(voxel_indices, surfaces);
    ASSERT_EQ(shares.size(), voxel_indices.size());
    for (std::size_t k = 0; k < voxel_indices.size(); ++k) {
      const auto& [px, py, pz] = surfaces[k].point;
      const Vec3 point{px, py, pz}, normal{surfaces[k].normal.x, surfaces[k].normal.y, surfaces[k].normal.z};
      double within = 0, other = 0, small = 0;
      for (std::size_t t = 0; t < large.size() / 3; ++t) {
        test::Polygon<double> polygon;
        std::array<double, 3> low{9, 9, 9}, high{-9, -9, -9};
        for (std::size_t c = 0; c < 3; ++c) {
          const Float3& p = scene.positions[3 * t + c];
          polygon.push_back({p.x, p.y, p.z});
          for (std::size_t axis = 0; axis < 3; ++axis) {
            low[axis] = std::min(low[axis], polygon.back()[axis]);
            high[axis] = std::max(high[axis], polygon.back()[axis]);
          }
        }
        const double extent = std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
        const std::array<double, 3> at{point.x, point.y, point.z};
        for (int axis = 0; axis < 3 && !polygon.empty(); ++axis) {
          const double middle = at[static_cast<std::size_t>(axis)];
          polygon = test::clip(test::clip(polygon, axis, middle - side / 2, -1), axis, middle + side / 2, 1);
        }
        const auto corner = [&](std::size_t c) { return Vec3{polygon[c][0], polygon[c][1], polygon[c][2]}; };
        Vec3 sum, moment;
        double weight = 0;
        for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
          const Vec3 part = cross(corner(i) - corner(0), corner(i + 1) - corner(0)) * 0.5;
          sum = sum + part;
          weight += std::sqrt(dot(part, part));
          moment = moment + (corner(0) + corner(i) + corner(i + 1)) * (std::sqrt(dot(part, part)) / 3);
        }
        const double area = std::sqrt(dot(sum, sum));
        if (!(area > 0)) continue;
        if (extent <= side / 4) small += area;
        if (std::abs(dot(sum, normal)) <= kOnePlaneCosine * area)
          other += area;
        else if (std::abs(dot(moment * (1 / weight) - point, normal)) <= side / 8)
          within += area;
      }
      if (small > 0 || surfaces[k].area == 0) continue;  // small triangles count by their middles
      ASSERT_NEAR(shares[k], within / (within + other), 1e-4) << side << ' ' << voxel_indices[k];
    }
  }
}

TEST(FlatWindows, DoNotDependOnOtherVoxelsOrThreads) {
  SceneData scene = tube(0.3, 1, 60, 12);
  test::add_patch(scene, {-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 3, 50);
  const VoxelGrid grid = VoxelGrid::build(scene, 0.03);
  const auto all = voxel_surfaces(scene, grid, every_index(grid), window_m);
  for (const std::uint32_t stride : {3u, 101u}) {
    const auto some = every_index(grid, stride);
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const auto few = voxel_surfaces(scene, grid, some, window_m);
    for (std::size_t k = 0; k < some.size(); ++k) ASSERT_EQ(few[k].share, all[some[k]].share);
  }
  const auto of_voxels = voxel_surfaces(scene, grid, every_index(grid));
  for (std::size_t k = 0; k < all.size(); ++k) {
    ASSERT_LE(all[k].share, of_voxels[k].share);
    ASSERT_EQ(all[k].area, of_voxels[k].area);
    ASSERT_EQ(all[k].point, of_voxels[k].point);
  }
}

// Many blocks of cells, so that windows reach small triangles of other blocks.
TEST(FlatWindows, HoldTheSmallTrianglesOfTheirNeighbours) {
  std::mt19937 rng(9);
  SceneData scene;
  const auto small = test::random_triangles(rng, 6000, 4.0f, 0.02f);
  test::add_mesh(scene, small, test::separate_triangles(small.size()));
  const VoxelGrid grid = VoxelGrid::build(scene, 0.04);
  const double side = 0.4;
  const auto voxel_indices = every_index(grid, 29);
  const auto surfaces = voxel_surfaces(scene, grid, voxel_indices);
  const auto shares = FlatWindows(scene, grid, side).shares(voxel_indices, surfaces);
  std::size_t of_several = 0;
  for (std::size_t k = 0; k < voxel_indices.size(); ++k) {
    if (surfaces[k].area == 0) continue;
    const auto& [px, py, pz] = surfaces[k].point;
    const Vec3 point{px, py, pz}, normal{surfaces[k].normal.x, surfaces[k].normal.y, surfaces[k].normal.z};
    double within = 0, other = 0;
    int held = 0;
    for (std::size_t t = 0; t < small.size() / 3; ++t) {
      const auto corner = [&](std::size_t c) {
        const Float3& p = scene.positions[3 * t + c];
        return Vec3{p.x, p.y, p.z};
      };
      const Vec3 twice = cross(corner(1) - corner(0), corner(2) - corner(0));
      const Vec3 off = (corner(0) + corner(1) + corner(2)) * (1.0 / 3) - point;
      const double area = std::sqrt(dot(twice, twice)) / 2;
      if (std::max({std::abs(off.x), std::abs(off.y), std::abs(off.z)}) > side / 2) continue;
      ++held;
      if (std::abs(dot(twice, normal)) <= kOnePlaneCosine * 2 * area)
        other += area;
      else if (std::abs(dot(off, normal)) <= side / 8)
        within += area;
    }
    of_several += held > 1;
    if (within + other > 0) {
      ASSERT_NEAR(shares[k], within / (within + other), 1e-4) << voxel_indices[k];
    }
  }
  EXPECT_GT(of_several, 100u);
}

TEST(FlatWindows, EndEarlyWhenStopped) {
  SceneData scene;
  test::add_patch(scene, {-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 3, 50);
  const VoxelGrid grid = VoxelGrid::build(scene, 0.03);
  std::stop_source stop;
  stop.request_stop();
  EXPECT_TRUE(voxel_surfaces(scene, grid, every_index(grid), window_m, stop.get_token()).empty());
  EXPECT_EQ(voxel_surfaces(scene, grid, every_index(grid), window_m).size(), grid.size());
}

// The window is wider than the whole scene.
TEST(FlatWindows, MayBeWiderThanTheGrid) {
  SceneData scene;
  test::add_patch(scene, {0, 0, 0}, {0.3, 0, 0}, {0, 0.3, 0}, 4, 4);
  test::add_patch(scene, {0, 0, 0}, {0, 0.3, 0}, {0, 0, 0.1});
  const VoxelGrid grid = VoxelGrid::build(scene, 0.05);
  for (const VoxelSurface& surface : voxel_surfaces(scene, grid, every_index(grid), 5)) {
    const bool floor = std::abs(surface.normal.z) > 0.9f;
    EXPECT_NEAR(surface.share, floor ? 0.75 : 0.25, 1e-6);
  }
}

}  // namespace
}  // namespace vantage
