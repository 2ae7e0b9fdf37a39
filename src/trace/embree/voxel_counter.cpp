// SPDX-License-Identifier: Apache-2.0
#include "trace/embree/voxel_counter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "trace/rays_of_box.hpp"

namespace vantage {
namespace {

// Embree's distance and the point's differ by at most one part in 2^plane_trust; twice that.
const double trust = std::ldexp(2.0, -Surface::plane_trust);
// Below this cosine the plane may not be what decides the point's distance.
constexpr double grazing = 0x1p-11;

Vec3 relative(const Float3& p, const Vec3& head) { return Vec3{p.x, p.y, p.z} - head; }

// Where the ray from the coordinate origin along d is inside the box; empty where first > last.
struct Passage {
  double first, last;
};

Passage pass(const Vec3& d, const Vec3& low, const Vec3& high) {
  Passage passage{0, std::numeric_limits<double>::infinity()};
  const auto clip = [&](double component, double from, double to) {
    if (component == 0) {
      if (from > 0 || to < 0) passage.last = -1;
      return;
    }
    const double a = from / component, b = to / component;
    passage.first = std::max(passage.first, std::min(a, b));
    passage.last = std::min(passage.last, std::max(a, b));
  };
  clip(d.x, low.x, high.x);
  clip(d.y, low.y, high.y);
  clip(d.z, low.z, high.z);
  return passage;
}

}  // namespace

SampledVoxelCounter::SampledVoxelCounter(const StationRays& rays, const SampledVoxels& voxels,
                                         std::span<const TraceStation> stations, double pad)
    : rays_(rays),
      voxels_(voxels),
      stations_(stations),
      pad_(pad),
      reach_(static_cast<double>(rays.noise().reach())),
      occluders_(stations.size(), Occluders(static_cast<double>(rays.pattern().min_range))) {}

SampledVoxelCounter::Result SampledVoxelCounter::count(std::size_t voxel, std::uint32_t stop_at) {
  constexpr std::uint64_t most = std::numeric_limits<std::uint32_t>::max();
  std::uint64_t total = 0;
  Result result;
  for (std::size_t s = 0; s < stations_.size(); ++s) {
    const std::uint64_t points = count_station(voxel, s, stop_at == 0 ? most : stop_at - total);
    total += points;
    if (points > 0) result.mask |= std::uint64_t{1} << stations_[s].place;
    if (stop_at != 0 && total >= stop_at) break;
  }
  result.count = static_cast<std::uint32_t>(std::min(total, most));
  return result;
}

std::uint64_t SampledVoxelCounter::count_station(std::size_t voxel, std::size_t station, std::uint64_t wanted) {
  const RayPattern& pattern = rays_.pattern();
  const VoxelGrid& grid = rays_.grid();
  const Float3& origin = stations_[station].origin;
  const Vec3 head{origin.x, origin.y, origin.z};
  const double side = grid.voxel_size();
  Cube cube{voxels_.cell(voxel), {}, {}};
  const Vec3 corner = Vec3{grid.min()[0], grid.min()[1], grid.min()[2]} +
                      Vec3{cube.cell[0] * side, cube.cell[1] * side, cube.cell[2] * side} - head;
  cube.low = corner - Vec3{pad_, pad_, pad_};
  cube.high = corner + Vec3{side + pad_, side + pad_, side + pad_};

  const Vec3 near{std::max({cube.low.x, -cube.high.x, 0.0}), std::max({cube.low.y, -cube.high.y, 0.0}),
                  std::max({cube.low.z, -cube.high.z, 0.0})};
  const Vec3 far{std::max(-cube.low.x, cube.high.x), std::max(-cube.low.y, cube.high.y),
                 std::max(-cube.low.z, cube.high.z)};
  const double first = (pattern.min_range - reach_) * (1 - trust), last = (pattern.max_range + reach_) * (1 + trust);
  if (first > 0 && dot(far, far) < first * first) return 0;
  if (dot(near, near) > last * last) return 0;

  // Hits whose points count lie within the noise's reach of the cube.
  const Vec3 widening{reach_, reach_, reach_};
  Occluders& occluders = occluders_[station];
  if (occluders.hide_box(cube.low - widening, cube.high + widening)) return 0;

  const RayRanges window = rays_of_box(pattern, cube.low, cube.high);
  if (window.empty()) return 0;
  seen_.clear();
  for (const SampledVoxels::Corners& t : voxels_.triangles(voxel))
    seen_.emplace_back(relative(t.a, head), relative(t.b, head), relative(t.c, head));

  bundle_.origin = origin;
  bundle_.start = pattern.min_range;
  bundle_.size = 0;
  std::uint64_t points = 0;
  std::uint32_t batch = 1;  // a first ray alone finds who stands in the way of the others
  for (const RayRanges::Range& columns : window.columns) {
    if (columns.empty()) continue;
    for (std::uint32_t row = window.rows.begin; row < window.rows.end; ++row) {
      for (std::uint32_t column = columns.begin; column < columns.end; ++column) {
        const Float3 direction = rays_.direction(row, column);
        const Vec3 d{direction.x, direction.y, direction.z};
        const Passage inside = pass(d, cube.low, cube.high);
        if (inside.first > inside.last) continue;
        const double from = inside.first - reach_ - pad_, to = inside.last + reach_ + pad_;
        // The nearest that Embree may report one of the voxel's triangles at.
        double nearest = std::numeric_limits<double>::infinity();
        for (const SeenTriangle& triangle : seen_) {
          if (!triangle.may_hit(d)) continue;
          const double cosine = std::abs(triangle.cosine(d));
          if (cosine < grazing) {
            nearest = std::min(nearest, from * (1 - trust));
            continue;
          }
          const double t = triangle.distance(d);
          if (t >= from && t <= to)
            nearest =
                std::min(nearest, t * (1 - (cosine < SeenTriangle::steep ? trust : SeenTriangle::distance_doubt)));
        }
        if (nearest == std::numeric_limits<double>::infinity() || occluders.stop_ray(d, nearest)) continue;
        const std::uint32_t slot = bundle_.size++;
        bundle_.x[slot] = direction.x;
        bundle_.y[slot] = direction.y;
        bundle_.z[slot] = direction.z;
        bundle_.end[slot] = std::min(static_cast<float>(to * (1 + trust)), pattern.max_range);
        pending_[slot] = {rays_.ray(row, column), nearest};
        if (bundle_.size < batch) continue;
        points += cast_pending(station, cube);
        if (points >= wanted) return points;
        batch = std::min(RayBundle::capacity, batch * 8);
      }
    }
  }
  return points + cast_pending(station, cube);
}

std::uint64_t SampledVoxelCounter::cast_pending(std::size_t station, const Cube& cube) {
  if (bundle_.size == 0) return 0;
  rays_.caster().cast(bundle_);
  traced_ += bundle_.size;
  std::uint64_t points = 0;
  for (std::uint32_t slot = 0; slot < bundle_.size; ++slot) {
    const std::uint32_t triangle = bundle_.primitive[slot];
    if (triangle == RayBundle::no_hit) continue;
    if (rays_.surface().surveyed(triangle)) {
      const float range = rays_.range(bundle_, slot, pending_[slot].ray, stations_[station].place);
      if (rays_.grid().cell_of(StationRays::point(bundle_, slot, range)) == cube.cell) {
        ++points;
        continue;
      }
    }
    Occluders& occluders = occluders_[station];
    if (static_cast<double>(bundle_.t[slot]) < pending_[slot].nearest && !occluders.knows(triangle)) {
      const SceneData& scene = rays_.scene();
      const Triangle& t = scene.triangles[triangle];
      const Vec3 head{bundle_.origin.x, bundle_.origin.y, bundle_.origin.z};
      occluders.add(triangle, SeenTriangle(relative(scene.positions[t[0]], head), relative(scene.positions[t[1]], head),
                                           relative(scene.positions[t[2]], head)));
    }
  }
  bundle_.size = 0;
  return points;
}

}  // namespace vantage
