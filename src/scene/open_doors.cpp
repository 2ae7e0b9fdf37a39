// SPDX-License-Identifier: Apache-2.0
#include "scene/open_doors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <tuple>
#include <utility>

#include "core/parallel.hpp"
#include "scene/connected_triangles.hpp"
#include "scene/door_leaf.hpp"
#include "scene/positions.hpp"
#include "scene/shared_meshes.hpp"
#include "scene/sound_triangle.hpp"
#include "scene/told_by_name.hpp"

namespace vantage {
namespace {

constexpr double kFree = 0.65;             // free space before and behind a door; a cabinet is less deep
constexpr double kAside = 0.08;            // how far beside the leaf a wall is searched
constexpr double kWallHalf = 0.8;          // how far before and behind it
constexpr double kThicker = 0.04;          // least by which a wall is thicker than a leaf
constexpr double kNear = 0.02;             // parts this near to a leaf belong to it
constexpr double kGap = 0.03;              // between leaves of one door
constexpr double kApart = 0.15;            // between the planes of two leaves that slide
constexpr double kWidestOpening = 6;       // filled by several leaves
constexpr std::size_t kMostLeaves = 2000;  // leaves that are examined
constexpr std::uint32_t kNone = 0xFFFFFFFFu;

// The model as it is, or in another unit and with another axis up: metres, z up. Shared meshes are examined only by
// glTF's rule.
struct Reading {
  const RawScene& raw;
  double metres = 1;
  UpAxis up = UpAxis::y;
  std::vector<PlacedRun> runs = {};
  std::vector<Box> boxes = {};  // around each run

