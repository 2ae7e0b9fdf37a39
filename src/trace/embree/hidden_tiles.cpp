// SPDX-License-Identifier: Apache-2.0
// Finds the parts of a voxel's window that are hidden, or whose rays pass beside the voxel's surfaces.
#include <algorithm>
#include <cmath>
#include <limits>

#include "trace/embree/hit_margins.hpp"
#include "trace/embree/spread_units.hpp"
#include "trace/embree/voxel_counter.hpp"

namespace vantage {
namespace {

// Least number of rays in a tile that pays for a probe and for tests of a few triangles.
constexpr std::uint32_t kTile = 64;
// Upper bound on the widening of a cone of directions by their rounding.
constexpr double kConeDoubt = 1e-6;

}  // namespace

// Finds tiles of the window in which a triangle hides all rays that come near the voxel. Halves tiles recursively; a
// probe along a ray in the middle meets a triangle that may hide the whole tile.
SampledVoxelCounter::Tiles SampledVoxelCounter::find_hidden(const Look& look, const RayRanges& window) {
  Tiles tiles;
  const SpreadUnits units(window, false);
  const std::uint32_t rows = window.rows.end - window.rows.begin, of_row = units.of_row();
  std::uint32_t side = 1;  // tiles
  while (side < 8 && rows * of_row * SpreadUnits::kUnit / (4 * side * side) >= kTile) side *= 2;
  if (side == 1) return tiles;
  const auto shift_of = [&](std::uint32_t n) {
    std::uint32_t shift = 0;
    while (((n - 1) >> shift) >= side) ++shift;
    return shift;
  };
  tiles.row_shift = shift_of(rows), tiles.unit_shift = shift_of(of_row);

  const RayPattern& pattern = rays_->pattern();
  const std::span<const Ahead> planes = planes_of(look);
  const double pad = 2 * pad_, nearest = static_cast<double>(look.cube.nearest) * (1 - kTrust),
               start = static_cast<double>(bundle_.start);
  // A plane turned so that it is above the head, with cosines, over slenderness, as in fill_nearest().
  struct Above {
    Vec3 normal;
    double height, graze, sure;
  };
  std::array<Above, SampledVoxels::kMostPlanes> above;
  for (std::size_t k = 0; k < planes.size(); ++k) {
    const auto height = static_cast<double>(planes[k].height),
               slenderness = static_cast<double>(planes[k].plane->slenderness);
    above[k] = {widen(planes[k].plane->normal) * (height < 0 ? -1.0 : 1.0), std::abs(height),
                static_cast<double>(kGrazing) * slenderness, static_cast<double>(kSteep) * slenderness};
  }
  const auto is_before = [&](const SeenTriangle& triangle, const SeenCone& cone) {
    if (triangle.farthest_hit(cone) < nearest) return true;
    if (planes.empty()) return false;
    for (std::size_t k = 0; k < planes.size(); ++k) {
      const auto& [normal, height, graze, sure] = above[k];
      const double least = std::max(cone.least(normal), -cone.most(normal));  // absolute cosine
      if (!(least >= graze) ||
          !triangle.is_before(cone, normal, height, least >= sure ? static_cast<double>(kSteepPart) : 1 - kTrust, pad))
        return false;
    }
    return true;
  };
  // Returns true if all rays of the cone pass beside the planes' triangles, or meet them outside the cube.
  const auto misses = [&](const SeenCone& cone) {
    if (planes.empty()) return false;
    const Vec3 centre{x_[look.voxel], y_[look.voxel], z_[look.voxel]};
    const double far = static_cast<double>(look.cube.farthest), half = static_cast<double>(look.cube.half) + pad;
    for (std::size_t k = 0; k < planes.size(); ++k) {
      const auto& [normal, height, graze, sure] = above[k];
      const double slope = dot(normal, cone.middle), least = slope - cone.radius;
      if (slope + cone.radius < -graze) continue;  // behind the head
      if (!(least > graze)) return false;
      // Bounds the distance of a hit from the middle ray's. Computed hits may lie farther away, by the second
      // term.
      const double spread = height / least * cone.radius * (1 + 1 / slope);
      const Vec3 at = cone.middle * (height / slope) - centre;
      if (largest(at) - spread - static_cast<double>(kFloatDoubt) * far / least > half) continue;
      for (std::uint32_t p = planes[k].plane->first; p < planes[k].plane->end; ++p) {
        const SampledVoxels::Piece& piece = voxels_.piece(p);
        const double doubt =
            static_cast<double>(kEdgeDoubt) * (far + half + static_cast<double>(piece.longest)) / least;
        if (std::ranges::none_of(piece.edge, [&](const SampledVoxels::Piece::Edge& edge) {
              return static_cast<double>(edge.offset) - dot(widen(edge.inwards), at) >
                     spread + doubt * static_cast<double>(edge.ratio);
            }))
          return false;
      }
    }
    return true;
  };
  const auto hides = [&](const SeenTriangle& triangle, const SeenCone& cone) {
    return triangle.must_hit(cone) && triangle.nearest_hit(cone) > start && is_before(triangle, cone);
  };
  // Returns a distance before which no hit along this direction counts.
  const auto end_of = [&](const Vec3& d) {
    double end = planes.empty() ? nearest : std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < planes.size(); ++k) {
      const double slope = dot(above[k].normal, d);
      if (std::abs(slope) < above[k].graze) return nearest;
      if (slope > 0) end = std::min(end, above[k].height / slope * (1 - kTrust) - pad);
    }
    return std::clamp(end, nearest, static_cast<double>(look.cube.farthest));
  };

