// SPDX-License-Identifier: Apache-2.0
#include "placement/plane_quadtree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/parallel.hpp"

namespace vantage {
namespace {

constexpr std::size_t kLeafSize = 8;
constexpr int kMostIdleLevels = 4;  // levels of subdivision in a row that separate nothing before it gives up
constexpr double kSlackShare =
    1e-9;  // share of the larger side of the bounds: well above rounding, well below any relevant distance
constexpr double kNoArea =
    0x1p-48;  // height over length below which (u, v) in double do not define a triangle's inside

Uv operator-(Uv a, Uv b) { return {a.u - b.u, a.v - b.v}; }
double cross(Uv a, Uv b) { return a.u * b.v - a.v * b.u; }
double dot(Uv a, Uv b) { return a.u * b.u + a.v * b.v; }

// Returns twice the signed area of (a, b, p), exactly antisymmetric in a and b, whatever the rounding.
double side_of(Uv a, Uv b, Uv p) {
  const bool turned = b.u < a.u || (b.u == a.u && b.v < a.v);
  if (turned) std::swap(a, b);
  const double area = cross(b - a, p - a);
  return turned ? -area : area;
}

bool finite(Uv p) { return std::isfinite(p.u) && std::isfinite(p.v); }

bool is_candidate(Uv a, Uv b, Uv c) {
  if (!finite(a) || !finite(b) || !finite(c)) return false;
  const double longest = std::max({dot(b - a, b - a), dot(c - b, c - b), dot(a - c, a - c)});
  return std::abs(cross(b - a, c - a)) > kNoArea * longest;
}

// A triangle with its box relative to the tree's corner, rounded outwards.
struct Item {
  float u_min, u_max, v_min, v_max;
  std::uint32_t triangle;
};

float below(double x) { return std::nextafter(static_cast<float>(x), -HUGE_VALF); }
float above(double x) { return std::nextafter(static_cast<float>(x), HUGE_VALF); }

}  // namespace

// Builds nodes of a cell and everything below it. Large cells get threads of their own; the result is the same.
class PlaneQuadtree::Builder {
 public:
  struct Subtree {
    std::vector<Node> nodes{1};  // root first
    std::vector<std::uint32_t> items;
  };

  explicit Builder(const PlaneQuadtree& tree)
      : tree_(tree),
        // A regular mesh is separated after log4(n) levels; the rest is for crowded places.
        max_depth_(static_cast<int>(std::ceil(std::log2(static_cast<double>(tree.candidates_)) / 2)) + 8) {}

  Subtree build(const Cell& cell, std::vector<Item> items) const {
    Subtree result;
    subdivide(result, 0, cell, std::move(items), 0, 0);
    return result;
  }

 private:
  static constexpr int kThreadedLevels = 3;
  static constexpr std::size_t kWorthAThread = 20000;

