// SPDX-License-Identifier: Apache-2.0
#include "scene/cut_coplanar.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>

#include "core/parallel.hpp"
#include "scene/coplanar.hpp"
#include "scene/cut_polygon.hpp"
#include "scene/near_placed.hpp"
#include "scene/positions.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

using Weights = std::array<double, 3>;  // of a triangle's corners

// A blocking triangle, and the triangles in its plane that cover part of it.
struct Covered {
  std::uint32_t blocking = 0;
  std::span<const CoplanarPair> by;
};

// Coordinates in a triangle's plane; the triangle is counter-clockwise there.
class Frame {
 public:
  Frame(const std::vector<Float3>& positions, const Triangle& triangle) {
    const auto at = [&](std::size_t k) { return to_glm(positions[triangle[k]]); };
    origin_ = at(0);
    const glm::dvec3 edge = at(1) - origin_, normal = cross(edge, at(2) - origin_);
    x_ = normalize(edge);
    y_ = normalize(cross(normal, x_));
    for (std::size_t k = 0; k < 3; ++k) corners_.push_back(flat(at(k)));
  }

  PlanePoint flat(const glm::dvec3& p) const { return {dot(p - origin_, x_), dot(p - origin_, y_)}; }
  Float3 lifted(const PlanePoint& p) const { return without_minus_zero(to_float3(origin_ + x_ * p.x + y_ * p.y)); }
  const ConvexPolygon& triangle() const { return corners_; }
  Weights weights(const PlanePoint& p) const {
    const PlanePoint &b = corners_[1], &c = corners_[2];
    const double wc = p.y / c.y, wb = (p.x - wc * c.x) / b.x;
    return {1 - wb - wc, wb, wc};
  }

 private:
  glm::dvec3 origin_, x_, y_;
  ConvexPolygon corners_;
};

ConvexPolygon counter_clockwise(ConvexPolygon t) {
  if ((t[1].x - t[0].x) * (t[2].y - t[0].y) < (t[1].y - t[0].y) * (t[2].x - t[0].x)) std::swap(t[1], t[2]);
  return t;
}

std::uint32_t mixed_colour(const std::vector<std::uint32_t>& colours, const Triangle& t, const Weights& w) {
  std::uint32_t colour = 0;
  for (int shift = 0; shift < 32; shift += 8) {
    double value = 0;
    for (std::size_t k = 0; k < 3; ++k) value += w[k] * static_cast<double>(colours[t[k]] >> shift & 0xFFu);
    colour |= static_cast<std::uint32_t>(std::lround(std::clamp(value, 0.0, 255.0))) << shift;
  }
  return colour;
}

Float3 mixed_normal(const std::vector<Float3>& normals, const Triangle& t, const Weights& w) {
  glm::dvec3 n(0);
  for (std::size_t k = 0; k < 3; ++k) n += to_glm(normals[t[k]]) * w[k];
  const double size = length(n);
  return size > 0 ? to_float3(n / size) : Float3{};
}

// Appends a vertex of triangle `t` at `p` and returns its number.
std::uint32_t add_vertex(RawScene& raw, std::vector<Float3>& positions, const Frame& frame, const Triangle& t,
                         const PlanePoint& p) {
  const Weights w = frame.weights(p);
  if (!raw.normals.empty()) raw.normals.push_back(mixed_normal(raw.normals, t, w));
  if (!raw.texcoords.empty()) {
    Float2 uv;
    for (std::size_t k = 0; k < 3; ++k) {
      uv.x += static_cast<float>(w[k]) * raw.texcoords[t[k]].x;
      uv.y += static_cast<float>(w[k]) * raw.texcoords[t[k]].y;
    }
    raw.texcoords.push_back(uv);
  }
  if (!raw.colours.empty()) raw.colours.push_back(mixed_colour(raw.colours, t, w));
  positions.push_back(frame.lifted(p));
  return static_cast<std::uint32_t>(positions.size() - 1);
}

// Returns runs of pairs with the same blocking triangle. `numbers`: its number in the scene, for each pair.
std::vector<Covered> by_blocking(std::span<const CoplanarPair> pairs, std::span<const std::uint32_t> numbers) {
  std::vector<Covered> runs;
  for (std::size_t begin = 0, end = 0; begin < pairs.size(); begin = end) {
    while (end < pairs.size() && pairs[end].blocking == pairs[begin].blocking) ++end;
    runs.push_back({numbers[begin], pairs.subspan(begin, end - begin)});
  }
  return runs;
}

std::size_t count_surveyed(std::span<const CoplanarPair> pairs) {
  std::vector<std::uint32_t> surveyed;
  for (const CoplanarPair& pair : pairs) surveyed.push_back(pair.surveyed);
  std::ranges::sort(surveyed);
  return static_cast<std::size_t>(std::unique(surveyed.begin(), surveyed.end()) - surveyed.begin());
}

