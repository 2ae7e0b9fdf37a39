// SPDX-License-Identifier: Apache-2.0
#include "voxel/voxel_surfaces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/glm.hpp"
#include "core/parallel.hpp"
#include "voxel/clipped_polygon.hpp"
#include "voxel/voxel_bricks.hpp"

namespace vantage {
namespace {

using Point = ClippedPolygon::Point;

// Sheets of a plane further apart than this share of a voxel are two; nearer ones are a single sheet wound both ways.
constexpr double kOneSheetShare = 0.01;

void clip_to_unit_cube(ClippedPolygon& polygon) {
  for (int axis = 0; axis < 3 && !polygon.empty(); ++axis) {
    polygon.clip(axis, 0, -1);
    polygon.clip(axis, 1, 1);
  }
}

// Returns the area, over (voxel size)², of a plane's section with the unit cube.
double section(const Point& point, const Point& normal) {
  const Point other = std::abs(normal.x) < 0.6 ? Point(1, 0, 0) : Point(0, 1, 0);
  const Point u = normalize(cross(normal, other)) * 4.0, v = cross(normal, u);  // beyond every corner of the cube
  ClippedPolygon square;
  for (const auto& [s, t] : {std::array{-1.0, -1.0}, {1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}})
    square.add(point + u * s + v * t);
  clip_to_unit_cube(square);
  return square.empty() ? 0 : length(square.area());
}

// Part of one triangle within a voxel.
struct Part {
  Point along;  // unit normal by the winding
  Point centroid;
  double area, diffuse;
  std::uint32_t mesh;
};

// Parts with the normal of one plane, separated into those wound as the first and the others.
struct Plane {
  Point axis{0, 0, 0};  // Σ area · normal, turned as the first part's
  std::array<double, 2> area{};
  std::array<Point, 2> centre{Point(0), Point(0)};  // Σ area · centroid
  double diffuse = 0;

  double all() const { return area[0] + area[1]; }
  bool takes(const Part& part) const { return std::abs(dot(axis, part.along)) > kOnePlaneCosine * length(axis); }
  void add(const Part& part) {
    const bool back = dot(axis, part.along) < 0;
    axis += part.along * (back ? -part.area : part.area);
    area[back] += part.area;
    centre[back] += part.centroid * part.area;
    diffuse += part.diffuse * part.area;
  }
};

// Returns parts in grid units, relative to the voxel's low corner.
std::vector<Part> parts_of(const SceneData& scene, const GridTransform& transform, const Point& low,
                           std::span<const std::uint32_t> triangles) {
  std::vector<Part> parts;
  for (const std::uint32_t t : triangles) {
    ClippedPolygon polygon;
    for (const auto& corner : transform.corners(scene.corners(t)))
      polygon.add(Point(corner[0], corner[1], corner[2]) - low);
    clip_to_unit_cube(polygon);
    if (polygon.empty()) continue;
    const Point along = polygon.area();
    const double area = length(along);
    if (!(area > 0)) continue;
    const std::uint32_t mesh = scene.mesh_of(t);
    parts.push_back({along / area, polygon.centroid(), area, scene.meshes[mesh].diffuse, mesh});
  }
  // Largest first, so that small parts at an edge do not define the planes.
  std::stable_sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.area > b.area; });
  return parts;
}

// Returns the mesh with most area; the lower one of equals. REQUIRES: at least one part.
std::uint32_t largest_mesh(std::span<const Part> parts) {
  std::vector<std::pair<std::uint32_t, double>> meshes;  // a few at most
  for (const Part& part : parts) {
    auto mesh = std::find_if(meshes.begin(), meshes.end(), [&](const auto& m) { return m.first == part.mesh; });
    if (mesh == meshes.end()) mesh = meshes.insert(meshes.end(), {part.mesh, 0.0});
    mesh->second += part.area;
  }
  return std::max_element(meshes.begin(), meshes.end(),
                          [](const auto& a, const auto& b) {
                            return a.second != b.second ? a.second < b.second : a.first > b.first;
                          })
      ->first;
}