  glm::dvec3 at(std::uint32_t vertex) const { return with_up(up, raw.positions[vertex]) * metres; }
  std::array<glm::dvec3, 3> corners(std::uint32_t triangle) const {
    if (triangle < raw.triangles.size()) {
      const Triangle& t = raw.triangles[triangle];
      return {at(t[0]), at(t[1]), at(t[2])};
    }
    const PlacedRun& run = runs[run_of(runs, triangle)];
    const Triangle& t = run.shared->triangles[triangle - run.first];
    return {run.at(t[0]), run.at(t[1]), run.at(t[2])};
  }
  // Returns the first and the end of the runs of a mesh.
  std::pair<std::size_t, std::size_t> runs_of(std::size_t mesh) const {
    const auto of = std::ranges::equal_range(runs, mesh, {}, &PlacedRun::range);
    return {static_cast<std::size_t>(of.begin() - runs.begin()), static_cast<std::size_t>(of.end() - runs.begin())};
  }
};

std::vector<Box> boxes_of(std::span<const PlacedRun> runs) {
  std::vector<Box> boxes(runs.size());
  parallel::for_all(std::size_t{0}, runs.size(), [&](std::size_t k) {
    for (const Triangle& t : runs[k].shared->triangles)
      for (const std::uint32_t v : t)
        if (const glm::dvec3 p = runs[k].at(v); sound(p)) boxes[k].extend(to_vec3(p));
  });
  return boxes;
}

// A leaf: a mesh or a connected part of one, with its triangles, ascending.
struct Leaf : DoorLeaf {
  std::size_t mesh = 0;
  bool named = false;
  std::vector<std::uint32_t> triangles;
  // The panel without frame and trims: its range through the leaf, from the leaf's middle. Empty if a pane of another
  // mesh fills the leaf.
  std::optional<std::pair<double, double>> panel;
  // Returns the leaf with the panel's thickness.
  DoorLeaf alone() const {
    DoorLeaf leaf = *this;
    if (panel) leaf.middle += through * ((panel->first + panel->second) / 2);
    leaf.thickness = panel ? panel->second - panel->first : 0;
    return leaf;
  }
};

// The connected parts of a mesh in place, with their boxes and the box around all.
struct MeshParts {
  std::shared_ptr<const Connected> connected;
  std::uint32_t first = 0;  // triangle
  std::vector<Box> boxes = {};
  Box all = {};
  std::vector<std::uint32_t> triangles_of(std::size_t part) const {
    std::vector<std::uint32_t> numbers;
    for (std::uint32_t k = connected->begin[part]; k < connected->begin[part + 1]; ++k)
      numbers.push_back(first + connected->triangles[k]);
    return numbers;
  }
};

MeshParts parts_from(const Reading& model, std::uint32_t first, std::shared_ptr<const Connected> connected) {
  MeshParts parts{std::move(connected), first};
  for (std::size_t part = 0; part + 1 < parts.connected->begin.size(); ++part) {
    Box& box = parts.boxes.emplace_back();
    for (std::uint32_t k = parts.connected->begin[part]; k < parts.connected->begin[part + 1]; ++k)
      for (const glm::dvec3& p : model.corners(first + parts.connected->triangles[k])) box.extend(to_vec3(p));
    parts.all.extend(box.min), parts.all.extend(box.max);
  }
  return parts;
}

// Returns the parts of each mesh that `wanted` marks: of its own triangles, and of the meshes that it shares.
std::vector<std::vector<MeshParts>> parts_of(const Reading& model, const std::vector<std::uint8_t>& wanted) {
  const RawScene& raw = model.raw;
  std::vector<std::shared_ptr<const Connected>> shared(raw.shared.size());
  const auto number_of = [&](const PlacedRun& run) { return static_cast<std::size_t>(run.shared - raw.shared.data()); };
  for (const PlacedRun& run : model.runs)
    if (auto& connected = shared[number_of(run)]; !connected && wanted[run.range])
      connected = std::make_shared<const Connected>(
          connect<Float3>(run.shared->triangles, std::span<const Float3>(run.shared->positions)));
  std::vector<std::vector<MeshParts>> parts(raw.meshes.size());
  parallel::for_all(std::size_t{0}, raw.meshes.size(), [&](std::size_t m) {
    if (!wanted[m]) return;
    const MeshRange& range = raw.ranges[m];
    if (range.triangle_count > 0)
      parts[m].push_back(parts_from(
          model, range.first_triangle,
          std::make_shared<const Connected>(connect<glm::dvec3>(
              std::span(raw.triangles).subspan(range.first_triangle, range.triangle_count), raw.positions))));
    for (auto [k, end] = model.runs_of(m); k < end; ++k)
      parts[m].push_back(parts_from(model, model.runs[k].first, shared[number_of(model.runs[k])]));
  });
  return parts;
}

// Indexes the model's own triangles by squares in plan view, to find those beside a leaf. Shared meshes are searched by
// their placed boxes.
class PlanIndex {
 public:
  explicit PlanIndex(const Reading& model) : model_(model) {
    glm::dvec2 high(-std::numeric_limits<double>::infinity());
    low_ = -high;
    const auto triangles = static_cast<std::uint32_t>(model.raw.triangles.size());
    for (std::uint32_t i = 0; i < triangles; ++i)
      if (const auto box = box_of(i)) low_ = glm::min(low_, box->first), high = glm::max(high, box->second);
    if (!(low_.x <= high.x)) return;
    cell_ = std::max({kCell, (high.x - low_.x) / kMostCells, (high.y - low_.y) / kMostCells});
    nx_ = static_cast<std::size_t>((high.x - low_.x) / cell_) + 1;
    const std::size_t ny = static_cast<std::size_t>((high.y - low_.y) / cell_) + 1;
    first_.assign(nx_ * ny + 1, 0);
    for (std::uint32_t i = 0; i < triangles; ++i) visit(i, [&](std::size_t c) { ++first_[c + 1]; });
    for (std::size_t c = 1; c < first_.size(); ++c) first_[c] += first_[c - 1];
    items_.resize(first_.back());
    std::vector<std::uint32_t> at(first_.begin(), first_.end() - 1);
    for (std::uint32_t i = 0; i < triangles; ++i) {
      bool many = false;
      visit(
          i, [&](std::size_t c) { items_[at[c]++] = i; }, &many);
      if (many) large_.push_back(i);
    }
  }

