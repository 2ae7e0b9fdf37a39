// SPDX-License-Identifier: Apache-2.0
#include "formats/area_outline.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <unordered_map>
#include <utility>

namespace vantage {
namespace {

constexpr double kWeld_m = 1e-4;      // nearer points are one
constexpr double kOnEdge_m = 5e-4;    // a nearer vertex lies on the edge
constexpr double kStraight_m = 1e-3;  // smaller deviations from a straight line are no corner

using Cell = std::array<std::int64_t, 3>;
struct CellHash {
  std::size_t operator()(const Cell& c) const {
    std::uint64_t h = 0;
    for (const std::int64_t v : c) h = (h ^ static_cast<std::uint64_t>(v)) * 0x9E3779B97F4A7C15u, h ^= h >> 29;
    return static_cast<std::size_t>(h);
  }
};

// Points in the cells of a cubic lattice.
class Lattice {
 public:
  explicit Lattice(double cell_m) : cell_m_(cell_m) {}
  Cell cell(const Vec3& p) const { return {along(p.x), along(p.y), along(p.z)}; }
  void add(const Vec3& p, std::uint32_t id) { points_[cell(p)].push_back(id); }
  // Calls visit(id) for all points in cells that touch the box around a and b, widened by `margin`.
  template <class Visit>
  void around(const Vec3& a, const Vec3& b, double margin, const Visit& visit) const {
    const Vec3 m{margin, margin, margin};
    const Cell low = cell(Vec3{std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)} - m);
    const Cell high = cell(Vec3{std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)} + m);
    for (std::int64_t x = low[0]; x <= high[0]; ++x)
      for (std::int64_t y = low[1]; y <= high[1]; ++y)
        for (std::int64_t z = low[2]; z <= high[2]; ++z) {
          const auto found = points_.find({x, y, z});
          if (found == points_.end()) continue;
          for (const std::uint32_t id : found->second) visit(id);
        }
  }

 private:
  std::int64_t along(double value) const { return static_cast<std::int64_t>(std::floor(value / cell_m_)); }
  double cell_m_;
  std::unordered_map<Cell, std::vector<std::uint32_t>, CellHash> points_;
};

double length(const Vec3& v) { return std::sqrt(dot(v, v)); }

struct Welded {
  std::vector<Vec3> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;  // turned so that they face up
};

Welded weld(const SearchMesh& mesh) {
  Welded welded;
  Lattice lattice(2 * kWeld_m);
  std::vector<std::uint32_t> id_of;
  for (const Vec3& p : mesh.positions) {
    std::uint32_t id = UINT32_MAX;
    lattice.around(p, p, kWeld_m, [&](std::uint32_t other) {
      if (length(welded.points[other] - p) <= kWeld_m) id = std::min(id, other);
    });
    if (id == UINT32_MAX) {
      id = static_cast<std::uint32_t>(welded.points.size());
      welded.points.push_back(p);
      lattice.add(p, id);
    }
    id_of.push_back(id);
  }
  for (const auto& t : mesh.triangles) {
    std::array<std::uint32_t, 3> turned{id_of[t[0]], id_of[t[1]], id_of[t[2]]};
    if (turned[0] == turned[1] || turned[1] == turned[2] || turned[2] == turned[0]) continue;
    const Vec3 a = welded.points[turned[0]], n = cross(welded.points[turned[1]] - a, welded.points[turned[2]] - a);
    if (n.z < 0) std::swap(turned[1], turned[2]);
    welded.triangles.push_back(turned);
  }
  return welded;
}