  hiders_.clear();
  if (look.occluder != RayBundle::kNoHit) hiders_.push_back(seen(look.occluder));
  const auto visit = [&](std::uint32_t row, std::uint32_t unit, std::uint32_t size, const auto& again) -> void {
    const std::uint32_t row_begin = window.rows.begin + (row << tiles.row_shift),
                        row_end = std::min(window.rows.begin + ((row + size) << tiles.row_shift), window.rows.end),
                        unit_begin = unit << tiles.unit_shift,
                        unit_end = std::min((unit + size) << tiles.unit_shift, of_row);
    if (row_begin >= row_end || unit_begin >= unit_end) return;
    const auto again_in_parts = [&] {
      const std::uint32_t half = size / 2;
      if (half == 0) return;
      for (const std::uint32_t r : {row, row + half})
        for (const std::uint32_t u : {unit, unit + half}) again(r, u, half, again);
    };
    const SpreadUnits::Unit from = units.at(unit_begin), to = units.at(unit_end - 1);
    if (from.column > to.column) return again_in_parts();  // on both sides of the seam
    const std::uint32_t begin = from.column, end = to.column + to.rays,
                        middle_row = row_begin + (row_end - row_begin) / 2, middle = begin + (end - begin) / 2;
    Float3 d{pattern.sin_zenith[middle_row] * pattern.cos_azimuth[middle],
             pattern.sin_zenith[middle_row] * pattern.sin_azimuth[middle], pattern.cos_zenith[middle_row]};
    if (station_->turn) d = (*station_->turn)(d);
    // Measures along the meridian, and then along a parallel.
    const bool crosses_equator = pattern.cos_zenith[row_begin] > 0 && pattern.cos_zenith[row_end - 1] < 0;
    const double longest =
        crosses_equator ? 1 : std::max(pattern.sin_zenith[row_begin], pattern.sin_zenith[row_end - 1]);
    const double tall =
        std::max(pattern.rows_apart(row_begin, middle_row), pattern.rows_apart(middle_row, row_end - 1));
    const double radius =
        tall + std::max(middle - begin, end - 1 - middle) * pattern.azimuth_step * longest + kConeDoubt;
    const SeenCone cone{{d.x, d.y, d.z}, radius};
    const auto hide = [&] {
      for (std::uint32_t r = row; r < row + size; ++r)
        for (std::uint32_t u = unit; u < unit + size; ++u) tiles.hidden |= std::uint64_t{1} << (8 * r + u);
    };
    if (misses(cone) || std::ranges::any_of(hiders_, [&](const SeenTriangle& one) { return hides(one, cone); }))
      return hide();
    Probe probe{d, static_cast<float>(end_of(cone.middle))};
    rays_->caster().any_hits(bundle_.origin, bundle_.start, {&probe, 1});
    ++traced_;
    if (probe.hit != RayBundle::kNoHit) {
      hiders_.push_back(seen(probe.hit));
      if (hides(hiders_.back(), cone)) return hide();
    }
    again_in_parts();
  };
  visit(0, 0, side, visit);
  return tiles;
}

}  // namespace vantage
