// SPDX-License-Identifier: Apache-2.0
// Ear clipping; holes are joined to the outline by bridges first (Eberly, Triangulation by Ear Clipping, 2002).
#include "import/mesh/polygon.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/first_numbers.hpp"

namespace vantage::importer {
namespace {

double cross_of(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// Returns the normal by Newell's sum, which concave corners and small unevenness do not turn.
glm::dvec3 normal_of(std::span<const glm::dvec3> points) {
  glm::dvec3 sum(0);
  for (std::size_t i = 2; i < points.size(); ++i) sum += cross(points[i - 1] - points[0], points[i] - points[0]);
  return sum;
}

bool cross_each_other(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c, const glm::dvec2& d) {
  const auto side = [](double value) { return (value > 0) - (value < 0); };
  return side(cross_of(a, b, c)) * side(cross_of(a, b, d)) < 0 && side(cross_of(c, d, a)) * side(cross_of(c, d, b)) < 0;
}

class Cutter {
 public:
  explicit Cutter(std::vector<glm::dvec2> points) : points_(std::move(points)) {}

  // Cuts off ears from a counterclockwise ring of point numbers.
  void clip(std::vector<std::uint32_t> ring, std::vector<std::uint32_t>& out) const {
    const std::size_t n = ring.size();
    std::vector<std::uint32_t> next(n), before(n);
    for (std::uint32_t i = 0; i < n; ++i) next[i] = (i + 1) % n, before[i] = (i + n - 1) % n;
    const auto at = [&](std::uint32_t i) -> const glm::dvec2& { return points_[ring[i]]; };
    const auto is_ear = [&](std::uint32_t i) {
      const glm::dvec2 &a = at(before[i]), &b = at(i), &c = at(next[i]);
      if (!(cross_of(a, b, c) > 0)) return false;
      for (std::uint32_t k = next[next[i]]; k != before[i]; k = next[k]) {
        const glm::dvec2& p = at(k);
        if (p == a || p == b || p == c || cross_of(at(before[k]), p, at(next[k])) > 0) continue;
        if (cross_of(a, b, p) >= 0 && cross_of(b, c, p) >= 0 && cross_of(c, a, p) >= 0) return false;
      }
      return true;
    };
    std::uint32_t i = 0;
    for (std::size_t left = n, passed = 0; left >= 3;) {
      // A ring that crosses itself may have no ear: any corner goes then, those that have an area first.
      const double area = cross_of(at(before[i]), at(i), at(next[i]));
      const bool cut = passed < left ? is_ear(i) : passed < 2 * left ? area > 0 : passed < 3 * left ? area != 0 : true;
      if (cut) {
        if (area != 0) out.insert(out.end(), {ring[before[i]], ring[i], ring[next[i]]});
        next[before[i]] = next[i], before[next[i]] = before[i];
        passed = 0, --left;
      } else {
        ++passed;
      }
      i = next[i];
    }
  }

  // Joins a hole to a ring by the shortest bridge that crosses no edge.
  void join(std::vector<std::uint32_t>& ring, const std::vector<std::uint32_t>& hole,
            const std::vector<std::vector<std::uint32_t>>& others) const {
    std::vector<std::tuple<double, std::size_t, std::size_t>> bridges;
    for (std::size_t r = 0; r < ring.size(); ++r)
      for (std::size_t h = 0; h < hole.size(); ++h) {
        const glm::dvec2 way = points_[hole[h]] - points_[ring[r]];
        bridges.emplace_back(dot(way, way), r, h);
      }
    std::ranges::sort(bridges);
    const auto blocked = [&](std::size_t r, std::size_t h) {
      const glm::dvec2 &from = points_[ring[r]], &to = points_[hole[h]];
      const auto crosses = [&](const std::vector<std::uint32_t>& loop) {
        for (std::size_t k = 0; k < loop.size(); ++k)
          if (cross_each_other(from, to, points_[loop[k]], points_[loop[(k + 1) % loop.size()]])) return true;
        return false;
      };
      if (!within(ring, r, to)) return true;
      return crosses(ring) || crosses(hole) || std::ranges::any_of(others, crosses);
    };
    const auto open = std::ranges::find_if(
        bridges, [&](const auto& bridge) { return !blocked(std::get<1>(bridge), std::get<2>(bridge)); });
    const auto [distance, r, h] = open == bridges.end() ? bridges.front() : *open;
    std::vector<std::uint32_t> joined(ring.begin(), ring.begin() + static_cast<std::ptrdiff_t>(r) + 1);
    for (std::size_t k = 0; k <= hole.size(); ++k) joined.push_back(hole[(h + k) % hole.size()]);
    joined.insert(joined.end(), ring.begin() + static_cast<std::ptrdiff_t>(r), ring.end());
    ring = std::move(joined);
  }

 private:
  // Returns true if the segment from corner r to `to` begins inside the counterclockwise ring.
  bool within(const std::vector<std::uint32_t>& ring, std::size_t r, const glm::dvec2& to) const {
    const glm::dvec2 &a = points_[ring[(r + ring.size() - 1) % ring.size()]], &b = points_[ring[r]],
                     &c = points_[ring[(r + 1) % ring.size()]];
    const bool left_of_both = cross_of(a, b, to) >= 0 && cross_of(b, c, to) >= 0;
    return cross_of(a, b, c) >= 0 ? left_of_both : cross_of(a, b, to) >= 0 || cross_of(b, c, to) >= 0;
  }

  std::vector<glm::dvec2> points_;
};

double area_of(const std::vector<glm::dvec2>& points, const std::vector<std::uint32_t>& ring) {
  double area = 0;
  for (std::size_t i = 2; i < ring.size(); ++i) area += cross_of(points[ring[0]], points[ring[i - 1]], points[ring[i]]);
  return area;
}

}  // namespace

void cut_into_triangles(std::span<const glm::dvec3> points, std::span<const std::size_t> loop_sizes,
                        std::vector<std::uint32_t>& out) {
  const std::size_t outline = loop_sizes.empty() ? 0 : loop_sizes[0];
  if (outline < 3) return;
  if (outline == 3 && loop_sizes.size() == 1) {
    out.insert(out.end(), {0, 1, 2});
    return;
  }
  const glm::dvec3 normal = normal_of(points.first(outline));
  if (outline == 4 && loop_sizes.size() == 1) {
    // Cuts along the diagonal from the first corner, unless the second or the last corner is concave.
    const auto side = [&](std::size_t a, std::size_t b, std::size_t c) {
      return dot(cross(points[b] - points[a], points[c] - points[a]), normal);
    };
    if (side(0, 1, 2) >= 0 && side(0, 2, 3) >= 0)
      out.insert(out.end(), {0, 1, 2, 0, 2, 3});
    else
      out.insert(out.end(), {0, 1, 3, 1, 2, 3});
    return;
  }
  // Projects along the axis in which the polygon appears largest.
  const glm::dvec3 size = abs(normal);
  const int drop = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const int u = (drop + 1) % 3, v = (drop + 2) % 3;
  std::vector<glm::dvec2> flat;
  flat.reserve(points.size());
  for (const glm::dvec3& p : points) {
    const glm::dvec3 d = p - points[0];
    flat.push_back(normal[drop] >= 0 ? glm::dvec2(d[u], d[v]) : glm::dvec2(d[v], d[u]));
  }
  std::vector<std::vector<std::uint32_t>> loops;
  std::uint32_t first = 0;
  for (const std::size_t count : loop_sizes) {
    std::vector<std::uint32_t> loop = first_numbers<std::uint32_t>(count, first);
    first += static_cast<std::uint32_t>(count);
    const bool hole = !loops.empty();
    if (hole && area_of(flat, loop) > 0) std::ranges::reverse(loop);
    if (count >= 3) loops.push_back(std::move(loop));
  }
  const Cutter cutter(std::move(flat));
  std::vector<std::uint32_t> ring = std::move(loops.front());
  loops.erase(loops.begin());
  while (!loops.empty()) {
    const std::vector<std::uint32_t> hole = std::move(loops.back());
    loops.pop_back();
    cutter.join(ring, hole, loops);
  }
  cutter.clip(std::move(ring), out);
}

}  // namespace vantage::importer
