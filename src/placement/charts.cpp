// SPDX-License-Identifier: Apache-2.0
#include "placement/charts.hpp"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "core/disjoint_sets.hpp"
#include "core/parallel.hpp"
#include "placement/plan_hull.hpp"
#include "placement/plane_quadtree.hpp"
#include "placement/shelf_packing.hpp"

namespace vantage {
namespace {

constexpr std::uint32_t kNobody = 0xFFFFFFFFu;

// Joins points that share a cell of a grid, or of the grid shifted by half a cell, so that near points meet in one of
// them.
void weld(const std::vector<glm::dvec3>& points, const std::vector<char>& used, double weld_m, DisjointSets& sets) {
  struct Entry {
    std::array<std::int64_t, 3> cell;
    std::uint32_t point;
    bool operator<(const Entry& other) const { return std::tie(cell, point) < std::tie(other.cell, other.point); }
  };
  std::vector<Entry> entries;
  for (const double shift : {0.0, 0.5}) {
    entries.clear();
    for (std::uint32_t p = 0; p < points.size(); ++p) {
      if (!used[p]) continue;
      const auto cell = [&](double x) { return static_cast<std::int64_t>(std::floor(x / weld_m + shift)); };
      entries.push_back({{cell(points[p].x), cell(points[p].y), cell(points[p].z)}, p});
    }
    parallel::sort(entries.begin(), entries.end());
    for (std::size_t i = 1; i < entries.size(); ++i)
      if (entries[i].cell == entries[i - 1].cell) sets.join(entries[i - 1].point, entries[i].point);
  }
}

// Returns true if two triangles seen from above share more than an outline.
bool overlap_in_plan(const std::array<Uv, 3>& a, const std::array<Uv, 3>& b, double tolerance) {
  for (const auto& [from, other] : {std::pair(&a, &b), std::pair(&b, &a)})
    for (int e = 0; e < 3; ++e) {
      const Uv p = (*from)[e], q = (*from)[(e + 1) % 3], r = (*from)[(e + 2) % 3];
      const double length = std::hypot(q.u - p.u, q.v - p.v);
      if (!(length > 0)) return false;
      const auto height = [&](Uv x) { return ((q.u - p.u) * (x.v - p.v) - (q.v - p.v) * (x.u - p.u)) / length; };
      const double inner = height(r) < 0 ? -1 : 1;
      if (std::max({inner * height((*other)[0]), inner * height((*other)[1]), inner * height((*other)[2])}) <=
          tolerance)
        return false;
    }
  return true;
}

// Undirected graph over pieces, as rows of neighbours.
class Graph {
 public:
  Graph() = default;
  Graph(std::size_t nodes, std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs) : first_(nodes + 1, 0) {
    const std::size_t n = pairs.size();
    pairs.reserve(2 * n);
    for (std::size_t i = 0; i < n; ++i) pairs.emplace_back(pairs[i].second, pairs[i].first);
    parallel::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    for (const auto& [a, b] : pairs) {
      ++first_[a + 1];
      neighbour_.push_back(b);
    }
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
  }
  std::span<const std::uint32_t> of(std::uint32_t node) const {
    return std::span(neighbour_).subspan(first_[node], first_[node + 1] - first_[node]);
  }
  bool empty() const { return neighbour_.empty(); }

 private:
  std::vector<std::uint64_t> first_;
  std::vector<std::uint32_t> neighbour_;
};

// Returns pairs of pieces of the same part that overlap in plan view.
Graph find_overlaps(const SurfacePieces& pieces, const std::vector<Triangle>& kept,
                    const std::vector<std::uint32_t>& part) {
  std::vector<Uv> plan;
  plan.reserve(pieces.points.size());
  for (const glm::dvec3& p : pieces.points) plan.push_back({p.x, p.y});
  const PlaneQuadtree tree(plan, kept);
  const auto leaves = tree.leaves();
  const auto corners = [&](std::uint32_t t) {
    return std::array<Uv, 3>{plan[kept[t][0]], plan[kept[t][1]], plan[kept[t][2]]};
  };
  tbb::enumerable_thread_specific<std::vector<std::pair<std::uint32_t, std::uint32_t>>> collected;
  parallel::for_all(tbb::blocked_range<std::size_t>(0, leaves.size()),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      auto& pairs = collected.local();
                      for (std::size_t l = range.begin(); l != range.end(); ++l)
                        for (std::size_t i = 0; i < leaves[l].size(); ++i)
                          for (std::size_t j = i + 1; j < leaves[l].size(); ++j) {
                            const std::uint32_t a = leaves[l][i], b = leaves[l][j];
                            if (part[a] == part[b] && overlap_in_plan(corners(a), corners(b), tree.slack()))
                              pairs.emplace_back(a, b);
                          }
                    });
  std::vector<std::pair<std::uint32_t, std::uint32_t>> all;
  for (auto& pairs : collected) all.insert(all.end(), pairs.begin(), pairs.end());
  return Graph(kept.size(), std::move(all));
}

// Finds touching pieces: those with a common vertex, and those of one source triangle.
class Neighbours {
 public:
  Neighbours(std::span<const std::uint32_t> members, const std::vector<std::array<std::uint32_t, 3>>& welded,
             const std::vector<std::uint32_t>& source) {
    for (const std::uint32_t m : members) {
      for (const std::uint32_t v : welded[m]) by_vertex_.emplace_back(v, m);
      by_source_.emplace_back(source[m], m);
    }
    std::sort(by_vertex_.begin(), by_vertex_.end());
    std::sort(by_source_.begin(), by_source_.end());
  }
  template <class Visit>
  void for_each(const std::array<std::uint32_t, 3>& welded, std::uint32_t source, Visit&& visit) const {
    for (const std::uint32_t v : welded) each(by_vertex_, v, visit);
    each(by_source_, source, visit);
  }

