// SPDX-License-Identifier: Apache-2.0
#include "trace/embree/voxel_counter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "trace/rays_of_box.hpp"
#include "trace/target_clones.hpp"

namespace vantage {
namespace {

// Rays that are faster one by one.
constexpr std::uint32_t few = 2;
// Embree's distance and the point's differ by at most one part in 2^plane_trust; twice that.
const double trust = std::ldexp(2.0, -Surface::plane_trust);
// Below this cosine, over slenderness, the plane may not be what decides the point's distance.
constexpr double grazing = 0x1p-11;

Vec3 relative(const Float3& p, const Vec3& head) { return Vec3{p.x, p.y, p.z} - head; }

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

VANTAGE_TARGET_CLONES
void SampledVoxelCounter::see_triangles(std::size_t voxel, const Vec3& head, double reach, double farthest) {
  // In float the edge tests below add less than an eighth to Embree's own doubt.
  constexpr double doubt = SeenTriangle::edge_doubt * 1.125;
  const auto narrow = [](const Vec3& v) {
    return Float3{static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
  };
  seen_.clear();
  for (const SampledVoxels::Listed& t : voxels_.triangles(voxel)) {
    if (static_cast<double>(t.gap) > reach + triangle_margin(pad_)) break;  // the others are farther off
    const Vec3 a = relative(t.a, head), b = relative(t.b, head), c = relative(t.c, head);
    const double longest = static_cast<double>(t.longest);
    seen_.push_back({{narrow(cross(a, b)), narrow(cross(b, c)), narrow(cross(c, a))},
                     static_cast<float>(doubt * (farthest + 2 * reach + longest) * longest),
                     t.slenderness,
                     t.normal,
                     t.offset - dot(t.normal, head)});
  }
}

// Which of the fan's rays Embree might find to hit which of the first 32 triangles, with the last bit for all others.
VANTAGE_TARGET_CLONES
void SampledVoxelCounter::mark_rays(Fan& fan) const {
  const std::uint32_t n = (fan.size + 7) / 8 * 8;  // whole vectors; the surplus is never looked at
  std::fill_n(fan.may_hit, n, 0u);
  for (std::size_t k = 0; k < seen_.size(); ++k) {
    const SeenPlane& s = seen_[k];
    const std::uint32_t bit = std::uint32_t{1} << std::min<std::size_t>(k, 31);
    for (std::uint32_t i = 0; i < n; ++i) {
      const float e0 = s.edge[0].x * fan.x[i] + s.edge[0].y * fan.y[i] + s.edge[0].z * fan.z[i];
      const float e1 = s.edge[1].x * fan.x[i] + s.edge[1].y * fan.y[i] + s.edge[1].z * fan.z[i];
      const float e2 = s.edge[2].x * fan.x[i] + s.edge[2].y * fan.y[i] + s.edge[2].z * fan.z[i];
      const bool front = (e0 >= -s.tolerance) & (e1 >= -s.tolerance) & (e2 >= -s.tolerance);
      const bool back = (e0 <= s.tolerance) & (e1 <= s.tolerance) & (e2 <= s.tolerance);
      fan.may_hit[i] |= (front | back) ? bit : 0u;
    }
  }
}

// Embree reports no hit of ray i that counts nearer than this; infinity where there can be none.
VANTAGE_TARGET_CLONES
double SampledVoxelCounter::nearest_hit(const Fan& fan, std::uint32_t i, const Cube& cube) const {
  const Vec3 d{fan.x[i], fan.y[i], fan.z[i]};
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < seen_.size(); ++k) {
    if ((fan.may_hit[i] >> std::min<std::size_t>(k, 31) & 1) == 0) continue;
    const double slope = dot(seen_[k].normal, d), cosine = std::abs(slope),
                 slenderness = static_cast<double>(seen_[k].slenderness);
    if (!(cosine >= grazing * slenderness)) {
      nearest = std::min(nearest, cube.nearest * (1 - trust));
      continue;
    }
    const double t = seen_[k].height / slope;
    const Vec3 p = d * t - cube.centre;
    if (std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) > cube.half) continue;
    nearest = std::min(nearest,
                       t * (1 - (cosine < SeenTriangle::steep * slenderness ? trust : SeenTriangle::distance_doubt)));
  }
  return nearest;
}

VANTAGE_TARGET_CLONES
std::uint64_t SampledVoxelCounter::count_station(std::size_t voxel, std::size_t station, std::uint64_t wanted) {
  const RayPattern& pattern = rays_.pattern();
  const VoxelGrid& grid = rays_.grid();
  const Float3& origin = stations_[station].origin;
  const Vec3 head{origin.x, origin.y, origin.z};
  const double side = grid.voxel_size();
  Cube cube;
  cube.cell = voxels_.cell(voxel);
  const double half = side / 2 + pad_;
  cube.centre = Vec3{grid.min()[0], grid.min()[1], grid.min()[2]} +
                Vec3{cube.cell[0] + 0.5, cube.cell[1] + 0.5, cube.cell[2] + 0.5} * side - head;
  const Vec3 size{std::abs(cube.centre.x), std::abs(cube.centre.y), std::abs(cube.centre.z)};
  const Vec3 near{std::max(size.x - half, 0.0), std::max(size.y - half, 0.0), std::max(size.z - half, 0.0)};
  const Vec3 far = size + Vec3{half, half, half};
  const double first = (pattern.min_range - reach_) * (1 - trust), last = (pattern.max_range + reach_) * (1 + trust);
  if (first > 0 && dot(far, far) < first * first) return 0;
  if (dot(near, near) > last * last) return 0;

  // Hits whose points count lie within the noise's reach of the cube.
  const double farthest = std::sqrt(dot(far, far));
  const double reach = static_cast<double>(rays_.noise().reach_within(static_cast<float>(farthest + reach_)));
  cube.half = half + reach + pad_;
  cube.nearest = std::sqrt(dot(near, near)) - reach - pad_;
  cube.farthest = farthest + reach + pad_;
  const Vec3 wide{cube.half, cube.half, cube.half};
  if (occluders_[station].hide_box(cube.centre - wide, cube.centre + wide)) return 0;

  const Vec3 narrow{half, half, half};
  const RayRanges window = rays_of_box(pattern, cube.centre - narrow, cube.centre + narrow);
  if (window.empty()) return 0;
  see_triangles(voxel, head, reach, farthest);
  if (seen_.empty()) return 0;

  bundle_.origin = origin;
  bundle_.start = pattern.min_range;
  bundle_.size = 0;
  batch_ = 1;  // a first ray alone finds who stands in the way of the others
  std::uint64_t points = 0;
  fan_.size = 0;
  for (const RayRanges::Range& columns : window.columns) {
    for (std::uint32_t row = window.rows.begin; !columns.empty() && row < window.rows.end; ++row) {
      for (std::uint32_t column = columns.begin; column < columns.end;) {
        const std::uint32_t n = std::min(columns.end - column, Fan::capacity - fan_.size);
        fan_.append(pattern, row, column, n);
        column += n;
        if (fan_.size < Fan::capacity) continue;
        points += work_through_fan(station, cube);
        if (points >= wanted) return points;
      }
    }
  }
  points += work_through_fan(station, cube);
  return points + cast_pending(station, cube);
}

// Empties the fan. Rays that must be traced are, or are left pending.
std::uint64_t SampledVoxelCounter::work_through_fan(std::size_t station, const Cube& cube) {
  mark_rays(fan_);
  std::uint64_t points = 0;
  for (std::uint32_t i = 0; i < fan_.size; ++i) {
    if (fan_.may_hit[i] == 0) continue;
    const double nearest = nearest_hit(fan_, i, cube);
    if (nearest == std::numeric_limits<double>::infinity()) continue;
    if (occluders_[station].stop_ray({fan_.x[i], fan_.y[i], fan_.z[i]}, nearest)) continue;
    const std::uint32_t slot = bundle_.size++;
    bundle_.x[slot] = fan_.x[i];
    bundle_.y[slot] = fan_.y[i];
    bundle_.z[slot] = fan_.z[i];
    bundle_.end[slot] = std::min(static_cast<float>(cube.farthest * (1 + trust)), rays_.pattern().max_range);
    pending_[slot] = {fan_.ray[i], nearest};
    if (bundle_.size < batch_) continue;
    points += cast_pending(station, cube);
    batch_ = std::min(RayBundle::capacity, batch_ * 8);
  }
  fan_.size = 0;
  return points;
}

std::uint64_t SampledVoxelCounter::cast_pending(std::size_t station, const Cube& cube) {
  if (bundle_.size == 0) return 0;
  traced_ += bundle_.size;
  if (bundle_.size <= few) {
    cast_singly(station);
  } else {
    rays_.caster().cast(bundle_);
    for (std::uint32_t slot = 0; slot < bundle_.size; ++slot) {
      if (static_cast<double>(bundle_.t[slot]) < pending_[slot].nearest) remember(station, bundle_.primitive[slot]);
    }
  }
  std::uint64_t points = 0;
  for (std::uint32_t slot = 0; slot < bundle_.size; ++slot) {
    const std::uint32_t triangle = bundle_.primitive[slot];
    if (triangle == RayBundle::no_hit || !rays_.surface().surveyed(triangle)) continue;
    const float range = rays_.range(bundle_, slot, pending_[slot].ray, stations_[station].place);
    points += rays_.grid().cell_of(StationRays::point(bundle_, slot, range)) == cube.cell;
  }
  bundle_.size = 0;
  return points;
}

// Most rays are stopped before they come near the voxel, and it is faster to learn that than by what: so that is asked
// first, and only of the others what they hit. As what stops them comes before all that counts, the answer for those
// that go on is the same.
void SampledVoxelCounter::cast_singly(std::size_t station) {
  const RayCaster& caster = rays_.caster();
  for (std::uint32_t slot = 0; slot < bundle_.size; ++slot) {
    bundle_.primitive[slot] = RayBundle::no_hit;
    const Float3 d{bundle_.x[slot], bundle_.y[slot], bundle_.z[slot]};
    const float before = std::min(std::nextafter(static_cast<float>(pending_[slot].nearest), 0.0f), bundle_.end[slot]);
    float start = bundle_.start;
    if (before > start) {
      const std::uint32_t stopped_by = caster.any_hit(bundle_.origin, d, start, before);
      if (stopped_by != RayBundle::no_hit) {
        remember(station, stopped_by);
        continue;
      }
      start = before;
    }
    bundle_.primitive[slot] = caster.nearest_hit(bundle_.origin, d, start, bundle_.end[slot], bundle_.t[slot]);
  }
}

void SampledVoxelCounter::remember(std::size_t station, std::uint32_t occluder) {
  if (occluders_[station].knows(occluder)) return;
  const SceneData& scene = rays_.scene();
  const Triangle& t = scene.triangles[occluder];
  const Vec3 head{bundle_.origin.x, bundle_.origin.y, bundle_.origin.z};
  occluders_[station].add(occluder,
                          SeenTriangle(relative(scene.positions[t[0]], head), relative(scene.positions[t[1]], head),
                                       relative(scene.positions[t[2]], head)));
}

}  // namespace vantage