  void subdivide(Subtree& out, std::uint32_t node, const Cell& cell, std::vector<Item> items, int depth,
                 int idle) const {
    const std::size_t crowd = partial(items, cell);
    if (crowd <= kLeafSize || depth >= max_depth_ || idle >= kMostIdleLevels) {
      out.nodes[node] = {0, static_cast<std::uint32_t>(out.items.size()), static_cast<std::uint32_t>(items.size())};
      for (const Item& item : items) out.items.push_back(item.triangle);
      return;
    }
    const Uv middle{0.5 * (cell.min.u + cell.max.u), 0.5 * (cell.min.v + cell.max.v)};
    std::array<Cell, 4> cells;
    std::array<std::vector<Item>, 4> lists;
    for (int q = 0; q < 4; ++q)
      cells[q] = {{q & 1 ? middle.u : cell.min.u, q & 2 ? middle.v : cell.min.v},
                  {q & 1 ? cell.max.u : middle.u, q & 2 ? cell.max.v : middle.v}};
    const double slack = tree_.slack_, u = middle.u - tree_.min_.u, v = middle.v - tree_.min_.v;
    for (const Item& item : items) {
      const bool left = item.u_min <= u + slack, right = item.u_max >= u - slack;
      const bool lower = item.v_min <= v + slack, upper = item.v_max >= v - slack;
      const bool single = left != right && lower != upper;
      for (int q = 0; q < 4; ++q)
        if ((q & 1 ? right : left) && (q & 2 ? upper : lower) && (single || tree_.overlaps(item.triangle, cells[q])))
          lists[q].push_back(item);
    }
    std::size_t copies = 0, most = 0;
    for (int q = 0; q < 4; ++q) {
      copies += lists[q].size();
      most = std::max(most, partial(lists[q], cells[q]));
    }
    // Subdivision copies triangles in a pile, or around one vertex, without separating them. A crowd in one corner is
    // not yet such a case.
    const bool parted = 4 * most <= 3 * crowd, cornered = 5 * copies <= 6 * items.size();
    idle = parted ? 0 : cornered ? idle : idle + 1;
    const bool threaded = depth < kThreadedLevels && items.size() >= kWorthAThread;
    items = {};
    const auto child = static_cast<std::uint32_t>(out.nodes.size());
    out.nodes[node].child = child;
    out.nodes.resize(out.nodes.size() + 4);
    if (!threaded) {
      for (std::uint32_t q = 0; q < 4; ++q) subdivide(out, child + q, cells[q], std::move(lists[q]), depth + 1, idle);
      return;
    }
    std::array<Subtree, 4> parts;
    parallel::for_all(0, 4, [&](int q) { subdivide(parts[q], 0, cells[q], std::move(lists[q]), depth + 1, idle); });
    for (std::uint32_t q = 0; q < 4; ++q) append(out, child + q, parts[q]);
  }

  // Returns the number of triangles that do not cover the whole cell; those that do would cover all its children, too.
  // Skipped if the cell is a leaf anyway.
  std::size_t partial(const std::vector<Item>& items, const Cell& cell) const {
    if (items.size() <= kLeafSize) return 0;
    const double u_min = cell.min.u - tree_.min_.u, u_max = cell.max.u - tree_.min_.u;
    const double v_min = cell.min.v - tree_.min_.v, v_max = cell.max.v - tree_.min_.v;
    std::size_t count = 0;
    for (const Item& item : items) {
      const bool around = item.u_min <= u_min && item.u_max >= u_max && item.v_min <= v_min && item.v_max >= v_max;
      count += !(around && tree_.covers(item.triangle, cell));
    }
    return count;
  }

  // Puts a subtree's root in place of `node` and the rest at the end.
  static void append(Subtree& out, std::uint32_t node, const Subtree& part) {
    const auto first_node = static_cast<std::uint32_t>(out.nodes.size()),
               first_item = static_cast<std::uint32_t>(out.items.size());
    const auto moved = [&](Node n) {
      if (n.child != 0) n.child += first_node - 1;
      n.first += first_item;
      return n;
    };
    out.nodes[node] = moved(part.nodes[0]);
    for (std::size_t i = 1; i < part.nodes.size(); ++i) out.nodes.push_back(moved(part.nodes[i]));
    out.items.insert(out.items.end(), part.items.begin(), part.items.end());
  }

  const PlaneQuadtree& tree_;
  int max_depth_;
};

PlaneQuadtree::PlaneQuadtree(std::span<const Uv> points, std::span<const Triangle> triangles)
    : points_(points), triangles_(triangles) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  min_ = {kInfinity, kInfinity};
  max_ = {-kInfinity, -kInfinity};
  std::vector<std::uint32_t> candidates;
  candidates.reserve(triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    const Uv a = points[triangles[t][0]], b = points[triangles[t][1]], c = points[triangles[t][2]];
    if (!is_candidate(a, b, c)) continue;
    candidates.push_back(t);
    min_ = {std::min({min_.u, a.u, b.u, c.u}), std::min({min_.v, a.v, b.v, c.v})};
    max_ = {std::max({max_.u, a.u, b.u, c.u}), std::max({max_.v, a.v, b.v, c.v})};
  }
  candidates_ = static_cast<std::uint32_t>(candidates.size());
  if (empty()) {
    min_ = max_ = {};
    return;
  }
  const double magnitude = std::max({std::abs(min_.u), std::abs(min_.v), std::abs(max_.u), std::abs(max_.v)});
  slack_ = kSlackShare * std::max(max_.u - min_.u, max_.v - min_.v) + 0x1p-48 * magnitude;