  // Returns triangles that may come within `reach` of a place in plan view, without those of `leaf`, ascending.
  std::vector<std::uint32_t> beside(const Leaf& leaf, double reach) const {
    std::vector<std::uint32_t> near = large_;
    const glm::dvec2 middle(leaf.middle.x, leaf.middle.y);
    for_cells(middle - reach, middle + reach, [&](std::size_t c) {
      near.insert(near.end(), items_.begin() + first_[c], items_.begin() + first_[c + 1]);
    });
    std::ranges::sort(near);
    near.erase(std::unique(near.begin(), near.end()), near.end());
    const auto meets = [&](const auto& low, const auto& high) {
      return low.x <= middle.x + reach && high.x >= middle.x - reach && low.y <= middle.y + reach &&
             high.y >= middle.y - reach;
    };
    for (std::size_t k = 0; k < model_.runs.size(); ++k) {
      if (!meets(model_.boxes[k].min, model_.boxes[k].max)) continue;
      for (std::uint32_t i = model_.runs[k].first; i < model_.runs[k].first + model_.runs[k].count(); ++i)
        if (const auto box = box_of(i); box && meets(box->first, box->second)) near.push_back(i);
    }
    std::vector<std::uint32_t> others;
    std::ranges::set_difference(near, leaf.triangles, std::back_inserter(others));
    return others;
  }

 private:
  static constexpr double kCell = 2;  // metres
  static constexpr double kMostCells = 1000;
  static constexpr std::size_t kMany = 64;  // a triangle with more cells is kept apart