VoxelSurface surface_of(std::span<const Part> parts, const GridTransform& transform, const Point& low) {
  const double size = 1 / transform.inverse_size;
  const auto local = [&](const Point& p) {
    const Point q = (low + p) * size;
    return Float3{static_cast<float>(transform.min[0] + q.x), static_cast<float>(transform.min[1] + q.y),
                  static_cast<float>(transform.min[2] + q.z)};
  };
  VoxelSurface surface{.point = local(Point(0.5)), .normal = {0, 0, 1}};
  std::vector<Plane> planes;
  double total = 0;
  for (const Part& part : parts) {
    total += part.area;
    auto plane = std::find_if(planes.begin(), planes.end(), [&](const Plane& p) { return p.takes(part); });
    if (plane == planes.end()) {
      planes.emplace_back();
      plane = planes.end() - 1;
    }
    plane->add(part);
  }
  if (!(total > 0)) return surface;
  const Plane& plane =
      *std::max_element(planes.begin(), planes.end(), [](const Plane& a, const Plane& b) { return a.all() < b.all(); });
  const Point normal = normalize(plane.axis);
  double area = plane.all();
  Point centre = (plane.centre[0] + plane.centre[1]) / area;
  if (plane.area[0] > 0 && plane.area[1] > 0) {
    const Point front = plane.centre[0] / plane.area[0], back = plane.centre[1] / plane.area[1];
    if (std::abs(dot(normal, front - back)) > kOneSheetShare) {
      area = std::max(plane.area[0], plane.area[1]);
      centre = plane.area[0] >= plane.area[1] ? front : back;
    }
  }
  surface.point = local(centre);
  surface.normal = {static_cast<float>(normal.x), static_cast<float>(normal.y), static_cast<float>(normal.z)};
  surface.area = static_cast<float>(std::min(area, section(centre, normal)) * size * size);
  surface.share = static_cast<float>(plane.all() / total);
  surface.extent = static_cast<float>(std::min(total, 1.0) * size * size);
  surface.mesh = largest_mesh(parts);
  surface.diffuse = static_cast<float>(plane.diffuse / plane.all());
  return surface;
}

}  // namespace

SurfaceFinder::SurfaceFinder(std::shared_ptr<const SceneData> scene, std::shared_ptr<const VoxelGrid> grid,
                             std::shared_ptr<SampleTriangles> triangles)
    : scene_(std::move(scene)), grid_(std::move(grid)), triangles_(std::move(triangles)) {}

SurfaceFinder::SurfaceFinder(const SceneData& scene, const VoxelGrid& grid)
    : scene_(std::shared_ptr<void>(), &scene),
      grid_(std::shared_ptr<void>(), &grid),
      triangles_(std::make_shared<SampleTriangles>(scene_, grid_)) {}

std::vector<VoxelSurface> SurfaceFinder::find(std::span<const std::uint32_t> voxel_indices, double window_m,
                                              const std::stop_token& stop) {
  const VoxelTriangles touching = triangles_->touching(voxel_indices, 0);
  const GridTransform transform{{grid_->min()[0], grid_->min()[1], grid_->min()[2]}, grid_->inverse_size()};
  std::vector<VoxelSurface> surfaces(voxel_indices.size());
  parallel::for_all(
      tbb::blocked_range<std::size_t>(0, voxel_indices.size()), [&](const tbb::blocked_range<std::size_t>& range) {
        for (std::size_t i = range.begin(); i != range.end() && !stop.stop_requested(); ++i) {
          const auto [x, y, z] = morton_decode(grid_->key(voxel_indices[i]));
          const Point low(x, y, z);
          const auto triangles =
              std::span(touching.triangle).subspan(touching.offset[i], touching.offset[i + 1] - touching.offset[i]);
          surfaces[i] = surface_of(parts_of(*scene_, transform, low, triangles), transform, low);
          if (surfaces[i].extent == 0 && !triangles.empty()) surfaces[i].mesh = scene_->mesh_of(triangles.front());
        }
      });
  if (stop.stop_requested()) return {};
  if (window_m > grid_->voxel_size()) {
    if (!windows_ || windows_->window_m() != window_m)
      windows_ = std::make_unique<const FlatWindows>(*scene_, *grid_, window_m);
    const std::vector<float> shares = windows_->shares(voxel_indices, surfaces, stop);
    if (stop.stop_requested()) return {};
    for (std::size_t i = 0; i < voxel_indices.size(); ++i) surfaces[i].share = std::min(surfaces[i].share, shares[i]);
  }
  return surfaces;
}

std::vector<VoxelSurface> voxel_surfaces(const SceneData& scene, const VoxelGrid& grid,
                                         std::span<const std::uint32_t> voxel_indices, double window_m,
                                         const std::stop_token& stop) {
  return SurfaceFinder(scene, grid).find(voxel_indices, window_m, stop);
}

}  // namespace vantage