  std::vector<Item> items;
  items.reserve(candidates.size());
  for (const std::uint32_t t : candidates) {
    const Uv a = points[triangles[t][0]] - min_, b = points[triangles[t][1]] - min_, c = points[triangles[t][2]] - min_;
    items.push_back({below(std::min({a.u, b.u, c.u})), above(std::max({a.u, b.u, c.u})),
                     below(std::min({a.v, b.v, c.v})), above(std::max({a.v, b.v, c.v})), t});
  }
  Builder::Subtree tree = Builder(*this).build({min_, max_}, std::move(items));
  nodes_ = std::move(tree.nodes);
  items_ = std::move(tree.items);
  nodes_.shrink_to_fit();
  items_.shrink_to_fit();
}

bool PlaneQuadtree::any_candidate(std::span<const Uv> points, std::span<const Triangle> triangles) {
  return std::any_of(triangles.begin(), triangles.end(),
                     [&](const Triangle& t) { return is_candidate(points[t[0]], points[t[1]], points[t[2]]); });
}

bool PlaneQuadtree::overlaps(std::uint32_t triangle, const Cell& cell) const {
  const Uv p[3] = {points_[triangles_[triangle][0]], points_[triangles_[triangle][1]],
                   points_[triangles_[triangle][2]]};
  const auto [u_min, u_max] = std::minmax({p[0].u, p[1].u, p[2].u});
  const auto [v_min, v_max] = std::minmax({p[0].v, p[1].v, p[2].v});
  if (u_min > cell.max.u + slack_ || u_max < cell.min.u - slack_ || v_min > cell.max.v + slack_ ||
      v_max < cell.min.v - slack_)
    return false;
  const Uv centre{0.5 * (cell.min.u + cell.max.u), 0.5 * (cell.min.v + cell.max.v)};
  const Uv half{0.5 * (cell.max.u - cell.min.u) + slack_, 0.5 * (cell.max.v - cell.min.v) + slack_};
  const double orientation = cross(p[1] - p[0], p[2] - p[0]) < 0 ? -1 : 1;
  for (int e = 0; e < 3; ++e) {
    const Uv edge = p[(e + 1) % 3] - p[e];
    const double reach = half.u * std::abs(edge.v) + half.v * std::abs(edge.u);
    if (orientation * cross(edge, centre - p[e]) < -reach) return false;
  }
  return true;
}

bool PlaneQuadtree::covers(std::uint32_t triangle, const Cell& cell) const {
  const Uv p[3] = {points_[triangles_[triangle][0]], points_[triangles_[triangle][1]],
                   points_[triangles_[triangle][2]]};
  const double orientation = cross(p[1] - p[0], p[2] - p[0]) < 0 ? -1 : 1;
  const Uv centre{0.5 * (cell.min.u + cell.max.u), 0.5 * (cell.min.v + cell.max.v)};
  const Uv half{0.5 * (cell.max.u - cell.min.u), 0.5 * (cell.max.v - cell.min.v)};
  for (int e = 0; e < 3; ++e) {
    const Uv edge = p[(e + 1) % 3] - p[e];
    if (orientation * cross(edge, centre - p[e]) < half.u * std::abs(edge.v) + half.v * std::abs(edge.u)) return false;
  }
  return true;
}