  std::optional<std::pair<glm::dvec2, glm::dvec2>> box_of(std::uint32_t triangle) const {
    glm::dvec2 low(std::numeric_limits<double>::infinity()), high(-low);
    for (const glm::dvec3& p : model_.corners(triangle)) {
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
    const auto box = box_of(triangle);
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

// Distances along a line to the nearest triangle on each side of its point; infinite beyond `far`.
struct Sight {
  double before = std::numeric_limits<double>::infinity(), behind = before;
};
// Visits the signed distances at which a level line meets each of some triangles.
template <class Visit>
void for_hits(const Reading& model, std::span<const std::uint32_t> triangles, const glm::dvec3& from,
              const glm::dvec3& way, const Visit& visit) {
  for (const std::uint32_t i : triangles) {
    const auto corners = model.corners(i);
    const glm::dvec3 a = corners[0] - from, b = corners[1] - from, c = corners[2] - from;
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

// Returns the point through which a leaf is probed: beside the middle, where handles and bars are few.
glm::dvec3 face_of(const DoorLeaf& leaf) {
  return leaf.middle + leaf.along * (0.17 * leaf.width) + glm::dvec3{0, 0, 0.13 * leaf.height};
}

// Returns the range in which the line through a leaf meets triangles within it.
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

// Returns the leaf of these triangles, if they have the size of one.
std::optional<Leaf> leaf_of(const Reading& model, std::size_t mesh, std::vector<std::uint32_t> triangles) {
  const auto box = leaf_around(triangles.size(), [&](std::uint32_t k) { return model.corners(triangles[k]); });
  if (!box) return std::nullopt;
  Leaf leaf{*box, mesh, names_a_door(model.raw.meshes[mesh].name), std::move(triangles), {}};
  leaf.panel = panel_among(model, leaf.triangles, leaf);
  if (!leaf.named && !is_plain_leaf(leaf.alone())) return std::nullopt;
  return leaf;
}

// Returns the gate of these triangles, or one leaf of several.
std::optional<Leaf> gate_of(const Reading& model, std::size_t mesh, std::vector<std::uint32_t> triangles) {
  const auto box = leaf_around(
      triangles.size(), [&](std::uint32_t k) { return model.corners(triangles[k]); }, kGateSizes);
  if (!box) return std::nullopt;
  Leaf leaf{*box, mesh, names_a_door(model.raw.meshes[mesh].name), std::move(triangles), {}};
  leaf.panel = panel_among(model, leaf.triangles, leaf);
  return leaf;
}

bool leads_through(const Reading& model, std::span<const std::uint32_t> others, const Leaf& leaf) {
  const double half = leaf.thickness / 2, far = half + kFree;
  const Sight sight = look(model, others, face_of(leaf), leaf.through, far);
  const auto clear = [&](double distance) { return distance >= far || distance <= half + kNear; };
  return clear(sight.before) && clear(sight.behind);
}

// Surroundings of a panel: a thicker wall, whose face the panel may be flush with; or a frame of anything, such as
// posts and panes.
struct Around {
  bool wall_beside = false, wall_above = false, frame = false;
};
Around around(const Reading& model, std::span<const std::uint32_t> others, const DoorLeaf& panel) {
  const auto sight = [&](const glm::dvec3& p) { return look(model, others, p, panel.through, kWallHalf); };
  const auto wall = [&](const Sight& seen) {
    return seen.before + seen.behind >= panel.thickness + kThicker && seen.before <= kWallHalf &&
           seen.behind <= kWallHalf;
  };
  const auto any = [&](const Sight& seen) { return std::min(seen.before, seen.behind) <= kApart; };
  const glm::dvec3 aside = panel.along * (panel.width / 2 + kAside), up{0, 0, panel.height / 2 + kAside};
  const Sight left = sight(panel.middle - aside), right = sight(panel.middle + aside), above = sight(panel.middle + up);
  return {wall(left) && wall(right), wall(above), any(left) && any(right) && any(above)};
}
// Returns true if side walls run past a panel on both sides, as walls of a passage run past a shutter.
bool in_a_passage(const Reading& model, std::span<const std::uint32_t> others, const DoorLeaf& panel) {
  const double half = panel.width / 2, off = panel.thickness / 2 + 0.25;
  const auto ends = [&](double distance) { return distance >= half - kAside && distance <= half + kAside; };
  return std::ranges::all_of(std::array{-off, off}, [&](double at) {
    const Sight seen = look(model, others, panel.middle + panel.through * at, panel.along, half + kAside);
    return ends(seen.before) && ends(seen.behind);
  });
}
bool in_a_wall(const Reading& model, std::span<const std::uint32_t> others, const DoorLeaf& panel) {
  const Around found = around(model, others, panel);
  return found.wall_beside && found.wall_above;
}

// Returns true for two leaves side by side in one opening.
bool side_by_side(const DoorLeaf& a, const DoorLeaf& b) {
  const glm::dvec3 between = b.middle - a.middle;
  const double gap = std::abs(dot(between, a.along)) - (a.width + b.width) / 2;
  return std::abs(dot(a.along, b.along)) > 0.99 && std::abs(dot(between, a.through)) <= kApart &&
         std::abs(gap) <= kGap && std::abs(between.z) <= kGap && std::abs(a.height - b.height) <= kGap;
}

// Returns the box around several leaves.
DoorLeaf together(std::span<const Leaf> leaves) {
  DoorLeaf all = leaves.front().alone();
  double from = std::numeric_limits<double>::infinity(), to = -from, before = from, behind = -from;
  for (const Leaf& leaf : leaves) {
    const DoorLeaf panel = leaf.alone();
    const double along = dot(panel.middle, all.along), through = dot(panel.middle, all.through);
    from = std::min(from, along - panel.width / 2), to = std::max(to, along + panel.width / 2);
    before = std::min(before, through - panel.thickness / 2), behind = std::max(behind, through + panel.thickness / 2);
  }
  const double z = all.middle.z;
  all.middle = all.along * ((from + to) / 2) + all.through * ((before + behind) / 2);
  all.middle.z = z, all.width = to - from, all.thickness = behind - before;
  return all;
}

// Finds doors of several leaves, and gates, which only the opening around all leaves shows.
std::vector<Leaf> gates_among(const Reading& model, const PlanIndex& index, const std::vector<Leaf>& leaves) {
  std::vector<Leaf> gates;
  std::vector<std::uint8_t> done(leaves.size(), 0);
  for (std::size_t first = 0; first < leaves.size(); ++first) {
    if (done[first]) continue;
    std::vector<Leaf> door;
    std::vector<std::size_t> open{first};
    done[first] = 1;
    while (!open.empty()) {
      const std::size_t k = open.back();
      open.pop_back();
      door.push_back(leaves[k]);
      for (std::size_t other = 0; other < leaves.size(); ++other)
        if (!done[other] && side_by_side(leaves[k], leaves[other])) done[other] = 1, open.push_back(other);
    }
    DoorLeaf all = together(door);
    if (all.width > kWidestOpening) continue;
    Leaf whole{all, door.front().mesh, false, {}, {}};
    for (const Leaf& leaf : door)
      whole.triangles.insert(whole.triangles.end(), leaf.triangles.begin(), leaf.triangles.end());
    std::ranges::sort(whole.triangles);
    const auto beside = index.beside(whole, all.width / 2 + kFree + kAside);
    const Around found = around(model, beside, all);
    const bool named = std::ranges::all_of(door, &Leaf::named);
    const bool leaf_named =
        std::ranges::all_of(door, [&](const Leaf& leaf) { return names_a_leaf(model.raw.meshes[leaf.mesh].name); });
    // Wider panels are those of a façade between columns.
    constexpr std::size_t kMostLeavesOfOne = 4;
    constexpr double kWidestLeaf = 1.6, kWidestGate = 4.2;
    const bool several = door.size() > 1;
    const bool of_leaves = several && door.size() <= kMostLeavesOfOne && all.width <= kWidestGate &&
                           std::ranges::all_of(door, [](const Leaf& leaf) { return leaf.width <= kWidestLeaf; });
    if ((named && (found.wall_beside || in_a_passage(model, beside, all))) || (several && leaf_named && found.frame) ||
        (of_leaves && found.wall_beside && found.wall_above))
      gates.insert(gates.end(), door.begin(), door.end());
  }
  return gates;
}

// Returns the triangles of a mesh that has the height of a leaf; else none.
std::vector<std::uint32_t> triangles_of(const Reading& model, std::size_t mesh) {
  const MeshRange& range = model.raw.ranges[mesh];
  Box box;
  const auto [begin, end] = model.runs_of(mesh);
  for (std::size_t k = begin; k < end; ++k) box.extend(model.boxes[k].min), box.extend(model.boxes[k].max);
  if (range.triangle_count == 0 && !kGateSizes.high(box.size().z)) return {};
  std::vector<std::uint32_t> all;
  const auto add = [&](std::uint32_t first, std::uint32_t n) {
    for (std::uint32_t i = first; i < first + n; ++i) all.push_back(i);
  };
  add(range.first_triangle, range.triangle_count);
  for (std::size_t k = begin; k < end; ++k) add(model.runs[k].first, model.runs[k].count());
  return all;
}

// Returns true if a part lies in the box of a leaf, enlarged for handles, which stand out.
bool lies_in(const Box& part, const Leaf& leaf) {
  constexpr double kHandle = 0.12;
  const glm::dvec3 size{leaf.width / 2 + kNear, leaf.thickness / 2 + kHandle, leaf.height / 2 + kNear};
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 p = glm::dvec3(corner & 1 ? part.max.x : part.min.x, corner & 2 ? part.max.y : part.min.y,
                                    corner & 4 ? part.max.z : part.min.z) -
                         leaf.middle;
    if (std::abs(dot(p, leaf.along)) > size.x || std::abs(dot(p, leaf.through)) > size.y || std::abs(p.z) > size.z)
      return false;
  }
  return true;
}

// Finds leaves among the meshes, and with `parts` also among the connected parts of larger ones, with smaller parts
// inside them. Examines at most `most` candidates.
std::vector<Leaf> leaves_of(const Reading& model, const std::vector<std::uint8_t>& candidate, std::size_t most,
                            bool parts) {
  std::vector<Leaf> leaves;
  std::vector<Leaf> of_several;
  std::optional<PlanIndex> index;
  std::size_t looked = 0;
  // Collects a gate that is free on both sides, so that it may be one leaf of several.
  const auto look_at_gate = [&](std::optional<Leaf> gate) {
    if (!gate || of_several.size() >= most) return;
    if (!index) index.emplace(model);
    const auto others = index->beside(*gate, gate->width / 2 + gate->thickness / 2 + kFree + kAside);
    if (!gate->panel) gate->panel = panel_among(model, others, *gate);
    // The line may pass between the bars of a grille.
    if ((gate->panel || gate->named) && leads_through(model, others, *gate)) of_several.push_back(std::move(*gate));
  };
  const auto is_door = [&](Leaf& leaf) {
    ++looked;
    if (!index) index.emplace(model);
    const auto others = index->beside(leaf, leaf.width / 2 + leaf.thickness / 2 + kFree + kAside);
    if (!leads_through(model, others, leaf)) return false;
    if (leaf.named) return true;
    if (!leaf.panel) leaf.panel = panel_among(model, others, leaf);
    return leaf.panel && in_a_wall(model, others, leaf.alone());
  };
  const std::size_t meshes = model.raw.meshes.size();
  std::vector<std::optional<Leaf>> whole(meshes);
  std::vector<std::uint8_t> larger(meshes, 0);
  for (std::size_t m = 0; m < meshes; ++m) {
    if (!candidate.empty() && !candidate[m]) continue;
    whole[m] = leaf_of(model, m, triangles_of(model, m));
    larger[m] = parts && !whole[m];
  }
  std::vector<std::vector<MeshParts>> parted = parts_of(model, larger);
  for (std::size_t m = 0; m < meshes && looked < most; ++m) {
    if (whole[m] && is_door(*whole[m]))
      leaves.push_back(std::move(*whole[m]));
    else if (parts && (candidate.empty() || candidate[m]))
      look_at_gate(gate_of(model, m, triangles_of(model, m)));
    std::size_t count = 0;
    for (const MeshParts& some : parted[m]) count += some.boxes.size();
    if (count < 2) continue;
    for (const MeshParts& some : parted[m])
      for (std::size_t k = 0; k < some.boxes.size() && looked < most; ++k) {
        if (!kGateSizes.high(some.boxes[k].size().z)) continue;
        std::optional<Leaf> leaf = leaf_of(model, m, some.triangles_of(k));
        if (leaf && is_door(*leaf))
          leaves.push_back(std::move(*leaf));
        else
          look_at_gate(gate_of(model, m, some.triangles_of(k)));
      }
  }
  if (index)
    for (Leaf& gate : gates_among(model, *index, of_several)) leaves.push_back(std::move(gate));
  for (Leaf& leaf : leaves)
    for (const auto& of_mesh : parted)
      for (const MeshParts& some : of_mesh) {
        const double far = leaf.width + leaf.height;
        if (some.all.min.x > leaf.middle.x + far || some.all.max.x < leaf.middle.x - far ||
            some.all.min.y > leaf.middle.y + far || some.all.max.y < leaf.middle.y - far)
          continue;
        for (std::size_t k = 0; k < some.boxes.size(); ++k) {
          if (!lies_in(some.boxes[k], leaf)) continue;
          const auto own = some.triangles_of(k);
          leaf.triangles.insert(leaf.triangles.end(), own.begin(), own.end());
        }
      }
  // A pane in a frame is no separate door.
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
  Reading model{.raw = raw, .runs = placed_runs(raw)};
  model.boxes = boxes_of(model.runs);
  std::vector<std::uint8_t> keep(raw.triangles.size(), 1), lose(model.runs.size(), 0);
  std::vector<std::vector<std::uint8_t>> keep_of(model.runs.size());  // of runs that lose triangles
  std::vector<std::string> names;
  std::optional<std::size_t> last;
  for (const Leaf& leaf : leaves_of(model, candidate, kMostLeaves, true)) {
    for (const std::uint32_t i : leaf.triangles) {
      if (i < keep.size()) {
        keep[i] = 0;
        continue;
      }
      const std::size_t k = run_of(model.runs, i);
      keep_of[k].resize(model.runs[k].count(), 1);
      keep_of[k][i - model.runs[k].first] = 0, lose[k] = 1;
    }
    // A door of several materials is several meshes of one name.
    const std::string& name = raw.meshes[leaf.mesh].name;
    if (names.empty() || names.back() != name || last == leaf.mesh) names.push_back(name);
    last = leaf.mesh;
  }
  // Goes in the order of storage: a run that loses triangles at its place is stored there.
  std::vector<std::uint8_t> kept;
  for (std::size_t m = 0; m < raw.meshes.size(); ++m) {
    const auto first = keep.begin() + raw.ranges[m].first_triangle;
    kept.insert(kept.end(), first, first + raw.ranges[m].triangle_count);
    for (auto [k, end] = model.runs_of(m); k < end; ++k) kept.insert(kept.end(), keep_of[k].begin(), keep_of[k].end());
  }
  const bool left = std::ranges::count(lose, 0) > 0 || std::ranges::count(kept, 1) > 0;
  if (names.empty() || !left) return {};  // a model that consists only of doors
  store_placed(raw, lose);
  keep_triangles(raw, kept);
  return names;
}

}  // namespace vantage
