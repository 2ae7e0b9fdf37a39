// SPDX-License-Identifier: Apache-2.0
// For each station in turn, find_open() leaves out groups of voxels that one triangle hides. look_at() bounds the hits
// that count in each other voxel: of a wall, they lie in a thin slab of the cube. drop_hidden_boxes() probes the way to
// their middle: a triangle there that hides all of them settles the voxel. If it hides a part, find_hidden() looks
// which tiles of the voxel's window of rays are hidden. find_windows() bounds the rows and columns of that window, all
// voxels side by side. list_rays() walks the windows and gathers rays in a RayBatch. When that is full, fill_nearest()
// intersects them with the voxel's surveyed planes and triangles, in float with margins for all errors. Each ray gets
// the least distance at which its hit can count; if there is none, infinity, and list_batch() drops the ray. The rays
// listed for a voxel form a `VoxelRays`, with the distance of the last hit that may count. Once many are listed,
// settle() probes one ray of each `VoxelRays` up to its nearest hit that counts. A triangle in the way hides that ray,
// and drop_hidden() removes all other rays of the `VoxelRays` that it stops for certain. Once that removes few, cast()
// traces every remaining ray to its nearest hit, in bundles. finish() counts those whose point, noise included, lies in
// the voxel. Only certain occlusion is used, so the counts are those of casting all rays. With a limit `stop_at`, as
// many rays of a voxel are listed as usually suffice, and the rest only if they did not. If none of them left a point,
// most of the voxel is hidden, though not in its middle: find_hidden() looks at its window then, since there may be
// thousands of rays in each.
#include "trace/embree/voxel_counter.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "core/target_clones.hpp"
#include "trace/embree/hit_margins.hpp"
#include "trace/embree/spread_units.hpp"