 private:
  using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;
  template <class Visit>
  static void each(const Pairs& pairs, std::uint32_t key, Visit&& visit) {
    for (auto p = std::lower_bound(pairs.begin(), pairs.end(), std::pair{key, 0u}); p != pairs.end() && p->first == key;
         ++p)
      visit(p->second);
  }
  Pairs by_vertex_, by_source_;
};

using WeldedTriangle = std::array<std::uint32_t, 3>;

GroundChart chart_of(const SurfacePieces& pieces, std::vector<std::uint32_t> members) {
  GroundChart chart;
  std::sort(members.begin(), members.end());
  double volume = 0;
  for (const std::uint32_t m : members) {
    const Triangle& t = pieces.triangles[m];
    const double plan_area = piece_plan_area(pieces, m);
    chart.area += piece_area(pieces, m);
    chart.plan_area += plan_area;
    volume += plan_area * (pieces.points[t[0]].z + pieces.points[t[1]].z + pieces.points[t[2]].z) / 3;
  }
  if (chart.plan_area > 0) chart.mean_z = volume / chart.plan_area;
  chart.pieces = std::move(members);
  return chart;
}

}  // namespace

std::vector<GroundChart> make_charts(const SurfacePieces& pieces, double weld_m) {
  const auto count = static_cast<std::uint32_t>(pieces.triangles.size());
  std::vector<char> used(pieces.points.size(), 0);
  for (const Triangle& t : pieces.triangles)
    for (const std::uint32_t v : t) used[v] = 1;
  DisjointSets sets(pieces.points.size());
  weld(pieces.points, used, weld_m, sets);
  std::vector<WeldedTriangle> welded(count);
  for (std::uint32_t i = 0; i < count; ++i)
    for (int c = 0; c < 3; ++c) welded[i][c] = sets.find(pieces.triangles[i][c]);

  // Repeated pieces would make a second chart of the same ground.
  std::vector<char> repeated(count, 0);
  {
    std::vector<std::pair<std::array<std::uint32_t, 3>, std::uint32_t>> sorted(count);
    for (std::uint32_t i = 0; i < count; ++i) {
      sorted[i] = {welded[i], i};
      std::sort(sorted[i].first.begin(), sorted[i].first.end());
    }
    parallel::sort(sorted.begin(), sorted.end());
    for (std::size_t i = 1; i < sorted.size(); ++i) repeated[sorted[i].second] = sorted[i].first == sorted[i - 1].first;
  }

  for (std::uint32_t i = 0; i < count; ++i) {
    sets.join(pieces.triangles[i][0], pieces.triangles[i][1]);
    sets.join(pieces.triangles[i][0], pieces.triangles[i][2]);
    if (i > 0 && pieces.source[i] == pieces.source[i - 1])
      sets.join(pieces.triangles[i][0], pieces.triangles[i - 1][0]);
  }
  std::vector<std::uint32_t> part(count);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> members;  // (part, piece)
  for (std::uint32_t i = 0; i < count; ++i) {
    part[i] = sets.find(pieces.triangles[i][0]);
    if (!repeated[i]) members.emplace_back(part[i], i);
  }
  parallel::sort(members.begin(), members.end());
  std::vector<Triangle> kept = pieces.triangles;
  for (std::uint32_t i = 0; i < count; ++i)
    if (repeated[i]) kept[i] = {0, 0, 0};  // no area, so no candidate
  const Graph overlaps = find_overlaps(pieces, kept, part);

  std::vector<GroundChart> charts;
  std::vector<std::uint32_t> chart_number(count, kNobody), looked_at(count, kNobody);
  std::uint32_t number = 0;
  for (std::size_t begin = 0, end = 0; begin < members.size(); begin = end) {
    std::vector<std::uint32_t> own;
    bool overlapping = false;
    for (end = begin; end < members.size() && members[end].first == members[begin].first; ++end) {
      own.push_back(members[end].second);
      overlapping = overlapping || !overlaps.of(members[end].second).empty();
    }
    if (!overlapping) {
      charts.push_back(chart_of(pieces, std::move(own)));
      continue;
    }
    // Grows a chart from one piece over its neighbours, without overlaps; then another from the remaining pieces.
    const Neighbours neighbours(own, welded, pieces.source);
    for (const std::uint32_t seed : own) {
      if (chart_number[seed] != kNobody) continue;
      std::vector<std::uint32_t> grown{seed};
      chart_number[seed] = looked_at[seed] = number;
      for (std::size_t next = 0; next < grown.size(); ++next)
        neighbours.for_each(welded[grown[next]], pieces.source[grown[next]], [&](std::uint32_t n) {
          if (chart_number[n] != kNobody || looked_at[n] == number) return;
          looked_at[n] = number;
          for (const std::uint32_t other : overlaps.of(n))
            if (chart_number[other] == number) return;
          chart_number[n] = number;
          grown.push_back(n);
        });
      charts.push_back(chart_of(pieces, std::move(grown)));
      ++number;
    }
  }
  std::stable_sort(charts.begin(), charts.end(),
                   [](const GroundChart& a, const GroundChart& b) { return a.area > b.area; });
  return charts;
}