// Removes the triangles with these numbers from shared meshes, at all places that have one of them. Returns true if
// there are any. Throws Error out_of_memory.
bool take_out_cut(RawScene& raw, std::vector<Float3>& positions, const Vec3& origin,
                  const std::vector<std::uint32_t>& cut) {
  const std::vector<PlacedRun> all = placed_runs(raw);
  std::vector<std::vector<std::uint8_t>> taken(raw.shared.size());
  std::vector<std::uint8_t> runs(all.size());
  const auto mesh_of = [&](std::size_t run) { return static_cast<std::size_t>(all[run].shared - raw.shared.data()); };
  for (const std::uint32_t t : cut) {
    if (t < raw.triangles.size()) continue;
    const std::size_t run = run_of(all, t);
    taken[mesh_of(run)].resize(all[run].count());
    taken[mesh_of(run)][t - all[run].first] = 1;
    runs[run] = 1;
  }
  std::uint64_t stored = 0;
  for (std::size_t k = 0; k < all.size(); ++k)
    if (runs[k]) stored += static_cast<std::uint64_t>(std::ranges::count(taken[mesh_of(k)], 1));
  if (stored == 0) return false;
  constexpr std::uint64_t kStored = 3 * (24 + 2 * 12 + 8 + 4 + 12) + 12;  // corners in double and float with attributes
  if (stored > raw.spare_bytes / 2 / kStored || raw.triangles.size() + stored > std::uint64_t{1} << 31)
    throw Error(Errc::out_of_memory,
                std::to_string(stored) +
                    " triangles of meshes that nodes share, over all places, lie in one plane with "
                    "surveyed ones and do not fit into memory; leave either of them out, or allow "
                    "more memory");
  raw.positions.resize(positions.size());
  take_out(raw, runs, taken);
  for (std::size_t v = positions.size(); v < raw.positions.size(); ++v)
    positions.push_back(without_minus_zero(to_float3(raw.positions[v] - to_glm(origin))));
  raw.positions = {};
  return true;
}

}  // namespace

CoplanarCut cut_coplanar(RawScene& raw, std::vector<Float3>& positions, const Vec3& origin) {
  const auto has = [&](Role role) {
    return std::ranges::any_of(raw.meshes, [&](const MeshInfo& mesh) { return !mesh.glass && mesh.role == role; });
  };
  if (!has(Role::surveyed) || !has(Role::blocking)) return {};
  // Bytes of a pair while the list grows; of a part, which is a polygon, corners and triangles; and of a listed
  // triangle of a shared mesh, with corners and leaves of two trees.
  constexpr std::uint64_t kPair = 3 * sizeof(CoplanarPair), kPart = 400, kNear = 200;
  const std::uint64_t most_pairs = std::min(std::uint64_t{1} << 25, raw.spare_bytes / 2 / kPair);
  const bool shares = std::ranges::any_of(raw.placed, [](const auto& placed) { return !placed.empty(); });
  NearPlaced near;
  Coplanar coplanar;
  std::vector<std::uint32_t> cut;  // numbers of blocking triangles in the scene, one for each pair
  do {
    if (shares) {
      near = near_placed(raw, positions, origin, raw.spare_bytes / 2 / kNear);
      coplanar = find_coplanar(near.positions, near.triangles, near.ranges, raw.meshes, most_pairs, near.surveyed);
    } else {
      coplanar = find_coplanar(positions, raw.triangles, raw.ranges, raw.meshes, most_pairs);
    }
    cut.clear();
    for (const CoplanarPair& pair : coplanar.pairs) cut.push_back(shares ? near.numbers[pair.blocking] : pair.blocking);
  } while (shares && take_out_cut(raw, positions, origin, cut));  // then all of them are the scene's own
  if (coplanar.pairs.empty()) return {};
  const std::span<const Float3> corners = shares ? near.positions : positions;
  const std::span<const Triangle> covering = shares ? near.triangles : raw.triangles;
  const std::vector<Covered> covered = by_blocking(coplanar.pairs, cut);
  CutAllowance allowance;
  allowance.parts = std::min(allowance.parts.load(), static_cast<std::int64_t>(raw.spare_bytes / 2 / kPart));
  std::vector<std::vector<ConvexPolygon>> left(covered.size());
  parallel::for_all(std::size_t{0}, covered.size(), [&](std::size_t k) {
    const Frame frame(positions, raw.triangles[covered[k].blocking]);
    std::vector<ConvexPolygon> holes;
    for (const CoplanarPair& pair : covered[k].by) {
      ConvexPolygon hole;
      for (const std::uint32_t v : covering[pair.surveyed]) hole.push_back(frame.flat(to_glm(corners[v])));
      holes.push_back(counter_clockwise(std::move(hole)));
    }
    left[k] = cut_away(frame.triangle(), holes, coplanar.slack_m, allowance);
  });

  std::vector<Triangle> triangles;
  std::size_t next = 0;  // index into `covered`
  for (MeshRange& range : raw.ranges) {
    const std::uint32_t first = range.first_triangle, end = first + range.triangle_count;
    range.first_triangle = static_cast<std::uint32_t>(triangles.size());
    for (std::uint32_t t = first; t < end; ++t) {
      const Triangle triangle = raw.triangles[t];
      if (next == covered.size() || covered[next].blocking != t) {
        triangles.push_back(triangle);
        continue;
      }
      const Frame frame(positions, triangle);
      for (const ConvexPolygon& part : left[next]) {
        std::vector<std::uint32_t> corners;
        for (const PlanePoint& p : part) corners.push_back(add_vertex(raw, positions, frame, triangle, p));
        for (std::size_t k = 2; k < corners.size(); ++k) triangles.push_back({corners[0], corners[k - 1], corners[k]});
      }
      ++next;
    }
    range.triangle_count = static_cast<std::uint32_t>(triangles.size()) - range.first_triangle;
  }
  raw.triangles = std::move(triangles);
  drop_empty_meshes(raw);
  return {count_surveyed(coplanar.pairs), covered.size()};
}

}  // namespace vantage