namespace vantage {
namespace {

constexpr float kFloatInfinity = std::numeric_limits<float>::infinity();
constexpr std::size_t kRaysAtOnce = 2048;
constexpr std::uint32_t kAll = std::numeric_limits<std::uint32_t>::max();
// Rays of a voxel are probed one by one for an occluder while at least this many are left and each probe hides at least
// this many. Fewer rays are traced as fast as one is probed.
constexpr std::uint32_t kWorthProbe = 8;
// Each further step of a count with a limit `stop_at` lists and traces this many times the previous step's rays.
constexpr std::uint32_t kMore = 4;
// Number of triangles that are remembered.
constexpr std::size_t kMet = 4;
// Number of a window's units that are traced before its tiles are tested.
constexpr std::uint32_t kFirstUnits = 64;

// Returns true if VoxelGrid::cell_of(p) is `cell`.
bool lies_in(const VoxelGrid& grid, const Float3& p, const std::array<std::uint32_t, 3>& cell) {
  const std::array<float, 3>& min = grid.min();
  const auto in = [&](float scaled, std::uint32_t k) {
    return scaled >= static_cast<float>(k) && scaled < static_cast<float>(k + 1);
  };
  return in((p.x - min[0]) * grid.inverse_size(), cell[0]) && in((p.y - min[1]) * grid.inverse_size(), cell[1]) &&
         in((p.z - min[2]) * grid.inverse_size(), cell[2]);
}

Vec3 relative(const Float3& p, const Vec3& head) { return Vec3{p.x, p.y, p.z} - head; }

}  // namespace

SampledVoxelCounter::SampledVoxelCounter(std::span<const StationRays> scanners, const SampledVoxels& voxels, double pad)
    : scanners_(scanners), voxels_(voxels), pad_(pad) {
  listed_.resize(kRaysAtOnce + RayBatch::kCapacity);
  batch_.x.fill(1);
  batch_.y.fill(1);
  batch_.z.fill(1);
}

void SampledVoxelCounter::count(std::span<const TraceStation> stations, std::size_t first, std::uint32_t stop_at,
                                std::span<std::uint32_t> counts, std::span<std::uint64_t> masks,
                                std::span<const std::uint8_t> leave_out) {
  first_ = first;
  stop_at_ = stop_at;
  counts_ = counts;
  masks_ = masks;
  leave_out_ = leave_out;
  for (const TraceStation& station : stations) {
    station_ = &station;
    rays_ = &scanners_[station.scanner];
    reach_ = static_cast<double>(rays_->noise().reach());
    head_ = {station.origin.x, station.origin.y, station.origin.z};
    bundle_.origin = station.origin;
    bundle_.start = rays_->pattern().min_range;
    find_open(counts.size());
    if (std::ranges::none_of(std::span(open_).first(counts.size()), std::identity())) continue;
    look_from(first, counts.size());
    looks_.clear();
    rest_.clear();
    Look look;
    for (std::uint32_t i = 0; i < counts.size(); ++i)
      if (open_[i] && look_at(i, look)) looks_.push_back(look);
    drop_hidden_boxes();
    find_windows();
    for (std::size_t k = 0; k < looks_.size(); ++k) {
      const Look& each = looks_[k];
      if (rays_->pattern().list) {
        list_directions(k);
        continue;
      }
      const RayRanges window = window_of(k);
      if (window.empty()) continue;
      // An occluder of the middle mostly hides more than the middle.
      const Tiles tiles = each.occluder != RayBundle::kNoHit ? find_hidden(each, window) : Tiles();
      list_rays({each, window, 0, counts_[each.voxel], tiles}, wanted(each.voxel));
    }
    settle();
    for (std::uint64_t times = kMore; !rest_.empty(); times *= kMore) {
      std::swap(rest_, again_);
      rest_.clear();
      for (Rest& rest : again_) {
        const std::uint32_t i = rest.look.voxel;
        if (full(i)) continue;
        if (times == kMore && counts_[i] == rest.count && rest.look.occluder == RayBundle::kNoHit)
          rest.tiles = find_hidden(rest.look, rest.window);
        list_rays(rest, static_cast<std::uint32_t>(std::min<std::uint64_t>(times * wanted(i), kAll)));
      }
      settle();
    }
  }
}

// Finds the voxels of the block that the current station may see. Most voxels of a large site are behind walls, and one
// triangle hides many of them.
void SampledVoxelCounter::find_open(std::size_t n) {
  met_.clear();
  for (std::uint32_t i = 0; i < n; ++i) open_[i] = !full(i);
  for (std::size_t level = 0; level < SampledVoxels::kGroupSizes.size(); ++level) drop_hidden_groups(level, n);
}

void SampledVoxelCounter::drop_hidden_groups(std::size_t level, std::size_t n) {
  const RayPattern& pattern = rays_->pattern();
  const std::size_t size = SampledVoxels::kGroupSizes[level];
  for (std::size_t first = 0; first < n; first += size) {
    const std::span<bool> open = std::span(open_).subspan(first, std::min(size, n - first));
    if (std::ranges::none_of(open, std::identity())) continue;
    const Box box = box_of(voxels_.group(level, (first_ + first) / size));
    const Vec3 to_nearest{std::max({box.min.x, -box.max.x, 0.0}), std::max({box.min.y, -box.max.y, 0.0}),
                          std::max({box.min.z, -box.max.z, 0.0})};
    const double nearest = std::sqrt(dot(to_nearest, to_nearest));
    if (nearest > (pattern.max_range + reach_) * (1 + kTrust)) {
      std::ranges::fill(open, false);
      continue;
    }
    if (nearest == 0) continue;  // the head is among them
    bool hidden = is_hidden(SeenBox(box));
    if (!hidden) {
      const Vec3 middle = (box.min + box.max) * 0.5, d = middle * (1 / std::sqrt(dot(middle, middle)));
      Probe probe{narrow(d), static_cast<float>(nearest * (1 - kTrust))};
      rays_->caster().any_hits(bundle_.origin, bundle_.start, {&probe, 1});
      ++traced_;
      if (probe.hit != RayBundle::kNoHit) {
        meet(probe.hit);
        hidden = hides(probe.hit, box);
      }
    }
    if (hidden) std::ranges::fill(open, false);
  }
}

// Returns a box of every point that counts in one of the cells, before noise moves it, relative to the head.
Box SampledVoxelCounter::box_of(const SampledVoxels::Cells& cells) const {
  const VoxelGrid& grid = rays_->grid();
  const double side = grid.voxel_size();
  const Vec3 corner = Vec3{grid.min()[0], grid.min()[1], grid.min()[2]} - head_;
  Box box{corner + Vec3{cells.low[0] * side, cells.low[1] * side, cells.low[2] * side},
          corner + Vec3{(cells.high[0] + 1) * side, (cells.high[1] + 1) * side, (cells.high[2] + 1) * side}};
  const Vec3 farthest{std::max(-box.min.x, box.max.x), std::max(-box.min.y, box.max.y),
                      std::max(-box.min.z, box.max.z)};
  const double reach = reach_ > 0 ? static_cast<double>(rays_->noise().reach_within(
                                        static_cast<float>(std::sqrt(dot(farthest, farthest)) + reach_)))
                                  : 0;
  const double beyond = reach + 4 * pad_;
  return {box.min - Vec3{beyond, beyond, beyond}, box.max + Vec3{beyond, beyond, beyond}};
}

void SampledVoxelCounter::meet(std::uint32_t triangle) {
  const auto known = std::ranges::find(met_, triangle, &std::pair<std::uint32_t, SeenTriangle>::first);
  if (known != met_.end()) {
    std::rotate(met_.begin(), known, known + 1);
    return;
  }
  if (met_.size() == kMet) met_.pop_back();
  met_.insert(met_.begin(), {triangle, seen(triangle)});
}

bool SampledVoxelCounter::hides(std::uint32_t triangle, const Box& box) {
  const auto start = static_cast<double>(bundle_.start);
  const SeenTriangle one = seen(triangle);
  const SeenBox seen_box(box);
  if (!one.is_before(seen_box, start)) return false;
  return one.covers(seen_box) ||
         rays_->patches().hide(triangle, head_, box, start,
                               [&](const Vec3& point, double radius) { return any_ray_near(point, radius); });
}

bool SampledVoxelCounter::any_ray_near(const Vec3& point, double radius) const {
  Vec3 low = point - Vec3{radius, radius, radius}, high = point + Vec3{radius, radius, radius};
  if (station_->turn) turn_back(*station_->turn, low, high);
  if (!rays_->pattern().list) return !rays_of_box(rays_->pattern(), low, high).empty();
  bool any = false;
  rays_->pattern().list->each_near(angles_of_box(low, high), [&](std::span<const std::uint32_t>) { any = true; });
  return any;
}

bool SampledVoxelCounter::is_hidden(const SeenBox& box) {
  for (auto one = met_.begin(); one != met_.end(); ++one) {
    if (!one->second.hides(box, static_cast<double>(bundle_.start))) continue;
    std::rotate(met_.begin(), one, one + 1);
    return true;
  }
  return false;
}

// Computes the middles of the block's cubes, relative to the current head.
VANTAGE_TARGET_CLONES
void SampledVoxelCounter::look_from(std::size_t first, std::size_t n) {
  const double side = rays_->grid().voxel_size();
  const auto along = [&](std::size_t axis, double origin, double* __restrict centre) {
    const std::int32_t* const cell = voxels_.cells()[axis].data() + first;
    for (std::size_t i = 0; i < n; ++i) centre[i] = origin + (cell[i] + 0.5) * side;
  };
  const std::array<float, 3>& min = rays_->grid().min();
  along(0, min[0] - head_.x, x_.data());
  along(1, min[1] - head_.y, y_.data());
  along(2, min[2] - head_.z, z_.data());
  for (std::size_t i = 0; i < n; ++i) distance_[i] = std::sqrt(x_[i] * x_[i] + y_[i] * y_[i] + z_[i] * z_[i]);
}

// Bounds the rays that can leave a point in each of looks_.
void SampledVoxelCounter::find_windows() {
  const double half = rays_->grid().voxel_size() / 2 + pad_;
  boxes_.size = static_cast<std::uint32_t>(looks_.size());
  const auto along = [&](double centre, double low, double high, double reach, double& middle, double& extent) {
    low = std::max(low - reach, centre - half), high = std::min(high + reach, centre + half);
    middle = (low + high) / 2, extent = std::max((high - low) / 2, 0.0);
  };
  for (std::size_t k = 0; k < looks_.size(); ++k) {
    const auto& [i, cube, reach, hits, sure, occluder] = looks_[k];
    along(x_[i], hits.min.x, hits.max.x, reach, boxes_.x[k], boxes_.half_x[k]);
    along(y_[i], hits.min.y, hits.max.y, reach, boxes_.y[k], boxes_.half_y[k]);
    along(z_[i], hits.min.z, hits.max.z, reach, boxes_.z[k], boxes_.half_z[k]);
  }
  if (station_->turn) turn_back(*station_->turn, boxes_);
  if (!rays_->pattern().list) rays_of_boxes(rays_->pattern(), boxes_);
}

RayRanges SampledVoxelCounter::window_of(std::size_t k) const {
  RayRanges window;
  if (boxes_.simple[k]) {
    window.rows = {static_cast<std::uint32_t>(boxes_.row_begin[k]), static_cast<std::uint32_t>(boxes_.row_end[k])};
    window.columns[0] = {static_cast<std::uint32_t>(boxes_.column_begin[k]),
                         static_cast<std::uint32_t>(boxes_.column_end[k])};
    return window;
  }
  const Vec3 middle{boxes_.x[k], boxes_.y[k], boxes_.z[k]}, half{boxes_.half_x[k], boxes_.half_y[k], boxes_.half_z[k]};
  return rays_of_box(rays_->pattern(), middle - half, middle + half);
}

// Turns the batch with its scanner, and fills batch_.nearest.
VANTAGE_TARGET_CLONES
void SampledVoxelCounter::fill_nearest(std::span<const Ahead> planes, const Cube& cube) {
  RayBatch& batch = batch_;
  const std::uint32_t n = (batch.size + 7) / 8 * 8;  // whole vectors; the surplus is never read
  if (station_->turn) turn_all(*station_->turn, batch.x.data(), batch.y.data(), batch.z.data(), batch.size);
  const auto trusted = static_cast<float>(1 - kTrust), pad = static_cast<float>(2 * pad_);
  const float cx = cube.centre.x, cy = cube.centre.y, cz = cube.centre.z, half = cube.half + pad,
              nearest_of_all = cube.nearest * trusted, slack = kFloatDoubt * cube.farthest;
  std::fill_n(batch.nearest.data(), n, planes.empty() ? nearest_of_all : kFloatInfinity);
  for (std::size_t k = 0; k < planes.size(); ++k) {
    const SampledVoxels::Plane& plane = *planes[k].plane;
    const float nx = plane.normal.x, ny = plane.normal.y, nz = plane.normal.z, height = planes[k].height,
                sure = kSteep * plane.slenderness, graze = kGrazing * plane.slenderness;
    std::uint32_t any = 0;
    for (std::uint32_t i = 0; i < n; ++i) {
      const float slope = nx * batch.x[i] + ny * batch.y[i] + nz * batch.z[i], cosine = std::abs(slope),
                  slant = 1 / cosine;
      const float t = height / slope;
      const float px = batch.x[i] * t - cx, py = batch.y[i] * t - cy, pz = batch.z[i] * t - cz;
      const float beyond = std::max(std::max(std::abs(px), std::abs(py)), std::abs(pz)) - slack * slant;
      batch.px[i] = px;
      batch.py[i] = py;
      batch.pz[i] = pz;
      batch.slant[i] = slant;
      any |= beyond <= half ? 1u : 0u;
      batch.candidate[i] = t * (cosine < sure ? trusted : kSteepPart) - pad + (beyond <= half ? 0.0f : kFloatInfinity);
      batch.nearest[i] = std::min(batch.nearest[i], nearest_of_all + (cosine >= graze ? kFloatInfinity : 0.0f));
    }
    if (any == 0) continue;
    for (std::uint32_t p = plane.first; p < plane.end; ++p) {
      const SampledVoxels::Piece& piece = voxels_.piece(p);
      const float doubt = kEdgeDoubt * (cube.farthest + cube.half + piece.longest);
      const auto &a = piece.edge[0], &b = piece.edge[1], &c = piece.edge[2];
      const float ax = a.inwards.x, ay = a.inwards.y, az = a.inwards.z, ao = a.offset, ad = doubt * a.ratio;
      const float bx = b.inwards.x, by = b.inwards.y, bz = b.inwards.z, bo = b.offset, bd = doubt * b.ratio;
      const float ex = c.inwards.x, ey = c.inwards.y, ez = c.inwards.z, eo = c.offset, ed = doubt * c.ratio;
      for (std::uint32_t i = 0; i < n; ++i) {
        const float px = batch.px[i], py = batch.py[i], pz = batch.pz[i], slant = batch.slant[i];
        const float outside = std::max(
            std::max(ao - ad * slant - (ax * px + ay * py + az * pz), bo - bd * slant - (bx * px + by * py + bz * pz)),
            eo - ed * slant - (ex * px + ey * py + ez * pz));
        batch.nearest[i] = std::min(batch.nearest[i], batch.candidate[i] + (outside <= 0 ? 0.0f : kFloatInfinity));
      }
    }
  }
}

// Examines voxel number i of the block. Returns false if no ray leaves a point there.
bool SampledVoxelCounter::look_at(std::uint32_t i, Look& look) {
  const RayPattern& pattern = rays_->pattern();
  const double half = rays_->grid().voxel_size() / 2 + pad_, corner = half * 1.7320509;
  const double first = (pattern.min_range - reach_) * (1 - kTrust), last = (pattern.max_range + reach_) * (1 + kTrust);
  if (distance_[i] + corner < first || distance_[i] - corner > last) return false;
  // Hits whose points count lie within the noise's reach of the cube.
  const std::span<const SampledVoxels::Plane> planes = voxels_.planes(first_ + i);
  const double reach = reach_ > 0 ? reach_of(i, distance_[i] + corner + reach_) : 0;
  look.voxel = i;
  look.cube = {{static_cast<float>(x_[i]), static_cast<float>(y_[i]), static_cast<float>(z_[i])},
               static_cast<float>(half + reach + pad_),
               static_cast<float>(distance_[i] - corner - reach - 2 * pad_),
               static_cast<float>(distance_[i] + corner + reach + 2 * pad_)};
  look.sure = !planes.empty();
  for (const SampledVoxels::Plane& plane : planes)
    look.sure &= std::abs(height_over(plane, i)) >= kSureHeight * plane.slenderness * look.cube.farthest;
  look.reach = reach;
  look.hits = hits_of(look);
  return !look.hits.empty();
}

// Bounds how far noise moves a hit on the planes of voxel number i, nearer than `far`. The bound is smaller for bright
// planes, and for steep incidence.
double SampledVoxelCounter::reach_of(std::uint32_t i, double far) const {
  const std::span<const SampledVoxels::Plane> planes = voxels_.planes(first_ + i);
  double least = planes.empty() ? 0 : 1;
  for (const SampledVoxels::Plane& plane : planes) {
    const double cosine = std::abs(static_cast<double>(height_over(plane, i))) / far - static_cast<double>(plane.tilt);
    least = std::min(least, static_cast<double>(plane.diffuse) * cosine);
  }
  return static_cast<double>(
      rays_->noise().reach_within(static_cast<float>(far), static_cast<float>(std::max(least, 0.0))));
}

// Returns true if hits on the plane may count.
bool SampledVoxelCounter::crosses(const SampledVoxels::Plane& plane, const Cube& cube) const {
  const float across = std::abs(plane.normal.x) + std::abs(plane.normal.y) + std::abs(plane.normal.z);
  return !(std::abs(plane.offset) > (cube.half + static_cast<float>(4 * pad_)) * across);
}

// Returns the height of the head over a plane of voxel number i. Computed in double, since rounding turned the plane
// around the voxel.
float SampledVoxelCounter::height_over(const SampledVoxels::Plane& plane, std::uint32_t i) const {
  return static_cast<float>(plane.normal.x * x_[i] + plane.normal.y * y_[i] + plane.normal.z * z_[i] +
                            static_cast<double>(plane.offset));
}

// Returns a box around the parts of the voxel's triangles in the cube, if no others can be hit.
Box SampledVoxelCounter::hits_of(const Look& look) const {
  const std::uint32_t i = look.voxel;
  const Vec3 centre{x_[i], y_[i], z_[i]};
  const auto half = static_cast<double>(look.cube.half);
  const Vec3 pad{2 * pad_, 2 * pad_, 2 * pad_};
  const SampledVoxels::Around& around = voxels_.around(first_ + i);
  Box hits;
  if (!look.sure) {
    hits.extend(centre - Vec3{half, half, half} - pad);
    hits.extend(centre + Vec3{half, half, half} + pad);
    return hits;
  }
  for (const SampledVoxels::Plane& plane : voxels_.planes(first_ + i).first(voxels_.crossing(first_ + i))) {
    if (!crosses(plane, look.cube)) continue;
    const Vec3 n = widen(plane.normal), all{std::abs(n.x), std::abs(n.y), std::abs(n.z)};
    const double offset = static_cast<double>(plane.offset), across = all.x + all.y + all.z;
    // Range of the plane within the cube along an axis, with other coordinates of at most `half`. Planes along the axis
    // have no bound, nor do those nearly along it, for roundings of the normal.
    const auto along = [&](double part, double size, float low, float high) {
      double from = std::max(static_cast<double>(low), -half), to = std::min(static_cast<double>(high), half);
      if (size >= 0x1p-6) {
        const double middle = offset / part, extent = half * (across - size) / size;
        from = std::max(from, middle - extent), to = std::min(to, middle + extent);
      }
      return std::pair(from, to);
    };
    const auto x = along(n.x, all.x, around.low.x, around.high.x), y = along(n.y, all.y, around.low.y, around.high.y),
               z = along(n.z, all.z, around.low.z, around.high.z);
    const Vec3 low = Vec3{x.first, y.first, z.first} - pad, high = Vec3{x.second, y.second, z.second} + pad;
    if (low.x > high.x || low.y > high.y || low.z > high.z) continue;
    hits.extend(centre + low);
    hits.extend(centre + high);
  }
  return hits;
}

SeenTriangle SampledVoxelCounter::seen(std::uint32_t triangle) const {
  const auto p = rays_->scene().corners(triangle);
  return {relative(p[0], head_), relative(p[1], head_), relative(p[2], head_)};
}

// Drops voxels that one triangle hides completely.
void SampledVoxelCounter::drop_hidden_boxes() {
  probes_.clear();
  std::size_t kept = 0;
  for (const Look& look : looks_) {
    if (is_hidden(SeenBox(look.hits))) continue;
    const Vec3 middle = (look.hits.min + look.hits.max) * 0.5;
    const double inverse = 1 / std::max(std::sqrt(dot(middle, middle)), std::numeric_limits<double>::min());
    probes_.push_back({narrow(middle * inverse), look.cube.nearest * static_cast<float>(1 - kTrust)});
    looks_[kept++] = look;
  }
  looks_.resize(kept);
  rays_->caster().any_hits(bundle_.origin, bundle_.start, probes_);
  traced_ += probes_.size();
  kept = 0;
  for (std::size_t k = 0; k < looks_.size(); ++k) {
    const std::uint32_t by = probes_[k].hit;
    if (by != RayBundle::kNoHit && hides(by, looks_[k].hits)) continue;
    looks_[kept] = looks_[k];
    looks_[kept++].occluder = by;
  }
  looks_.resize(kept);
}

std::uint32_t SampledVoxelCounter::wanted(std::uint32_t i) const {
  if (stop_at_ == 0) return kAll;
  return counts_[i] >= stop_at_ ? 1 : stop_at_ + stop_at_ / 4 + 1;
}

// Collects the planes of the voxel on which hits may count.
std::span<const SampledVoxelCounter::Ahead> SampledVoxelCounter::planes_of(const Look& look) {
  const std::span<const SampledVoxels::Plane> planes = voxels_.planes(first_ + look.voxel);
  std::size_t n = 0;
  for (const SampledVoxels::Plane& plane : look.sure ? planes.first(voxels_.crossing(first_ + look.voxel)) : planes)
    if (!look.sure || crosses(plane, look.cube)) planes_[n++] = {&plane, height_over(plane, look.voxel)};
  return std::span(planes_).first(n);
}

// Lists the rays of the window from unit number `units` on: at least `enough` if there are as many.
VANTAGE_TARGET_CLONES
void SampledVoxelCounter::list_rays(Rest rest, std::uint32_t enough) {
  const RayPattern& pattern = rays_->pattern();
  const Look& look = rest.look;
  const std::uint32_t i = look.voxel;
  const Cube& cube = look.cube;
  const std::span<const Ahead> planes = planes_of(look);
  // The batch is processed in whole vectors, since testing fewer rays does not pay.
  std::uint32_t worth = std::min(RayBatch::kCapacity, (std::min(enough, RayBatch::kCapacity) + 7) / 8 * 8);
  std::uint32_t found = 0;

  VoxelRays rays{.voxel = i,
                 .begin = listed_size_,
                 .farthest = std::min(cube.farthest * static_cast<float>(1 + kTrust), pattern.max_range),
                 .occluder = look.occluder};
  const float *const cosines = pattern.cos_azimuth.data(), *const sines = pattern.sin_azimuth.data();
  static_assert(SpreadUnits::kUnit == RayBatch::kStep);
  const SpreadUnits all(rest.window, stop_at_ != 0);
  std::uint32_t& units = rest.units;
  const bool first = units == 0 && stop_at_ != 0;
  for (std::uint32_t index = all.index(units); units < all.size(); index = all.next(index)) {
    ++units;
    if (rest.tiles.hidden != 0) {
      const std::uint32_t in_row = index / all.of_row();
      const std::uint32_t tile =
          8 * (in_row >> rest.tiles.row_shift) + ((index - in_row * all.of_row()) >> rest.tiles.unit_shift);
      if ((rest.tiles.hidden >> tile & 1) != 0) continue;
    }
    const auto [row, column, many] = all.at(index);
    const float sine = pattern.sin_zenith[row], cosine = pattern.cos_zenith[row];
    const std::uint32_t size = batch_.size;
    const auto put = [&](std::uint32_t k) {
      batch_.x[size + k] = sine * cosines[column + k];
      batch_.y[size + k] = sine * sines[column + k];
      batch_.z[size + k] = cosine;
      batch_.row[size + k] = row;
      batch_.column[size + k] = column + k;
    };
    if (column + RayBatch::kStep <= pattern.columns()) {
      for (std::uint32_t k = 0; k < RayBatch::kStep; ++k) put(k);
    } else {
      for (std::uint32_t k = 0; k < many; ++k) put(k);
    }
    batch_.size += many;
    if (batch_.size + RayBatch::kStep <= worth) continue;
    fill_nearest(planes, cube);
    found += list_batch(rays);
    if (full(i)) return;
    if ((found >= enough || (first && units >= kFirstUnits)) && units < all.size()) {
      end_rays(rays);
      rest_.push_back(rest);
      return;
    }
    worth = std::min(2 * worth, RayBatch::kCapacity);
  }
  fill_nearest(planes, cube);
  list_batch(rays);
  end_rays(rays);
}

// Lists those rays of a list of directions that may leave a point in the voxel of looks_[k].
void SampledVoxelCounter::list_directions(std::size_t k) {
  const RayPattern& pattern = rays_->pattern();
  const Look& look = looks_[k];
  const std::span<const Ahead> planes = planes_of(look);
  VoxelRays rays{.voxel = look.voxel,
                 .begin = listed_size_,
                 .farthest = std::min(look.cube.farthest * static_cast<float>(1 + kTrust), pattern.max_range),
                 .occluder = look.occluder};
  const auto list_some = [&] {
    fill_nearest(planes, look.cube);
    list_batch(rays);
  };
  const Vec3 middle{boxes_.x[k], boxes_.y[k], boxes_.z[k]}, half{boxes_.half_x[k], boxes_.half_y[k], boxes_.half_z[k]};
  pattern.list->each_near(angles_of_box(middle - half, middle + half), [&](std::span<const std::uint32_t> near) {
    for (const std::uint32_t ray : near) {
      const Float3 d = pattern.direction(ray, 0);
      const std::uint32_t slot = batch_.size++;
      batch_.x[slot] = d.x, batch_.y[slot] = d.y, batch_.z[slot] = d.z;
      batch_.row[slot] = ray, batch_.column[slot] = 0;
      if (batch_.size == RayBatch::kCapacity) list_some();
    }
  });
  list_some();
  end_rays(rays);
}

// Empties the batch, and lists those of its rays that may hit. Returns their number.
std::uint32_t SampledVoxelCounter::list_batch(VoxelRays& rays) {
  Ray* next = listed_.data() + listed_size_;
  for (std::uint32_t k = 0; k < batch_.size; ++k) {
    *next = {{batch_.x[k], batch_.y[k], batch_.z[k]}, batch_.nearest[k], batch_.row[k], batch_.column[k]};
    next += batch_.nearest[k] < kFloatInfinity;  // branch-free, since the branch is unpredictable
  }
  const auto size = static_cast<std::uint32_t>(next - listed_.data()), added = size - listed_size_;
  listed_size_ = size;
  batch_.size = 0;
  if (listed_size_ < kRaysAtOnce) return added;
  end_rays(rays);
  settle();
  rays.begin = 0;
  return added;
}

// Ends a list: all rays of a voxel, or as many as are traced at once.
void SampledVoxelCounter::end_rays(VoxelRays& rays) {
  rays.end = listed_size_;
  if (rays.occluder != RayBundle::kNoHit) drop_hidden(rays, rays.occluder);
  listed_size_ = rays.end;
  if (rays.end == rays.begin) return;
  voxel_rays_.push_back(rays);
}

// Drops rays from `rays` that a triangle certainly stops before they come near the voxel.
void SampledVoxelCounter::drop_hidden(VoxelRays& rays, std::uint32_t by) {
  if (rays.begin == rays.end) return;
  const SeenTriangle triangle = seen(by);
  // Nearer triangles may lie before the ray's start.
  const auto start = static_cast<double>(bundle_.start);
  std::uint32_t kept = rays.begin;
  for (std::uint32_t k = rays.begin; k < rays.end; ++k) {
    const Vec3 d{listed_[k].d.x, listed_[k].d.y, listed_[k].d.z};
    if (triangle.must_hit(d) && triangle.nearest_hit(d) > start &&
        triangle.farthest_hit(d) < static_cast<double>(listed_[k].nearest))
      continue;
    listed_[kept++] = listed_[k];
  }
  rays.end = kept;
}

// Traces the listed rays. Most are stopped before they come near the voxel, and Embree finds any hit faster than the
// nearest. Occluders are therefore sought first, and nearest hits only for the other rays. An occluder lies before all
// hits that count, so it changes no count.
void SampledVoxelCounter::settle() {
  visible_.clear();
  while (!voxel_rays_.empty()) {
    probes_.clear();
    for (const VoxelRays& rays : voxel_rays_)
      probes_.push_back({listed_[rays.begin].d, std::min(listed_[rays.begin].nearest, rays.farthest)});
    rays_->caster().any_hits(bundle_.origin, bundle_.start, probes_);
    traced_ += probes_.size();
    // Separate passes keep many loads in flight at once.
    const SceneData& scene = rays_->scene();
    const bool stored = !scene.shares();
    for (const Probe& probe : probes_) {
      if (stored && probe.hit != RayBundle::kNoHit) __builtin_prefetch(&scene.triangles[probe.hit]);
    }
    for (const Probe& probe : probes_) {
      if (!stored || probe.hit == RayBundle::kNoHit) continue;
      for (const std::uint32_t corner : scene.triangles[probe.hit]) __builtin_prefetch(&scene.positions[corner]);
    }
    std::size_t kept = 0;
    for (std::size_t k = 0; k < voxel_rays_.size(); ++k) {
      VoxelRays rays = voxel_rays_[k];
      if (probes_[k].hit == RayBundle::kNoHit) {
        rays.probed = true;
        visible_.push_back(rays);
        continue;
      }
      const std::uint32_t before = rays.end - ++rays.begin;
      drop_hidden(rays, probes_[k].hit);
      const std::uint32_t left = rays.end - rays.begin;
      if (left >= kWorthProbe && before - left >= kWorthProbe)
        voxel_rays_[kept++] = rays;
      else if (left > 0)
        visible_.push_back(rays);
    }
    voxel_rays_.resize(kept);
  }
  cast();
  listed_size_ = 0;
}

// Traces the rays of visible voxels and counts points. With a limit `stop_at`, a first pass traces as many rays as
// usually suffice, or one if the voxel is full and only the station's bit is missing. Larger passes follow until the
// limit is reached or no ray is left.
void SampledVoxelCounter::cast() {
  bundle_.size = 0;
  if (stop_at_ == 0) {
    for (VoxelRays& rays : visible_) cast(rays, rays.end - rays.begin);
    finish();
    return;
  }
  for (std::uint64_t times = 1; !visible_.empty(); times *= kMore) {
    std::size_t kept = 0;
    for (VoxelRays rays : visible_) {
      if (full(rays.voxel)) continue;
      cast(rays,
           static_cast<std::uint32_t>(std::min<std::uint64_t>(times * wanted(rays.voxel), rays.end - rays.begin)));
      if (rays.begin < rays.end) visible_[kept++] = rays;
    }
    visible_.resize(kept);
    finish();
  }
}

// Casts the first `many` rays.
void SampledVoxelCounter::cast(VoxelRays& rays, std::uint32_t many) {
  traced_ += many - (rays.probed && many > 0 ? 1 : 0);
  rays.probed = false;
  for (const std::uint32_t end = rays.begin + many; rays.begin < end; ++rays.begin) {
    const Ray& ray = listed_[rays.begin];
    const std::uint32_t slot = bundle_.size++;
    bundle_.x[slot] = ray.d.x;
    bundle_.y[slot] = ray.d.y;
    bundle_.z[slot] = ray.d.z;
    bundle_.end[slot] = rays.farthest;
    cast_ray_[slot] = rays.begin;
    cast_voxel_[slot] = rays.voxel;
    if (bundle_.size == RayBundle::kCapacity) finish();
  }
}

void SampledVoxelCounter::finish() {
  const Surface& surface = rays_->surface();
  rays_->caster().cast(bundle_);
  const std::uint64_t bit = std::uint64_t{1} << station_->bit();
  hits_.size = 0;
  for (std::uint32_t slot = 0; slot < bundle_.size; ++slot) {
    const std::uint32_t triangle = bundle_.primitive[slot];
    if (triangle == RayBundle::kNoHit || !surface.surveyed(triangle)) continue;
    const Ray& ray = listed_[cast_ray_[slot]];
    hits_.add(bundle_, slot, rays_->ray(ray.row, ray.column));
  }
  rays_->find_ranges(*station_, hits_, true);
  std::array<Passed, RayBundle::kCapacity> passed;
  const bool behind_glass = rays_->glass() && rays_->glass()->follow(bundle_.origin, hits_, nullptr, passed);
  for (std::uint32_t k = 0; k < hits_.size; ++k) {
    const std::uint32_t slot = hits_.slot[k], i = cast_voxel_[slot];
    if (!lies_in(rays_->grid(), hits_.point(bundle_.origin, k), voxels_.cell(first_ + i))) continue;
    if (rays_->limited() &&
        rays_->dropped(*station_, hits_.ray(k), bundle_, slot, behind_glass ? passed[k].share : 1).points > 0)
      continue;
    if (counts_[i] != std::numeric_limits<std::uint32_t>::max()) ++counts_[i];
    if (!masks_.empty()) masks_[i] |= bit;
  }
  bundle_.size = 0;
}

}  // namespace vantage