std::span<const std::uint32_t> PlaneQuadtree::leaf_at(Uv p) const {
  if (empty() ||
      !(p.u >= min_.u - slack_ && p.u <= max_.u + slack_ && p.v >= min_.v - slack_ && p.v <= max_.v + slack_))
    return {};
  Cell cell{min_, max_};
  const Node* node = &nodes_[0];
  while (node->child != 0) {
    const Uv middle{0.5 * (cell.min.u + cell.max.u), 0.5 * (cell.min.v + cell.max.v)};
    const std::uint32_t right = p.u >= middle.u, upper = p.v >= middle.v;
    (right ? cell.min.u : cell.max.u) = middle.u;
    (upper ? cell.min.v : cell.max.v) = middle.v;
    node = &nodes_[node->child + right + 2 * upper];
  }
  return std::span(items_).subspan(node->first, node->count);
}

bool PlaneQuadtree::holds(std::uint32_t triangle, Uv p) const {
  const Uv a = points_[triangles_[triangle][0]], b = points_[triangles_[triangle][1]],
           c = points_[triangles_[triangle][2]];
  const double ab = side_of(a, b, p), bc = side_of(b, c, p), ca = side_of(c, a, p);
  return side_of(a, b, c) < 0 ? ab <= 0 && bc <= 0 && ca <= 0 : ab >= 0 && bc >= 0 && ca >= 0;
}

TrianglePoint PlaneQuadtree::coordinates(std::uint32_t triangle, Uv p) const {
  const Uv i = points_[triangles_[triangle][0]];
  const Uv j = points_[triangles_[triangle][1]] - i, k = points_[triangles_[triangle][2]] - i, q = p - i;
  // Equation 5, over the larger of its two denominators; clamped to equation 4 against rounding.
  const double s = std::clamp((q.v * k.u - q.u * k.v) / (j.v * k.u - j.u * k.v), 0.0, 1.0);
  const double t = std::abs(k.u) >= std::abs(k.v) ? (q.u - j.u * s) / k.u : (q.v - j.v * s) / k.v;
  return {triangle, s, std::clamp(t, 0.0, 1 - s)};
}

double PlaneQuadtree::nearest(std::uint32_t triangle, Uv p, TrianglePoint& at) const {
  double best = std::numeric_limits<double>::infinity();
  for (int e = 0; e < 3; ++e) {
    const Uv a = points_[triangles_[triangle][e]], edge = points_[triangles_[triangle][(e + 1) % 3]] - a;
    const double x = std::clamp(dot(p - a, edge) / dot(edge, edge), 0.0, 1.0);
    const double distance = std::hypot(p.u - a.u - x * edge.u, p.v - a.v - x * edge.v);
    if (distance < best) {
      best = distance;
      std::array<double, 3> weight{};
      weight[e] = 1 - x;
      weight[(e + 1) % 3] = x;
      at = {triangle, weight[1], weight[2]};
    }
  }
  return best;
}

std::optional<TrianglePoint> PlaneQuadtree::find(Uv p) const {
  const auto candidates = leaf_at(p);
  for (const std::uint32_t t : candidates)
    if (holds(t, p)) return coordinates(t, p);
  std::optional<TrianglePoint> result;
  double best = slack_;
  for (const std::uint32_t t : candidates) {
    TrianglePoint at;
    const double distance = nearest(t, p, at);
    if (distance < best || (distance == best && !result)) {
      best = distance;
      result = at;
    }
  }
  return result;
}

void PlaneQuadtree::find_all(Uv p, const std::function<void(const TrianglePoint&)>& found) const {
  for (const std::uint32_t t : leaf_at(p)) {
    TrianglePoint at;
    if (holds(t, p))
      found(coordinates(t, p));
    else if (nearest(t, p, at) <= slack_)
      found(at);
  }
}

std::vector<std::span<const std::uint32_t>> PlaneQuadtree::leaves() const {
  std::vector<std::span<const std::uint32_t>> result;
  for (const Node& node : nodes_)
    if (node.child == 0 && node.count > 0) result.push_back(std::span(items_).subspan(node.first, node.count));
  return result;
}

}  // namespace vantage