// Edges with more triangles on one side than on the other, and the excess; split at vertices that lie on them.
std::map<std::pair<std::uint32_t, std::uint32_t>, int> rim_of(const Welded& mesh) {
  double lengths = 0;
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;  // from the lower number: times up less times down
  const auto count = [](auto& into, std::uint32_t a, std::uint32_t b, int times) {
    const auto [at, fresh] = into.try_emplace({std::min(a, b), std::max(a, b)}, 0);
    at->second += a < b ? times : -times;
    if (at->second == 0) into.erase(at);
  };
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      count(edges, t[k], t[(k + 1) % 3], 1);
      lengths += length(mesh.points[t[(k + 1) % 3]] - mesh.points[t[k]]);
    }
  if (edges.empty()) return {};

  // Only ends of remaining edges can lie on other remaining edges.
  Lattice lattice(std::max(lengths / (3 * static_cast<double>(mesh.triangles.size())), 10 * kOnEdge_m));
  std::vector<std::uint32_t> ends;
  for (const auto& [edge, times] : edges) ends.insert(ends.end(), {edge.first, edge.second});
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  for (const std::uint32_t id : ends) lattice.add(mesh.points[id], id);

  std::map<std::pair<std::uint32_t, std::uint32_t>, int> parts;
  for (const auto& [between, times] : edges) {
    const auto& edge = between;  // Clang 14 captures no structured binding
    const Vec3 a = mesh.points[edge.first], along = mesh.points[edge.second] - a;
    const double size = length(along);
    std::vector<std::pair<double, std::uint32_t>> on{{0, edge.first}, {1, edge.second}};
    // In pieces, so that the box around a long slanting edge does not hold half of the site.
    const int pieces = std::clamp(
        static_cast<int>(size / (4 * kOnEdge_m + lengths / (3 * static_cast<double>(mesh.triangles.size())))), 1, 1000);
    for (int piece = 0; piece < pieces; ++piece)
      lattice.around(a + along * (double(piece) / pieces), a + along * (double(piece + 1) / pieces), kOnEdge_m,
                     [&](std::uint32_t id) {
                       if (id == edge.first || id == edge.second) return;
                       const double t = dot(mesh.points[id] - a, along) / (size * size);
                       if (t <= 0 || t >= 1 || length(a + along * t - mesh.points[id]) > kOnEdge_m) return;
                       on.emplace_back(t, id);
                     });
    std::sort(on.begin(), on.end());
    on.erase(std::unique(on.begin(), on.end()), on.end());
    for (std::size_t k = 0; k + 1 < on.size(); ++k) count(parts, on[k].second, on[k + 1].second, times);
  }
  return parts;
}

// Removes points that lie on the line between their neighbours.
std::vector<Vec3> corners_of(const std::vector<Vec3>& ring) {
  std::vector<Vec3> corners;
  const std::size_t n = ring.size();
  for (std::size_t k = 0; k < n; ++k) {
    const Vec3 before = corners.empty() ? ring[n - 1] : corners.back(), after = ring[(k + 1) % n];
    const Vec3 along = after - before;
    const double size = length(along);
    const bool straight = size > 0 && length(cross(ring[k] - before, along)) / size < kStraight_m &&
                          dot(ring[k] - before, along) > 0 && dot(after - ring[k], along) > 0;
    if (!straight) corners.push_back(ring[k]);
  }
  return corners;
}

}  // namespace

std::vector<std::vector<Vec3>> area_outline(const SearchMesh& mesh) {
  const Welded welded = weld(mesh);
  std::multimap<std::uint32_t, std::uint32_t> next;
  for (const auto& [edge, times] : rim_of(welded))
    for (int k = 0; k < std::abs(times); ++k) next.insert(times > 0 ? edge : std::pair(edge.second, edge.first));
  std::vector<std::vector<Vec3>> rings;
  while (!next.empty()) {
    const std::uint32_t first = next.begin()->first;
    std::vector<std::uint32_t> ids{first};
    for (std::uint32_t at = first;;) {
      auto [low, high] = next.equal_range(at);
      if (low == high) break;
      // If rings touch in a point, the sharpest turn to the left keeps them apart.
      auto chosen = low;
      if (std::next(low) != high && ids.size() > 1) {
        const Vec3 here = welded.points[at], came = here - welded.points[ids[ids.size() - 2]];
        const auto turn = [&](std::uint32_t to) {
          const Vec3 go = welded.points[to] - here;
          return std::atan2(came.x * go.y - came.y * go.x, came.x * go.x + came.y * go.y);
        };
        for (auto other = low; other != high; ++other)
          if (turn(other->second) > turn(chosen->second)) chosen = other;
      }
      at = chosen->second;
      next.erase(chosen);
      if (at == first) break;
      ids.push_back(at);
    }
    std::vector<Vec3> ring;
    for (const std::uint32_t id : ids) ring.push_back(welded.points[id]);
    ring = corners_of(ring);
    if (ring.size() >= 3) rings.push_back(std::move(ring));
  }
  return rings;
}

}  // namespace vantage
