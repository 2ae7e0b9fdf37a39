// SPDX-License-Identifier: Apache-2.0
#include "trace/embree/sampled_voxels.hpp"

#include <algorithm>
#include <cmath>

#include "core/parallel.hpp"
#include "trace/embree/seen_triangle.hpp"
#include "trace/embree/surface.hpp"

namespace vantage {
namespace {

using Corners = std::array<Vec3, 3>;

double length(const Vec3& v) { return std::sqrt(dot(v, v)); }

struct ExactPlane {
  Vec3 normal;
  double offset = 0, slenderness = HUGE_VAL, diffuse = 1, tilt = 0;
  Box box;  // around its triangles
};

ExactPlane plane_of(const Corners& t) {
  const Vec3 n = cross(t[1] - t[0], t[2] - t[0]);
  const double area = length(n);
  if (!(area > 0)) return {};
  return {n * (1 / area), dot(n, t[0]) / area, SeenTriangle::slenderness(t[0], t[1], t[2], area), 1, 0, {}};
}

SampledVoxels::Piece piece_of(const Corners& t) {
  SampledVoxels::Piece piece{};
  const Vec3 normal = plane_of(t).normal;
  const std::array<double, 3> lengths{length(t[1] - t[0]), length(t[2] - t[1]), length(t[0] - t[2])};
  const double longest = std::max({lengths[0], lengths[1], lengths[2]});
  piece.longest = std::nextafter(static_cast<float>(longest), HUGE_VALF);
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3& from = t[k];
    const Vec3 across = cross(normal, t[(k + 1) % 3] - from);
    const double size = length(across);
    const Vec3 inwards = size > 0 ? across * (1 / size) : Vec3{};
    piece.edge[k] = {narrow(inwards), static_cast<float>(dot(inwards, from)),
                     std::nextafter(static_cast<float>(longest / lengths[k]), HUGE_VALF)};
  }
  return piece;
}

// Returns true if the plane passes the cube around the origin.
bool crosses(const ExactPlane& plane, double half) {
  const double across = std::abs(plane.normal.x) + std::abs(plane.normal.y) + std::abs(plane.normal.z);
  return std::abs(plane.offset) <= half * across;
}

}  // namespace

SampledVoxels::SampledVoxels(const SceneData& scene, const VoxelGrid& grid, SampleTriangles& triangles,
                             std::span<const std::uint32_t> voxel_indices, double pad, double reach, double margin)
    : pad_(pad),
      reach_(reach),
      voxel_indices_(voxel_indices.begin(), voxel_indices.end()),
      offset_(voxel_indices.size() + 1),
      crossing_(voxel_indices.size()) {
  const VoxelTriangles lists = triangles.touching(voxel_indices, margin);
  const std::size_t n = voxel_indices.size();
  around_.resize(n);
  pieces_.resize(lists.triangle.size());
  std::vector<Plane> planes(lists.triangle.size());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    cells_[axis].resize(n);
  }
  const double side = grid.voxel_size();
  // A hit's point lies on its plane, apart from rounding.
  const double half = side / 2 + pad, wide = half + reach + 2 * pad, beside = margin - reach + pad;

  parallel::for_all(std::size_t{0}, n, [&](std::size_t i) {
    const std::array<std::uint32_t, 3> cell = morton_decode(grid.key(voxel_indices[i]));
    const Vec3 middle =
        Vec3{grid.min()[0], grid.min()[1], grid.min()[2]} + Vec3{cell[0] + 0.5, cell[1] + 0.5, cell[2] + 0.5} * side;
    const std::uint32_t first = lists.offset[i], end = lists.offset[i + 1];
    const auto corners_of = [&](std::uint32_t k) {
      const auto p = scene.corners(lists.triangle[k]);
      return Corners{widen(p[0]) - middle, widen(p[1]) - middle, widen(p[2]) - middle};
    };
    std::vector<ExactPlane> own;
    std::vector<std::pair<std::size_t, std::uint32_t>> of;  // plane and triangle
    for (std::uint32_t k = first; k < end && own.size() <= kMostPlanes; ++k) {
      const Corners corners = corners_of(k);
      const ExactPlane plane = plane_of(corners);
      // Merges planes so close that no hit in the cube moves by a noticeable part of the pad, at any slant.
      const auto same = [&](const ExactPlane& other) {
        const double sign = dot(plane.normal, other.normal) < 0 ? -1 : 1;
        return std::abs(plane.offset * sign - other.offset) + 3 * wide * largest(plane.normal * sign - other.normal) <=
               pad * 0x1p-15;
      };
      const auto known = std::find_if(own.begin(), own.end(), same);
      of.emplace_back(known - own.begin(), k);
      ExactPlane& all = known == own.end() ? own.emplace_back(plane) : *known;
      for (const Vec3& corner : corners) all.box.extend(corner);
      all.slenderness = std::max(all.slenderness, plane.slenderness);
      all.diffuse = std::min(all.diffuse, scene.meshes[scene.mesh_of(lists.triangle[k])].diffuse);
      all.tilt = std::max(all.tilt, tilt_of(scene, lists.triangle[k], all.normal));
    }
    if (own.size() > kMostPlanes) own.clear();

    for (std::size_t axis = 0; axis < 3; ++axis) cells_[axis][i] = static_cast<std::int32_t>(cell[axis]);
    Box around;
    std::uint32_t piece = first, plane = first;
    for (const bool now : {true, false}) {
      for (std::size_t k = 0; k < own.size(); ++k) {
        if (crosses(own[k], wide) != now) continue;
        if (now) around.extend(own[k].box.min), around.extend(own[k].box.max);
        const std::uint32_t from = piece;
        for (const auto& [place, triangle] : of) {
          if (place == k) pieces_[piece++] = piece_of(corners_of(triangle));
        }
        planes[plane++] = {narrow(own[k].normal),
                           static_cast<float>(own[k].offset),
                           std::nextafter(static_cast<float>(own[k].slenderness), HUGE_VALF),
                           static_cast<float>(own[k].diffuse),
                           static_cast<float>(own[k].tilt),
                           from,
                           piece};
      }
      if (now) crossing_[i] = plane - first;
    }
    offset_[i + 1] = plane - first;
    const Vec3 margins{beside, beside, beside};
    if (!around.empty()) around_[i] = {narrow(around.min - margins), narrow(around.max + margins)};
  });
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint32_t count = offset_[i + 1];
    offset_[i + 1] = offset_[i] + count;
    std::copy_n(planes.begin() + lists.offset[i], count, planes.begin() + offset_[i]);
  }
  planes_.assign(planes.begin(), planes.begin() + offset_[n]);
  for (std::size_t level = 0; level < kGroupSizes.size(); ++level)
    for (std::size_t first = 0; first < n; first += kGroupSizes[level]) {
      Cells& cells = groups_[level].emplace_back();
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto of = std::span(cells_[axis]).subspan(first, std::min(kGroupSizes[level], n - first));
        cells.low[axis] = std::ranges::min(of), cells.high[axis] = std::ranges::max(of);
      }
    }
}

bool SampledVoxels::made_for(std::span<const std::uint32_t> voxel_indices, double pad, double reach) const {
  return pad_ == pad && reach_ == reach && std::ranges::equal(voxel_indices_, voxel_indices);
}

}  // namespace vantage