bool holds_disc(const SurfacePieces& pieces, const GroundChart& chart, double radius_m) {
  std::vector<Uv> plan;
  std::vector<Triangle> triangles;
  for (const std::uint32_t piece : chart.pieces) {
    const auto first = static_cast<std::uint32_t>(plan.size());
    for (const std::uint32_t v : pieces.triangles[piece]) plan.push_back({pieces.points[v].x, pieces.points[v].y});
    triangles.push_back({first, first + 1, first + 2});
  }
  const PlaneQuadtree tree(plan, triangles);
  const double diagonal = std::sqrt(0.5);
  const std::array<Uv, 8> compass{{{1, 0},
                                   {-1, 0},
                                   {0, 1},
                                   {0, -1},
                                   {diagonal, diagonal},
                                   {-diagonal, -diagonal},
                                   {diagonal, -diagonal},
                                   {-diagonal, diagonal}}};
  const auto fits = [&](double u, double v) {
    return std::all_of(compass.begin(), compass.end(), [&](Uv way) {
      return tree.find({u + radius_m * way.u, v + radius_m * way.v}).has_value();
    });
  };
  for (const Triangle& t : triangles) {
    const Uv a = plan[t[0]], b = plan[t[1]], c = plan[t[2]];
    if (fits((a.u + b.u + c.u) / 3, (a.v + b.v + c.v) / 3) || fits((a.u + b.u) / 2, (a.v + b.v) / 2) ||
        fits((b.u + c.u) / 2, (b.v + c.v) / 2) || fits((c.u + a.u) / 2, (c.v + a.v) / 2))
      return true;
  }
  return false;
}

SearchMesh unfold(const SurfacePieces& pieces, const std::vector<GroundChart>& charts, const Vec3& origin) {
  struct Frame {
    Rectangle rectangle;
    double scale;
  };
  std::vector<Frame> frames;
  std::vector<Uv> sizes;
  double total = 0;
  for (const GroundChart& chart : charts) {
    std::vector<Uv> plan;
    for (const std::uint32_t piece : chart.pieces)
      for (const std::uint32_t v : pieces.triangles[piece]) plan.push_back({pieces.points[v].x, pieces.points[v].y});
    Rectangle r = smallest_rectangle(convex_hull(std::move(plan)));
    if (charts.size() > 1 && r.max.v - r.min.v > r.max.u - r.min.u) {
      // Turns it to lie flat, which packs better on shelves.
      const Rectangle upright = r;
      r = {-upright.sine, upright.cosine, {upright.min.v, -upright.max.u}, {upright.max.v, -upright.min.u}};
    }
    const double scale = std::sqrt(chart.area / chart.plan_area);
    frames.push_back({r, scale});
    sizes.push_back({scale * (r.max.u - r.min.u), scale * (r.max.v - r.min.v)});
    total += chart.area;
  }
  const Packing packing = pack_shelves(sizes, 1e-4 * std::sqrt(total));

  SearchMesh mesh;
  std::vector<std::uint32_t> number(pieces.points.size(), kNobody);
  for (std::size_t c = 0; c < charts.size(); ++c) {
    const Frame& f = frames[c];
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const std::uint32_t piece : charts[c].pieces) {
      Triangle t;
      for (int corner = 0; corner < 3; ++corner) {
        const std::uint32_t v = pieces.triangles[piece][corner];
        // An earlier chart may have numbered the point already, for its own copy.
        if (number[v] == kNobody || number[v] < first) {
          number[v] = static_cast<std::uint32_t>(mesh.positions.size());
          const glm::dvec3& p = pieces.points[v];
          mesh.positions.push_back(to_vec3(p) + origin);
          const Uv q = f.rectangle.along({p.x, p.y});
          mesh.uvs.push_back({(packing.corner[c].u + f.scale * (q.u - f.rectangle.min.u)) / packing.size.v,
                              (packing.corner[c].v + f.scale * (q.v - f.rectangle.min.v)) / packing.size.v});
        }
        t[corner] = number[v];
      }
      mesh.triangles.push_back(t);
    }
  }
  return mesh;
}

}  // namespace vantage
