// SPDX-License-Identifier: Apache-2.0
#include "scene/open_doors.hpp"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <tuple>
#include <utility>

#include "scene/door_leaf.hpp"
#include "scene/positions.hpp"
#include "scene/sound_triangle.hpp"

namespace vantage {
namespace {

constexpr double kFree = 0.65;             // what is clear before and behind a door; a cabinet is less deep
constexpr double kAside = 0.08;            // how far beside the leaf its wall is looked for
constexpr double kWallHalf = 0.8;          // and how far before and behind
constexpr double kThicker = 0.04;          // by which a wall is thicker than a leaf
constexpr double kNear = 0.02;             // what is as near to a leaf is of it
constexpr std::size_t kMostLeaves = 2000;  // leaves that are looked at
constexpr std::uint32_t kNone = 0xFFFFFFFFu;

// The model, or what it would be in another unit and with another axis up: metres, z up.
struct Reading {
  const RawScene& raw;
  double metres = 1;
  UpAxis up = UpAxis::y;
  glm::dvec3 at(std::uint32_t vertex) const { return with_up(up, raw.positions[vertex]) * metres; }
};

// The leaf that a mesh may be, or a connected part of one, and its triangles, ascending.
struct Leaf : DoorLeaf {
  std::size_t mesh = 0;
  bool named = false;
  std::vector<std::uint32_t> triangles;
  // The panel alone, without a frame and its trims: from and to, through the leaf, from its middle. None, if a pane of
  // another mesh fills the leaf.
  std::optional<std::pair<double, double>> panel;
  // As thick as the panel.
  DoorLeaf alone() const {
    DoorLeaf leaf = *this;
    if (panel) leaf.middle += through * ((panel->first + panel->second) / 2);
    leaf.thickness = panel ? panel->second - panel->first : 0;
    return leaf;
  }
};

// A connected part of a mesh: its triangles, as places in MeshParts::triangles, and the box around them.
struct MeshPart {
  std::uint32_t first = 0, end = 0;
  glm::dvec3 low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};
};
struct MeshParts {
  std::vector<std::uint32_t> triangles;
  std::vector<MeshPart> parts;
};

// Triangles that share a corner, by its position, are connected.
MeshParts parts_of(const Reading& model, std::size_t mesh) {
  const MeshRange& range = model.raw.ranges[mesh];
  const std::span<const Triangle> triangles =
      std::span(model.raw.triangles).subspan(range.first_triangle, range.triangle_count);
  std::uint32_t low = kNone, high = 0;
  for (const Triangle& t : triangles)
    for (const std::uint32_t v : t) low = std::min(low, v), high = std::max(high, v);
  if (triangles.empty()) return {};
  std::vector<std::uint32_t> parent(high - low + 1), order(parent.size());
  std::iota(parent.begin(), parent.end(), 0U), std::iota(order.begin(), order.end(), 0U);
  const auto find = [&](std::uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  const auto join = [&](std::uint32_t v, std::uint32_t w) {
    v = find(v), w = find(w);
    parent[std::max(v, w)] = std::min(v, w);
  };
  for (const Triangle& t : triangles) join(t[0] - low, t[1] - low), join(t[0] - low, t[2] - low);
  std::erase_if(order, [&](std::uint32_t v) { return !sound(model.raw.positions[low + v]); });
  const auto key = [&](std::uint32_t v) {
    const glm::dvec3& p = model.raw.positions[low + v];
    return std::tie(p.x, p.y, p.z);
  };
  tbb::parallel_sort(order.begin(), order.end(), [&](std::uint32_t v, std::uint32_t w) { return key(v) < key(w); });
  for (std::size_t i = 1; i < order.size(); ++i)
    if (key(order[i]) == key(order[i - 1])) join(order[i], order[i - 1]);
  MeshParts out;
  std::vector<std::uint32_t>& number = order;  // of the part of each root
  number.assign(parent.size(), kNone);
  for (const Triangle& t : triangles) {
    std::uint32_t& part = number[find(t[0] - low)];
    if (part == kNone) part = static_cast<std::uint32_t>(out.parts.size()), out.parts.emplace_back();
    MeshPart& of = out.parts[part];
    ++of.end;
    for (const std::uint32_t v : t) of.low = glm::min(of.low, model.at(v)), of.high = glm::max(of.high, model.at(v));
  }
  std::uint32_t at = 0;
  for (MeshPart& part : out.parts) part.first = at, at += part.end, part.end = part.first;
  out.triangles.resize(triangles.size());
  for (std::uint32_t i = 0; i < triangles.size(); ++i)
    out.triangles[out.parts[number[find(triangles[i][0] - low)]].end++] = range.first_triangle + i;
  return out;
}

// Triangles by squares in plan view, so that those beside a leaf are found.
class PlanIndex {
 public:
  explicit PlanIndex(const Reading& model) : model_(model) {
    glm::dvec2 high(-std::numeric_limits<double>::infinity());
    low_ = -high;
    const std::vector<Triangle>& triangles = model.raw.triangles;
    for (const Triangle& t : triangles)
      if (const auto box = box_of(t)) low_ = glm::min(low_, box->first), high = glm::max(high, box->second);
    if (!(low_.x <= high.x)) return;
    cell_ = std::max({kCell, (high.x - low_.x) / kMostCells, (high.y - low_.y) / kMostCells});
    nx_ = static_cast<std::size_t>((high.x - low_.x) / cell_) + 1;
    const std::size_t ny = static_cast<std::size_t>((high.y - low_.y) / cell_) + 1;
    first_.assign(nx_ * ny + 1, 0);
    for (std::uint32_t i = 0; i < triangles.size(); ++i) visit(i, [&](std::size_t c) { ++first_[c + 1]; });
    for (std::size_t c = 1; c < first_.size(); ++c) first_[c] += first_[c - 1];
    items_.resize(first_.back());
    std::vector<std::uint32_t> at(first_.begin(), first_.end() - 1);
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
      bool many = false;
      visit(
          i, [&](std::size_t c) { items_[at[c]++] = i; }, &many);
      if (many) large_.push_back(i);
    }
  }

  // Triangles that may come within `reach` of a place in plan view, but none of `leaf`, ascending.
  std::vector<std::uint32_t> beside(const Leaf& leaf, double reach) const {
    std::vector<std::uint32_t> near = large_;
    const glm::dvec2 middle(leaf.middle.x, leaf.middle.y);
    for_cells(middle - reach, middle + reach, [&](std::size_t c) {
      near.insert(near.end(), items_.begin() + first_[c], items_.begin() + first_[c + 1]);
    });
    std::ranges::sort(near);
    near.erase(std::unique(near.begin(), near.end()), near.end());
    std::vector<std::uint32_t> others;
    std::ranges::set_difference(near, leaf.triangles, std::back_inserter(others));
    return others;
  }

 private:
  static constexpr double kCell = 2;  // metres
  static constexpr double kMostCells = 1000;
  static constexpr std::size_t kMany = 64;  // cells of a triangle that is kept apart

  std::optional<std::pair<glm::dvec2, glm::dvec2>> box_of(const Triangle& t) const {
    glm::dvec2 low(std::numeric_limits<double>::infinity()), high(-low);
    for (const std::uint32_t v : t) {
      const glm::dvec3 p = model_.at(v);
      if (!sound(p)) return std::nullopt;
      low = glm::min(low, glm::dvec2(p.x, p.y)), high = glm::max(high, glm::dvec2(p.x, p.y));
    }
    return std::pair{low, high};
  }
  template <class Visit>
  void for_cells(const glm::dvec2& low, const glm::dvec2& high, const Visit& visit) const {
    if (first_.empty()) return;
    const std::size_t ny = (first_.size() - 1) / nx_;
    const auto at = [&](double x, std::size_t n) {
      return static_cast<std::size_t>(std::clamp(x / cell_, 0.0, static_cast<double>(n - 1)));
    };
    for (std::size_t y = at(low.y - low_.y, ny); y <= at(high.y - low_.y, ny); ++y)
      for (std::size_t x = at(low.x - low_.x, nx_); x <= at(high.x - low_.x, nx_); ++x) visit(y * nx_ + x);
  }
  template <class Visit>
  void visit(std::uint32_t triangle, const Visit& visit, bool* many = nullptr) const {
    const auto box = box_of(model_.raw.triangles[triangle]);
    if (!box) return;
    const glm::dvec2 cells = (box->second - box->first) / cell_ + 1.0;
    if (cells.x * cells.y > static_cast<double>(kMany)) {
      if (many) *many = true;
      return;
    }
    for_cells(box->first, box->second, visit);
  }

  const Reading& model_;
  glm::dvec2 low_{};
  double cell_ = kCell;
  std::size_t nx_ = 1;
  std::vector<std::uint32_t> first_, items_, large_;
};

// Distances along a line, from its point, to triangles within `far` either way: nearest on each side.
struct Sight {
  double before = std::numeric_limits<double>::infinity(), behind = before;
};
// Visits how far along a level line, from its point, it meets each of some triangles.
template <class Visit>
void for_hits(const Reading& model, std::span<const std::uint32_t> triangles, const glm::dvec3& from,
              const glm::dvec3& way, const Visit& visit) {
  for (const std::uint32_t i : triangles) {
    const Triangle& t = model.raw.triangles[i];
    const glm::dvec3 a = model.at(t[0]) - from, b = model.at(t[1]) - from, c = model.at(t[2]) - from;
    if (std::min({a.z, b.z, c.z}) > 0 || std::max({a.z, b.z, c.z}) < 0) continue;
    const glm::dvec3 n = cross(b - a, c - a);
    const double across = dot(n, way);
    if (across == 0) continue;
    const double at = dot(n, a) / across;
    const glm::dvec3 p = way * at;
    const double u = dot(cross(b - a, p - a), n), v = dot(cross(c - b, p - b), n), w = dot(cross(a - c, p - c), n);
    if (std::min({u, v, w}) >= 0) visit(at);
  }
}
Sight look(const Reading& model, std::span<const std::uint32_t> triangles, const glm::dvec3& from,
           const glm::dvec3& way, double far) {
  Sight sight;
  for_hits(model, triangles, from, way, [&](double at) {
    if (!(std::abs(at) <= far)) return;
    double& side = at > 0 ? sight.before : sight.behind;
    side = std::min(side, std::abs(at));
  });
  return sight;
}

// Where a leaf is looked at: beside the middle, where handles and bars are few.
glm::dvec3 face_of(const DoorLeaf& leaf) {
  return leaf.middle + leaf.along * (0.17 * leaf.width) + glm::dvec3{0, 0, 0.13 * leaf.height};
}

// Where the line through a leaf meets triangles within it.
std::optional<std::pair<double, double>> panel_among(const Reading& model, std::span<const std::uint32_t> triangles,
                                                     const Leaf& leaf) {
  const double half = leaf.thickness / 2 + kNear;
  double from = std::numeric_limits<double>::infinity(), to = -from;
  for_hits(model, triangles, face_of(leaf), leaf.through, [&](double at) {
    if (std::abs(at) <= half) from = std::min(from, at), to = std::max(to, at);
  });
  if (!(from <= to)) return std::nullopt;
  return std::pair{from, to};
}

// The leaf that triangles may be, if they have the size of one.
std::optional<Leaf> leaf_of(const Reading& model, std::size_t mesh, std::vector<std::uint32_t> triangles) {
  std::vector<Triangle> own;
  own.reserve(triangles.size());
  for (const std::uint32_t i : triangles) own.push_back(model.raw.triangles[i]);
  const auto box = leaf_around(own, [&](std::uint32_t vertex) { return model.at(vertex); });
  if (!box) return std::nullopt;
  Leaf leaf{*box, mesh, names_a_door(model.raw.meshes[mesh].name), std::move(triangles), {}};
  leaf.panel = panel_among(model, leaf.triangles, leaf);
  if (!leaf.named && !is_plain_leaf(leaf.alone())) return std::nullopt;
  return leaf;
}

bool leads_through(const Reading& model, std::span<const std::uint32_t> others, const Leaf& leaf) {
  const double half = leaf.thickness / 2, far = half + kFree;
  const Sight sight = look(model, others, face_of(leaf), leaf.through, far);
  const auto clear = [&](double distance) { return distance >= far || distance <= half + kNear; };
  return clear(sight.before) && clear(sight.behind);
}

// Whether a wall stands beside and over a panel, and is thicker: it may lie in the plane of one of the wall's faces.
bool in_a_wall(const Reading& model, std::span<const std::uint32_t> others, const DoorLeaf& panel) {
  const auto wall_at = [&](const glm::dvec3& p) {
    const Sight sight = look(model, others, p, panel.through, kWallHalf);
    return sight.before + sight.behind >= panel.thickness + kThicker && sight.before <= kWallHalf &&
           sight.behind <= kWallHalf;
  };
  const glm::dvec3 aside = panel.along * (panel.width / 2 + kAside), up{0, 0, panel.height / 2 + kAside};
  return wall_at(panel.middle + aside) && wall_at(panel.middle - aside) && wall_at(panel.middle + up);
}

std::vector<std::uint32_t> triangles_of(const MeshRange& range) {
  std::vector<std::uint32_t> all(range.triangle_count);
  std::iota(all.begin(), all.end(), range.first_triangle);
  return all;
}

// Whether a part lies in the box of a leaf, as handles do, which stand out.
bool lies_in(const MeshPart& part, const Leaf& leaf) {
  constexpr double kHandle = 0.12;
  const glm::dvec3 size{leaf.width / 2 + kNear, leaf.thickness / 2 + kHandle, leaf.height / 2 + kNear};
  for (int corner = 0; corner < 8; ++corner) {
    glm::dvec3 p;
    for (int k = 0; k < 3; ++k) p[k] = (corner >> k & 1 ? part.high[k] : part.low[k]) - leaf.middle[k];
    if (std::abs(dot(p, leaf.along)) > size.x || std::abs(dot(p, leaf.through)) > size.y || std::abs(p.z) > size.z)
      return false;
  }
  return true;
}

// Leaves among the meshes, and with `parts` among the connected parts of larger ones, with what lies in these; at most
// so many that look like one are looked at.
std::vector<Leaf> leaves_of(const Reading& model, const std::vector<std::uint8_t>& candidate, std::size_t most,
                            bool parts) {
  std::vector<Leaf> leaves;
  std::vector<MeshParts> parted;
  std::optional<PlanIndex> index;
  std::size_t looked = 0;
  const auto is_door = [&](Leaf& leaf) {
    ++looked;
    if (!index) index.emplace(model);
    const auto others = index->beside(leaf, leaf.width / 2 + leaf.thickness / 2 + kFree + kAside);
    if (!leads_through(model, others, leaf)) return false;
    if (leaf.named) return true;
    if (!leaf.panel) leaf.panel = panel_among(model, others, leaf);
    return leaf.panel && in_a_wall(model, others, leaf.alone());
  };
  for (std::size_t m = 0; m < model.raw.meshes.size() && looked < most; ++m) {
    if (!candidate.empty() && !candidate[m]) continue;
    if (std::optional<Leaf> leaf = leaf_of(model, m, triangles_of(model.raw.ranges[m]))) {
      if (is_door(*leaf)) leaves.push_back(std::move(*leaf));
      continue;
    }
    if (!parts) continue;
    MeshParts& own = parted.emplace_back(parts_of(model, m));
    for (const MeshPart& part : own.parts) {
      const glm::dvec3 size = part.high - part.low;
      if (own.parts.size() == 1 || !is_leaf_high(size.z) || looked >= most) continue;
      const auto begin = own.triangles.begin();
      std::optional<Leaf> leaf = leaf_of(model, m, {begin + part.first, begin + part.end});
      if (leaf && is_door(*leaf)) leaves.push_back(std::move(*leaf));
    }
  }
  for (Leaf& leaf : leaves)
    for (const MeshParts& some : parted)
      for (const MeshPart& part : some.parts)
        if (lies_in(part, leaf))
          leaf.triangles.insert(leaf.triangles.end(), some.triangles.begin() + part.first,
                                some.triangles.begin() + part.end);
  // A pane in its frame is no door of its own.
  std::vector<Leaf> doors;
  for (const Leaf& leaf : leaves)
    if (std::ranges::none_of(leaves, [&](const Leaf& other) {
          return other.width * other.height > leaf.width * leaf.height &&
                 std::ranges::find(other.triangles, leaf.triangles.front()) != other.triangles.end();
        }))
      doors.push_back(leaf);
  return doors;
}

}  // namespace

std::vector<std::size_t> leaves_if(const RawScene& raw, Unit unit, UpAxis up) {
  constexpr std::size_t kFew = 50;  // as few say as much as many
  std::vector<std::size_t> meshes;
  for (const Leaf& leaf : leaves_of({raw, metres_in(unit), up}, {}, kFew, false)) meshes.push_back(leaf.mesh);
  return meshes;
}

std::vector<std::string> open_doors(RawScene& raw, const std::vector<std::uint8_t>& candidate) {
  std::vector<std::uint8_t> keep(raw.triangles.size(), 1);
  std::vector<std::string> names;
  std::optional<std::size_t> last;
  for (const Leaf& leaf : leaves_of({raw}, candidate, kMostLeaves, true)) {
    for (const std::uint32_t i : leaf.triangles) keep[i] = 0;
    // A door of several materials is several meshes of one name.
    const std::string& name = raw.meshes[leaf.mesh].name;
    if (names.empty() || names.back() != name || last == leaf.mesh) names.push_back(name);
    last = leaf.mesh;
  }
  if (names.empty() || std::ranges::count(keep, 1) == 0) return {};  // a model of doors alone
  keep_triangles(raw, keep);
  return names;
}

}  // namespace vantage
