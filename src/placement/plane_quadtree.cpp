// SPDX-License-Identifier: Apache-2.0
#include "placement/plane_quadtree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace vantage {
namespace {

constexpr std::size_t leaf_size = 8;
constexpr int patience = 4;  // levels of subdivision in a row that part nothing, before it is given up
constexpr double slack_share =
    1e-9;  // of the larger side of the bounds: well above rounding, well below any distance that matters
constexpr double no_area =
    0x1p-48;  // height over length below which (u, v) rounded to double say nothing of a triangle's inside

Uv operator-(Uv a, Uv b) { return {a.u - b.u, a.v - b.v}; }
double cross(Uv a, Uv b) { return a.u * b.v - a.v * b.u; }
double dot(Uv a, Uv b) { return a.u * b.u + a.v * b.v; }

// Twice the signed area of (a, b, p). Exactly antisymmetric in a and b, whatever the rounding.
double side_of(Uv a, Uv b, Uv p) {
  const bool turned = b.u < a.u || (b.u == a.u && b.v < a.v);
  if (turned) std::swap(a, b);
  const double area = cross(b - a, p - a);
  return turned ? -area : area;
}

bool finite(Uv p) { return std::isfinite(p.u) && std::isfinite(p.v); }

}  // namespace

PlaneQuadtree::PlaneQuadtree(std::span<const Uv> points, std::span<const Triangle> triangles)
    : points_(points), triangles_(triangles) {
  constexpr double inf = std::numeric_limits<double>::infinity();
  min_ = {inf, inf};
  max_ = {-inf, -inf};
  std::vector<std::uint32_t> items;
  items.reserve(triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    const Uv a = points[triangles[t][0]], b = points[triangles[t][1]], c = points[triangles[t][2]];
    if (!finite(a) || !finite(b) || !finite(c)) continue;
    const double longest = std::max({dot(b - a, b - a), dot(c - b, c - b), dot(a - c, a - c)});
    if (!(std::abs(cross(b - a, c - a)) > no_area * longest)) continue;
    items.push_back(t);
    for (const Uv p : {a, b, c}) {
      min_ = {std::min(min_.u, p.u), std::min(min_.v, p.v)};
      max_ = {std::max(max_.u, p.u), std::max(max_.v, p.v)};
    }
  }
  candidates_ = static_cast<std::uint32_t>(items.size());
  if (empty()) {
    min_ = max_ = {};
    return;
  }
  const double magnitude = std::max({std::abs(min_.u), std::abs(min_.v), std::abs(max_.u), std::abs(max_.v)});
  slack_ = slack_share * std::max(max_.u - min_.u, max_.v - min_.v) + 0x1p-48 * magnitude;
  // A regular mesh is parted after log4(n) levels; the rest is for crowded places.
  max_depth_ = static_cast<int>(std::ceil(std::log2(static_cast<double>(candidates_)) / 2)) + 8;
  nodes_.emplace_back();
  subdivide(0, {min_, max_}, std::move(items), 0, 0);
  nodes_.shrink_to_fit();
  items_.shrink_to_fit();
}

void PlaneQuadtree::subdivide(std::uint32_t node, const Cell& cell, std::vector<std::uint32_t> items, int depth,
                              int idle) {
  // Triangles that cover the whole cell would cover all its children too: only the others count.
  const auto partial = [this](const std::vector<std::uint32_t>& list, const Cell& c) {
    std::size_t count = 0;
    for (const std::uint32_t t : list) count += !covers(t, c);
    return count;
  };
  const std::size_t crowd = items.size() <= leaf_size ? 0 : partial(items, cell);
  const auto keep = [&] {
    nodes_[node] = {0, static_cast<std::uint32_t>(items_.size()), static_cast<std::uint32_t>(items.size())};
    items_.insert(items_.end(), items.begin(), items.end());
  };
  if (crowd <= leaf_size || depth >= max_depth_ || idle >= patience) return keep();

  const Uv middle{0.5 * (cell.min.u + cell.max.u), 0.5 * (cell.min.v + cell.max.v)};
  std::array<Cell, 4> cells;
  std::array<std::vector<std::uint32_t>, 4> lists;
  std::size_t copies = 0, most = 0;
  for (int q = 0; q < 4; ++q) {
    cells[q] = {{q & 1 ? middle.u : cell.min.u, q & 2 ? middle.v : cell.min.v},
                {q & 1 ? cell.max.u : middle.u, q & 2 ? cell.max.v : middle.v}};
    for (const std::uint32_t t : items)
      if (overlaps(t, cells[q])) lists[q].push_back(t);
    copies += lists[q].size();
    most = std::max(most, partial(lists[q], cells[q]));
  }
  // Triangles in a pile, or around one vertex, are copied by subdivision but not parted. A crowd in one corner is
  // neither yet.
  const bool parted = 4 * most <= 3 * crowd, cornered = 5 * copies <= 6 * items.size();
  idle = parted ? 0 : cornered ? idle : idle + 1;
  items = {};
  const auto child = static_cast<std::uint32_t>(nodes_.size());
  nodes_[node].child = child;
  nodes_.resize(nodes_.size() + 4);
  for (std::uint32_t q = 0; q < 4; ++q) subdivide(child + q, cells[q], std::move(lists[q]), depth + 1, idle);
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
