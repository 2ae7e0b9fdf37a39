// SPDX-License-Identifier: Apache-2.0
#include "placement/ground_field.hpp"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <sstream>
#include <tuple>
#include <utility>

#include "core/parallel.hpp"
#include "scene/door_leaf.hpp"
#include "scene/positions.hpp"
#include "scene/told_by_name.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

constexpr double kColumnsPerPassage = 12;
constexpr double kMostColumns = 6e6;  // some 300 MB at three storeys
// People walk on slopes too steep for a scanner. Models often draw stairs as a slope, seldom steeper than this.
constexpr double kWalkingSlope_deg = 40;
// No wall passes between two diagonal columns' middles if both have half this distance clear.
constexpr double kHalfDiagonal = 0.7072;
constexpr int kCylinders = 3;
constexpr double kToleranceShare = 1e-3;  // of climb, height and width: rounding of the vertices

using Corners = std::array<glm::dvec3, 3>;

Box box_of(const Corners& t) {
  Box box;
  for (const glm::dvec3& p : t) box.extend(to_vec3(p));
  return box;
}
double longest_edge(const Corners& t) {
  double longest = 0;
  for (int e = 0; e < 3; ++e) longest = std::max(longest, length(glm::dvec2(t[(e + 1) % 3] - t[e])));
  return longest;
}
double squared(const glm::dvec2& v) { return v.x * v.x + v.y * v.y; }
double turn(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

// Returns the squared distance from p to a convex polygon. A polygon without area counts as its outline.
double squared_distance(const glm::dvec2& p, std::span<const glm::dvec2> polygon) {
  double nearest = std::numeric_limits<double>::infinity();
  bool left = false, right = false;
  double area = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec2 a = polygon[i], edge = polygon[(i + 1) % polygon.size()] - a, to = p - a;
    const double side = turn(edge, to), length = squared(edge);
    left = left || side > 0, right = right || side < 0;
    area += turn(a - polygon[0], a + edge - polygon[0]);
    const double s = length > 0 ? std::clamp((edge.x * to.x + edge.y * to.y) / length, 0.0, 1.0) : 0.0;
    nearest = std::min(nearest, squared(to - edge * s));
  }
  return !(left && right) && std::abs(area) > 1e-12 ? 0 : nearest;
}

// The part of a triangle from height `low` to `high`, seen from above, with at most five corners.
struct Slice {
  std::array<glm::dvec2, 8> corners;
  std::size_t count = 0;
};
Slice slice(const Corners& t, double low, double high) {
  std::array<glm::dvec3, 8> from{t[0], t[1], t[2]}, to;
  std::size_t n = 3;
  for (const auto& [side, limit] : {std::pair{1.0, low}, std::pair{-1.0, -high}}) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const glm::dvec3 a = from[i], b = from[(i + 1) % n];
      const double da = side * a.z - limit, db = side * b.z - limit;
      if (da >= 0) to[kept++] = a;
      if ((da >= 0) != (db >= 0)) to[kept++] = a + (b - a) * (da / (da - db));
    }
    n = kept;
    std::swap(from, to);
  }
  Slice result;
  for (std::size_t i = 0; i < n; ++i) result.corners[result.count++] = {from[i].x, from[i].y};
  return result;
}

// Visits (row, first column, last column) of the column middles that may lie within `reach` of a triangle seen from
// above.
struct Grid {
  glm::dvec2 corner;
  double cell;
  std::uint32_t columns, rows;

  struct Span {
    std::uint32_t first, end;
    std::uint32_t count() const { return end - first; }
  };
  // Return the columns or rows whose middles lie from `low` to `high`.
  Span columns_within(double low, double high) const { return within(low, high, corner.x, columns); }
  Span rows_within(double low, double high) const { return within(low, high, corner.y, rows); }

 private:
  Span within(double low, double high, double from, std::uint32_t n) const {
    const auto clamped = [&](double x) {
      return static_cast<std::uint32_t>(std::clamp(x, 0.0, static_cast<double>(n)));
    };
    const std::uint32_t first = clamped(std::ceil((low - from) / cell - 0.5)),
                        end = clamped(std::floor((high - from) / cell - 0.5) + 1);
    return {first, std::max(first, end)};
  }
};
template <class Visit>
void for_rows(const Grid& grid, const Corners& t, double reach, Visit&& visit) {
  const double y_min = std::min({t[0].y, t[1].y, t[2].y}), y_max = std::max({t[0].y, t[1].y, t[2].y});
  const Grid::Span rows = grid.rows_within(y_min - reach, y_max + reach);
  for (std::uint32_t row = rows.first; row < rows.end; ++row) {
    // The part of the triangle within this row, widened by `reach` on either side.
    const double y = grid.corner.y + (static_cast<double>(row) + 0.5) * grid.cell, low = y - reach, high = y + reach;
    double x_min = std::numeric_limits<double>::infinity(), x_max = -x_min;
    for (int e = 0; e < 3; ++e) {
      const glm::dvec3 &a = t[e], &b = t[(e + 1) % 3];
      if (a.y >= low && a.y <= high) x_min = std::min(x_min, a.x), x_max = std::max(x_max, a.x);
      for (const double line : {low, high})
        if ((a.y < line) != (b.y < line)) {
          const double x = a.x + (b.x - a.x) * ((line - a.y) / (b.y - a.y));
          x_min = std::min(x_min, x), x_max = std::max(x_max, x);
        }
    }
    if (x_min > x_max) continue;
    if (const Grid::Span in = grid.columns_within(x_min - reach, x_max + reach); in.count() > 0)
      visit(row, in.first, in.end - 1);
  }
}

// Maps floats to integers in the same order.
std::uint32_t ordered(float x) {
  const auto bits = std::bit_cast<std::uint32_t>(x);
  return bits & 0x80000000u ? ~bits : bits | 0x80000000u;
}
float from_ordered(std::uint32_t bits) { return std::bit_cast<float>(bits & 0x80000000u ? bits & 0x7FFFFFFFu : ~bits); }

void raise_to(float& top, float z) {
  std::atomic_ref<float> shared(top);
  float now = shared.load(std::memory_order_relaxed);
  while (now < z && !shared.compare_exchange_weak(now, z, std::memory_order_relaxed)) {
  }
}

// Returns true for a closed leaf or a pane: it stops people until opened, or while nobody finds its door.
bool is_closed_leaf(const SceneData& scene, std::size_t mesh) {
  constexpr std::uint32_t kMostTriangles = 20'000;  // of a leaf, where nodes share meshes
  const MeshRange& range = scene.ranges[mesh];
  if (scene.shares() && range.triangle_count > kMostTriangles) return false;
  const auto leaf = leaf_around(
      range.triangle_count, [&](std::uint32_t triangle) { return corners_of(scene, range.first_triangle + triangle); });
  constexpr double kPanel_m = 0.06;  // thinner than a wall
  return leaf && (scene.meshes[mesh].glass || is_plain_leaf(*leaf) || leaf->thickness <= kPanel_m ||
                  names_a_leaf(scene.meshes[mesh].name));
}

// Meshes of water, by their or their material's name; `open`: with a level surface wider than a pipe.
enum class Water : std::uint8_t { none, some, open };
std::vector<Water> waters_of(const SceneData& scene) {
  constexpr double kLevel = 0.996, kMostly = 0.9, kLeast_m2 = 10, kNarrowest_m = 1;  // within 5°
  std::vector<Water> waters(scene.meshes.size(), Water::none);
  for (std::size_t m = 0; m < waters.size(); ++m) {
    const MeshRange& range = scene.ranges[m];
    if (!names_water(scene.meshes[m].name) && !scene.materials[range.material].water) continue;
    waters[m] = Water::some;
    double all = 0, level = 0;
    Box box;
    for (std::uint32_t i = range.first_triangle; i < range.first_triangle + range.triangle_count; ++i) {
      const Corners t = corners_of(scene, i);
      const glm::dvec3 n = cross(t[1] - t[0], t[2] - t[0]);
      const double plan = std::abs(n.z) / 2;  // a sheet may show either side
      all += plan;
      if (2 * plan < kLevel * length(n)) continue;
      level += plan;
      for (const glm::dvec3& corner : t) box.extend(to_vec3(corner));
    }
    const double longest = std::max(box.size().x, box.size().y);
    if (level >= std::max(kLeast_m2, kMostly * all) && level >= kNarrowest_m * longest) waters[m] = Water::open;
  }
  return waters;
}

}  // namespace

GroundField::GroundField(const SceneData& scene, const WalkableOptions& options, std::span<const std::uint32_t> turned,
                         std::optional<Plane> plane)
    : radius_(0.5 * options.passage_width_m),
      climb_(options.climb_m * (1 + kToleranceShare)),
      height_(options.passage_height_m * (1 - kToleranceShare)),
      slope_(std::max(options.max_slope.in_radians(), Angle::degrees(kWalkingSlope_deg).in_radians())),
      opaque_(scene.opaque_count()),
      border_(plane.has_value()) {
  for (std::size_t m = 0; m < scene.meshes.size(); ++m)
    if (names_a_ceiling(scene.meshes[m].name)) ceilings_.push_back(scene.ranges[m]);
  lay_grid(scene, plane);
  find_samples(scene, turned, plane);
  find_room(scene);
  close_under_floors();
  find_parts();
}

void GroundField::lay_grid(const SceneData& scene, std::optional<Plane> plane) {
  const Box& b = scene.local_bounds;
  const double margin = plane ? plane->reach : 0;
  const double width = b.size().x + 2 * margin, depth = b.size().y + 2 * margin;
  cell_ = 2 * radius_ / kColumnsPerPassage;
  cell_ = std::max({cell_, std::sqrt(width * depth / kMostColumns), std::max(width, depth) / kMostColumns});
  corner_ = {b.min.x - margin, b.min.y - margin};
  columns_ = static_cast<std::uint32_t>(std::max(1.0, std::ceil(width / cell_)));
  rows_ = static_cast<std::uint32_t>(std::max(1.0, std::ceil(depth / cell_)));
}

void GroundField::find_samples(const SceneData& scene, std::span<const std::uint32_t> turned,
                               std::optional<Plane> plane) {
  const Grid grid{corner_, cell_, columns_, rows_};
  const std::size_t count = std::size_t{columns_} * rows_;
  top_.assign(count, -std::numeric_limits<float>::infinity());
  const double least_up = std::cos(slope_);
  // Water is no ground.
  const std::vector<Water> water = waters_of(scene);
  struct Found {
    std::vector<std::uint64_t> wide, thin, covered;  // covered: by narrow triangles at the middle
    std::vector<std::uint64_t> water;
  };
  tbb::enumerable_thread_specific<Found> collected;
  const auto look = [&](const tbb::blocked_range<std::uint32_t>& range) {
    Found& own = collected.local();
    for (std::uint32_t i = range.begin(); i != range.end(); ++i) {
      const Corners t = corners_of(scene, i);
      const glm::dvec3 n = cross(t[1] - t[0], t[2] - t[0]);
      if (n.z == 0) continue;
      const double up = n.z < 0 && std::ranges::binary_search(turned, i) ? -n.z : n.z;
      const bool walkable = !plane && up >= least_up * length(n) && water[scene.mesh_of(i)] == Water::none;
      // Bars of a grating lie between columns' middles; they carry a person at a column that they pass, at its height.
      const bool narrow = walkable && up < cell_ * longest_edge(t);
      if (narrow) {
        const std::array<glm::dvec2, 3> plan{glm::dvec2(t[0].x, t[0].y), {t[1].x, t[1].y}, {t[2].x, t[2].y}};
        const auto [lowest, highest] = std::minmax({t[0].z, t[1].z, t[2].z});
        for_rows(grid, t, cell_ / 2, [&](std::uint32_t row, std::uint32_t from, std::uint32_t to) {
          for (std::uint32_t c = from; c <= to; ++c) {
            const std::uint32_t column = row * columns_ + c;
            const glm::dvec2 p = middle(column);
            if (squared_distance(p, plan) > cell_ * cell_ / 4) continue;
            const double z = t[0].z - (n.x * (p.x - t[0].x) + n.y * (p.y - t[0].y)) / n.z;
            own.thin.push_back(std::uint64_t{column} << 32 |
                               ordered(static_cast<float>(std::clamp(z, lowest, highest))));
          }
        });
      }
      for_rows(grid, t, 0, [&](std::uint32_t row, std::uint32_t from, std::uint32_t to) {
        for (std::uint32_t c = from; c <= to; ++c) {
          const std::uint32_t column = row * columns_ + c;
          const glm::dvec2 p = middle(column);
          const auto z = static_cast<float>(t[0].z - (n.x * (p.x - t[0].x) + n.y * (p.y - t[0].y)) / n.z);
          raise_to(top_[column], z);
          const std::uint64_t key = std::uint64_t{column} << 32 | ordered(z);
          if (walkable) (narrow ? own.covered : own.wide).push_back(key);
          if (water[scene.mesh_of(i)] == Water::open) own.water.push_back(key);
        }
      });
    }
  };
  parallel::for_all(tbb::blocked_range<std::uint32_t>(0, scene.triangle_count(), 64), look);
  std::vector<std::uint64_t> all, wide, covered;
  for (const Found& some : collected) {
    all.insert(all.end(), some.thin.begin(), some.thin.end());
    wide.insert(wide.end(), some.wide.begin(), some.wide.end());
    covered.insert(covered.end(), some.covered.begin(), some.covered.end());
  }
  const bool any_thin = !all.empty();
  all.insert(all.end(), wide.begin(), wide.end());
  all.insert(all.end(), covered.begin(), covered.end());
  if (any_thin) parallel::sort(wide.begin(), wide.end()), parallel::sort(covered.begin(), covered.end());
  if (plane)
    for (std::size_t column = 0; column < count; ++column)
      all.push_back(std::uint64_t{column} << 32 | ordered(static_cast<float>(plane->z)));
  parallel::sort(all.begin(), all.end());

  // Triangles that meet over a middle, and surfaces that nearly touch, count as one sample.
  const auto apart = static_cast<float>(kToleranceShare * height_);
  first_.assign(count + 1, 0);
  const auto is_next = [&](const std::vector<std::uint64_t>& keys, std::size_t& at, std::uint64_t key) {
    while (at < keys.size() && keys[at] < key) ++at;
    return at < keys.size() && keys[at] == key;
  };
  constexpr std::size_t kTogether = 1 << 15;  // columns of one task
  struct Merged {
    std::vector<std::uint32_t> column;
    std::vector<float> z;
    std::vector<std::uint8_t> taken;
  };
  std::vector<Merged> merged((count + kTogether - 1) / kTogether);
  parallel::for_all(std::size_t{0}, merged.size(), [&](std::size_t block) {
    auto& [columns, heights, taken] = merged[block];
    const auto from = [&](const std::vector<std::uint64_t>& keys, std::size_t number) {
      const std::uint64_t key = std::uint64_t{number * kTogether} << 32;
      return static_cast<std::size_t>(std::ranges::lower_bound(keys, key) - keys.begin());
    };
    std::size_t next_wide = any_thin ? from(wide, block) : 0, next_covered = any_thin ? from(covered, block) : 0;
    for (std::size_t i = from(all, block), end = from(all, block + 1); i < end; ++i) {
      const auto column = static_cast<std::uint32_t>(all[i] >> 32);
      const float z = from_ordered(static_cast<std::uint32_t>(all[i]));
      const bool is_thin = any_thin && !is_next(wide, next_wide, all[i]);
      const bool at_middle = is_thin && is_next(covered, next_covered, all[i]);
      if (!columns.empty() && columns.back() == column && z - heights.back() < apart) {
        if (!is_thin) taken.back() = 0;
        if (at_middle && (taken.back() & kThin)) taken.back() |= kCovered;
        continue;
      }
      columns.push_back(column);
      heights.push_back(z);
      taken.push_back(static_cast<std::uint8_t>((is_thin ? kThin : 0) | (at_middle ? kCovered : 0)));
      ++first_[column + 1];
    }
  });
  for (const auto& [columns, heights, taken] : merged) {
    column_.insert(column_.end(), columns.begin(), columns.end());
    z_.insert(z_.end(), heights.begin(), heights.end());
    taken_.insert(taken_.end(), taken.begin(), taken.end());
  }
  for (std::size_t column = 0; column < count; ++column) first_[column + 1] += first_[column];
  // The bed below water is no ground either; a tunnel below lies deeper.
  wet_.assign(count, 0);
  for (const Found& some : collected)
    for (const std::uint64_t key : some.water) {
      const auto column = static_cast<std::uint32_t>(key >> 32);
      const float z = from_ordered(static_cast<std::uint32_t>(key));
      if (top_[column] > z + apart) continue;
      wet_[column] = 1;
      std::uint32_t bed = first_[column];
      while (bed < first_[column + 1] && z_[bed] <= z) ++bed;
      if (bed > first_[column] && z_[bed - 1] < z - climb_) taken_[bed - 1] |= kOverhead | kLow;
    }
}

namespace {

// Outline of a person as cylinders around one axis: wider ones reach less far up and down.
struct Outline {
  std::array<double, kCylinders> radius{};
  double shorter = 0;  // by which each cylinder ends before the next narrower one, above and below
  double widest() const { return radius[kCylinders - 1]; }
};

// Returns the squared distance of a triangle from the axis `p` within the outline of a person between `low` and `high`;
// nothing if it does not reach into it. `whole`: squared distance of all of the triangle.
std::optional<double> obstacle(const Corners& t, const Box& box, const glm::dvec2& p, double whole, double low,
                               double high, const Outline& person) {
  for (int k = kCylinders - 1; k >= 0; --k) {
    const double bottom = low + k * person.shorter, top = high - k * person.shorter;
    if (whole >= person.radius[k] * person.radius[k]) break;
    if (box.max.z <= bottom || box.min.z >= top) continue;
    double distance = whole;
    if (box.min.z < bottom || box.max.z > top) {
      const Slice part = slice(t, bottom, top);
      if (part.count == 0) continue;
      distance = squared_distance(p, std::span(part.corners).first(part.count));
    }
    if (distance < person.radius[k] * person.radius[k]) return distance;
  }
  return std::nullopt;
}

// A sample that an obstacle may still change.
struct OpenSample {
  glm::dvec2 p;
  double low, high;
  bool is_beside;  // known already: only surfaces over it still matter
};

bool may_mark(const Box& box, const OpenSample& o, const Outline& person, double rounding) {
  const double dx = std::max({0.0, box.min.x - o.p.x, o.p.x - box.max.x}),
               dy = std::max({0.0, box.min.y - o.p.y, o.p.y - box.max.y});
  if (o.is_beside) return std::max(dx, dy) <= rounding && box.max.z > o.low && box.min.z < o.high;
  for (int k = 0; k < kCylinders; ++k)
    if (dx * dx + dy * dy < (person.radius[k] + rounding) * (person.radius[k] + rounding) &&
        box.max.z > o.low + k * person.shorter && box.min.z < o.high - k * person.shorter)
      return true;
  return false;
}

}  // namespace

void GroundField::find_room(const SceneData& scene) {
  const Grid grid{corner_, cell_, columns_, rows_};
  Outline person{.shorter = radius_ / kCylinders};
  for (int i = 0; i < kCylinders; ++i)
    person.radius[i] =
        std::max((1 - kToleranceShare) * (i + 1) * radius_ / kCylinders - cell_ / 2, kHalfDiagonal * cell_);
  const double widest = person.widest();
  const auto mark = [&](std::uint32_t sample, std::uint8_t what) {
    std::atomic_ref<std::uint8_t>(taken_[sample]).fetch_or(what, std::memory_order_relaxed);
  };
  const auto known_of = [&](std::uint32_t sample) {
    return std::atomic_ref<std::uint8_t>(taken_[sample]).load(std::memory_order_relaxed);
  };
  const double rounding = 1e-6 * cell_;
  enum Blocks : std::uint8_t { everybody, nobody, until_opened };
  std::vector<Blocks> blocks(scene.meshes.size(), everybody);
  parallel::for_all(std::size_t{0}, blocks.size(), [&](std::size_t m) {
    if (scene.meshes[m].door || is_closed_leaf(scene, m)) blocks[m] = scene.meshes[m].door ? nobody : until_opened;
  });
  tbb::enumerable_thread_specific<std::vector<std::pair<std::uint32_t, std::uint32_t>>> at_leaves;
  const auto look = [&](const Corners& t, std::uint32_t mesh) {
    const bool door = blocks[mesh] != everybody;
    const Box box = box_of(t);
    const std::array<glm::dvec2, 3> plan{glm::dvec2(t[0].x, t[0].y), {t[1].x, t[1].y}, {t[2].x, t[2].y}};
    for_rows(grid, t, widest, [&](std::uint32_t row, std::uint32_t from, std::uint32_t to) {
      for (std::uint32_t c = from; c <= to; ++c) {
        const std::uint32_t column = row * columns_ + c;
        double whole = -1;  // squared distance to the whole triangle, once computed
        for (std::uint32_t s = first_[column]; s < first_[column + 1]; ++s) {
          const double low = z_[s] + climb_, high = z_[s] + height_;
          if (box.max.z <= low || box.min.z >= high) continue;
          const std::uint8_t known = known_of(s);
          if (!door && (known & (kBeside | kOverhead | kLow)) == (kBeside | kOverhead | kLow)) continue;
          const glm::dvec2 p = middle(column);
          if (whole < 0) whole = squared_distance(p, plan);
          if (whole >= widest * widest) break;
          if (door) {
            mark(s, blocks[mesh] == nobody ? kAtDoor : kLeaf);
            if (blocks[mesh] == until_opened) at_leaves.local().emplace_back(s, mesh);
            continue;
          }
          if (!(whole > 0 && (known & kBeside)))
            if (const auto distance = obstacle(t, box, p, whole, low, high, person))
              mark(s, *distance == 0 ? kOverhead : kBeside);
          const double stooped = z_[s] + kStoops * height_;
          if (!(known & kLow) && box.min.z < stooped && obstacle(t, box, p, whole, low, stooped, person)) mark(s, kLow);
        }
      }
    });
  };
  // Small triangles mark hardly anything that others have not marked. A block of them is compared with nearby samples,
  // and only triangles that can still change one are examined.
  constexpr std::uint32_t kBlock = 64;
  constexpr std::size_t kMostCompared = 64 * kBlock;  // columns, for which examining each triangle takes equally long
  const auto look_at_block = [&](std::uint32_t first, std::uint32_t end, std::vector<OpenSample>& open) {
    std::array<Corners, kBlock> corners;
    std::array<std::uint32_t, kBlock> meshes{};
    bool doors = false;
    Box all;
    std::size_t mesh = scene.mesh_of(first);
    for (std::uint32_t i = first; i < end; ++i) {
      while (i >= scene.ranges[mesh].first_triangle + scene.ranges[mesh].triangle_count) ++mesh;
      meshes[i - first] = static_cast<std::uint32_t>(mesh);
      doors = doors || blocks[mesh] != everybody;
      corners[i - first] = corners_of(scene, i);
      all = united(all, box_of(corners[i - first]));
    }
    const auto rows = grid.rows_within(all.min.y - widest - rounding, all.max.y + widest + rounding),
               columns = grid.columns_within(all.min.x - widest - rounding, all.max.x + widest + rounding);
    const bool compared = !doors && std::size_t{rows.count()} * columns.count() <= kMostCompared;
    open.clear();
    for (std::uint32_t row = rows.first; compared && row < rows.end; ++row)
      for (std::uint32_t column = row * columns_ + columns.first; column < row * columns_ + columns.end; ++column)
        for (std::uint32_t s = first_[column]; s < first_[column + 1]; ++s) {
          const std::uint8_t known = known_of(s);
          if ((known & (kBeside | kOverhead | kLow)) == (kBeside | kOverhead | kLow)) continue;
          const bool only_over = (known & (kBeside | kLow)) == (kBeside | kLow);
          const OpenSample sample{middle(column), z_[s] + climb_, z_[s] + height_, only_over};
          if (may_mark(all, sample, person, rounding)) open.push_back(sample);
        }
    for (std::uint32_t i = 0; i < end - first; ++i) {
      const Box box = box_of(corners[i]);
      if (!compared ||
          std::ranges::any_of(open, [&](const OpenSample& o) { return may_mark(box, o, person, rounding); }))
        look(corners[i], meshes[i]);
    }
  };
  parallel::for_all(tbb::blocked_range<std::uint32_t>(0, (scene.triangle_count() + kBlock - 1) / kBlock),
                    [&](const tbb::blocked_range<std::uint32_t>& range) {
                      std::vector<OpenSample> open;
                      for (std::uint32_t k = range.begin(); k != range.end(); ++k)
                        look_at_block(k * kBlock, std::min(scene.triangle_count(), (k + 1) * kBlock), open);
                    });
  for (const auto& some : at_leaves) leaves_.insert(leaves_.end(), some.begin(), some.end());
  parallel::sort(leaves_.begin(), leaves_.end(), std::less<>{});
  leaves_.erase(std::unique(leaves_.begin(), leaves_.end()), leaves_.end());
}

// Ground below a floor that lies on it offers no more headroom: nobody stands there.
void GroundField::close_under_floors() {
  const auto lies = static_cast<float>(0.3 * climb_);
  for (std::uint32_t s = static_cast<std::uint32_t>(z_.size()); s-- > 1;) {
    const std::uint32_t below = s - 1;
    const float thick = z_[s] - z_[below];
    if (column_[below] == column_[s] && thick >= lies && thick <= static_cast<float>(climb_) &&
        (taken_[s] & (kBeside | kOverhead)) && !(taken_[s] & kThin))
      taken_[below] |= kOverhead | kLow;
  }
}

// Returns true if another surface of the same part lies above within a person's height, such as a finish over a slab,
// or layers of a mattress. Seen from above both are one place.
bool GroundField::is_layer(std::uint32_t sample) const {
  const std::uint32_t above = sample + 1;
  return above < z_.size() && column_[above] == column_[sample] && part_[above] == part_[sample] &&
         z_[above] - z_[sample] < static_cast<float>(height_);
}

std::vector<std::uint32_t> GroundField::first_of_connected(std::uint8_t taken) const {
  std::vector<std::uint32_t> before(z_.size());  // a connected one, or itself
  std::iota(before.begin(), before.end(), 0U);
  const auto of = [&](std::uint32_t s) { return std::atomic_ref<std::uint32_t>(before[s]); };
  const auto first = [&](std::uint32_t s) {
    for (;;) {
      const std::uint32_t next = of(s).load(std::memory_order_relaxed);
      if (next == s) return s;
      const std::uint32_t further = of(next).load(std::memory_order_relaxed);
      if (further != next) of(s).store(further, std::memory_order_relaxed);  // a shorter way for the next one
      s = next;
    }
  };
  const auto unite = [&](std::uint32_t a, std::uint32_t b) {
    for (;;) {
      a = first(a), b = first(b);
      if (a == b) return;
      if (a < b) std::swap(a, b);
      if (std::uint32_t own = a; of(a).compare_exchange_strong(own, b, std::memory_order_relaxed)) return;
    }
  };
  parallel::for_all(std::uint32_t{0}, static_cast<std::uint32_t>(z_.size()), [&](std::uint32_t s) {
    if (taken_[s] & taken) return;
    for_neighbours(s, [&](std::uint32_t n) {
      if (n < s && !(taken_[n] & taken)) unite(s, n);
    });
  });
  parallel::for_all(std::uint32_t{0}, static_cast<std::uint32_t>(z_.size()),
                    [&](std::uint32_t s) { of(s).store(first(s), std::memory_order_relaxed); });
  return before;
}

void GroundField::find_parts() {
  const std::vector<std::uint32_t> first = first_of_connected(kObstacles);
  part_.assign(z_.size(), kNowhere);
  for (std::uint32_t s = 0; s < z_.size(); ++s) {
    if (taken_[s] & kObstacles) continue;
    if (first[s] == s) {
      part_[s] = static_cast<std::uint32_t>(parts_.size());
      parts_.emplace_back().first = s;
    }
    part_[s] = part_[first[s]];
    Part& part = parts_[part_[s]];
    part.at_door = part.at_door || (taken_[s] & kAtDoor);
  }
  begin_.assign(parts_.size() + 1, 0);
  for (const std::uint32_t part : part_)
    if (part != kNowhere) ++begin_[part + 1];
  for (std::size_t i = 0; i < parts_.size(); ++i) begin_[i + 1] += begin_[i];
  members_.resize(begin_.back());
  std::vector<std::uint32_t> at(begin_.begin(), begin_.end() - 1);
  for (std::uint32_t s = 0; s < z_.size(); ++s)
    if (part_[s] != kNowhere) members_[at[part_[s]]++] = s;
  for (std::uint32_t s = 0; s < z_.size(); ++s) {
    if (part_[s] == kNowhere || is_layer(s)) continue;
    Part& part = parts_[part_[s]];
    ++part.samples;
    part.mean_z += z_[s];
    part.in_the_sky += z_[s] + climb_ >= top_[column_[s]];
  }
  for (Part& part : parts_) part.mean_z /= static_cast<double>(part.samples);  // the topmost of a column counts
  // Counts samples above a room of another part, such as a roof above its house.
  for (std::uint32_t s = 0; s < z_.size(); ++s) {
    if (part_[s] == kNowhere || is_layer(s)) continue;
    const std::uint32_t lowest = first_[column_[s]];
    parts_[part_[s]].above_surfaces += lowest < s && z_[lowest] <= z_[s] - height_ * 0.8;
    for (std::uint32_t below = lowest; below < s; ++below)
      if (part_[below] != kNowhere && part_[below] != part_[s] && z_[below] <= z_[s] - height_ * 0.8 &&
          parts_[part_[below]].area(cell_) >= room()) {
        ++parts_[part_[s]].above_others;
        break;
      }
  }
}

GroundField::WaysOut GroundField::ways_out(const MeshTree& tree, std::uint32_t number) const {
  constexpr std::size_t kMostTried = 2000;
  constexpr int kWays = 16;
  std::vector<std::uint32_t> edge;
  for (const std::uint32_t s : members(number)) {
    int neighbours = 0;
    for_neighbours(s, [&](std::uint32_t n) { neighbours += part_[n] == number; });
    if (neighbours < 8) edge.push_back(s);
  }
  const double far = cell_ * (columns_ + rows_);
  const std::size_t stride = std::max<std::size_t>(1, edge.size() / kMostTried);
  std::size_t looked = 0, out = 0;
  for (std::size_t i = 0; i < edge.size(); i += stride) {
    const glm::dvec2 p = middle(column_[edge[i]]);
    for (int k = 0; k < kWays; ++k) {
      const double angle = 2 * 3.14159265358979323846 * k / kWays;
      const glm::dvec3 way{far * std::cos(angle), far * std::sin(angle), 0};
      const auto free = [&](double share) {
        const glm::dvec3 from{p.x, p.y, z_[edge[i]] + share * height_};
        return !tree.between(from, from + way);
      };
      ++looked, out += free(0.27) && free(0.8);
    }
  }
  return {out > 0, looked > 0 ? static_cast<double>(out) / static_cast<double>(looked) : 0};
}

std::vector<std::uint32_t> GroundField::choose_parts(const MeshTree& tree) const {
  // Least shares of the largest part. An entrance may be small compared to its hall; closed parts must be of similar
  // size.
  constexpr double kLargeOpen = 0.2, kLargeClosed = 0.5;
  // A room with walls and a door sees less of the outside; a porch or a niche sees more.
  constexpr double kMostOpen = 0.15;
  const double storey = 0.8 * height_;  // parts nearer in height than this are on one level
  struct Candidate {
    std::uint32_t part;
    double area, z;
    bool sky;
  };
  std::vector<Candidate> open, closed, roofs;
  for (std::uint32_t i = 0; i < parts_.size(); ++i) {
    const Part& part = parts_[i];
    if (part.area(cell_) < room()) continue;
    const bool sky = part.under_the_sky();
    const Candidate candidate{i, part.area(cell_), part.mean_z, sky};
    if (is_roof(part))
      roofs.push_back(candidate);
    else if (sky || part.at_door)
      open.push_back(candidate);
    else
      closed.push_back(candidate);
  }
  const auto only_above = [](std::vector<Candidate>& some, double area) {
    std::erase_if(some, [&](const Candidate& c) { return c.area < area; });
  };
  const auto largest_of = [](const std::vector<Candidate>& some) {
    double largest = 0;
    for (const Candidate& c : some) largest = std::max(largest, c.area);
    return largest;
  };
  const auto only_lowest = [&](std::vector<Candidate>& some) {
    double lowest = std::numeric_limits<double>::infinity();
    for (const Candidate& c : some) lowest = std::min(lowest, c.z);
    std::erase_if(some, [&](const Candidate& c) { return c.z > lowest + storey; });
  };
  const double largest = std::max(largest_of(open), largest_of(closed));
  only_above(open, kLargeOpen * largest);
  // A block of terrain ends like the top of an object, so tops are dropped only if other ground lies under the sky.
  std::vector<Candidate> ground;
  for (const Candidate& c : open)
    if (c.sky && !is_top(tree, c.part)) ground.push_back(c);
  std::vector<Candidate> small = closed;
  std::erase_if(small, [&](const Candidate& c) { return c.area >= kLargeOpen * largest || c.area < 10 * room(); });
  only_above(closed, kLargeOpen * largest);
  const auto move_to_open = [&](std::vector<Candidate>& some, double most) {
    std::erase_if(some, [&](const Candidate& c) {
      const WaysOut ways = ways_out(tree, c.part);
      if (!ways.any || ways.share > most) return false;
      open.push_back(c);
      return true;
    });
  };
  move_to_open(closed, 1);
  if (open.empty()) {
    move_to_open(small, kMostOpen);
    only_lowest(open);
    // A closet of a closed level is no entrance: the parts left closed must not dwarf those that are entered.
    constexpr double kLeastEntered = 0.1;
    double entered = 0;
    for (const Candidate& c : open) entered += c.area;
    if (entered < kLeastEntered * largest) open.clear();
  }
  if (open.empty() && closed.empty()) closed = roofs;
  only_above(closed, kLargeClosed * largest_of(closed));
  auto& choice = open.empty() ? closed : open;
  // People enter from the largest ground under the sky at any height, but a building from its lowest storey.
  if (!ground.empty() && largest_of(ground) >= largest_of(open))
    choice = ground;
  else
    only_lowest(choice);
  std::ranges::sort(choice, [](const Candidate& a, const Candidate& b) {
    return a.area != b.area ? a.area > b.area : a.part < b.part;
  });
  std::vector<std::uint32_t> parts;
  for (const Candidate& c : choice) {
    // Adds parts entered from outside to the largest one: dwellings of a house without the ground around it.
    const bool dwelling = !c.sky && !choice.front().sky && !open.empty();
    if (parts.empty() || dwelling) parts.push_back(c.part);
  }
  return parts;
}

glm::dvec3 GroundField::middle_of(std::uint32_t part) const {
  glm::dvec2 mean(0);
  for (const std::uint32_t s : members(part))
    if (!is_layer(s)) mean += middle(column_[s]);
  mean /= static_cast<double>(parts_[part].samples);
  std::uint32_t best = parts_[part].first;
  for (const std::uint32_t s : members(part))
    if (!is_layer(s) && (is_layer(best) || squared(middle(column_[s]) - mean) < squared(middle(column_[best]) - mean)))
      best = s;
  const glm::dvec2 p = middle(column_[best]);
  return {p.x, p.y, z_[best]};
}

void GroundField::reach(const MeshTree& tree, std::span<const glm::dvec3> enter) {
  access_.assign(parts_.size(), Access::unreachable);
  const auto place = [&](std::uint32_t s) {
    const glm::dvec2 p = middle(column_[s]);
    return glm::dvec3{p.x, p.y, z_[s]};
  };
  for (const glm::dvec3& wanted : enter) {
    const double within = 2 * radius_ / 0.3;  // 2 m for a passage of 0.6 m
    double best = within * within;
    std::optional<std::uint32_t> start;
    for (std::uint32_t s = 0; s < z_.size(); ++s) {
      if (part_[s] == kNowhere) continue;
      const glm::dvec3 d = place(s) - wanted;
      if (dot(d, d) < best) best = dot(d, d), start = s;
    }
    if (!start) {
      std::ostringstream text;
      text << "no place with room for a person lies within " << within << " m of the entrance (setting enter); move it";
      throw Error(Errc::invalid_argument, text.str());
    }
    access_[part_[*start]] = Access::reached;
    entries_.push_back(place(*start));
  }
  if (enter.empty() && border_) {
    const auto at_border = [&](std::uint32_t column) {
      const std::uint32_t x = column % columns_, y = column / columns_;
      return x == 0 || y == 0 || x + 1 == columns_ || y + 1 == rows_;
    };
    for (std::uint32_t s = 0; s < z_.size(); ++s)
      if (part_[s] != kNowhere && at_border(column_[s])) {
        if (entries_.empty()) entries_.push_back(place(s));
        access_[part_[s]] = Access::reached;
      }
  } else if (enter.empty()) {
    for (const std::uint32_t part : choose_parts(tree)) {
      access_[part] = Access::reached;
      entries_.push_back(place(parts_[part].first));
    }
  }
  const std::vector<Step> steps = steps_between_parts();
  // People step over a gap between a slab and the ground before it, as at a threshold that is not drawn.
  for_parts_by_steps(steps, climb_, [&](const Step& step) { access_[step.to] = Access::reached; });
  tell_apart();
  look_beyond_high_steps(steps);
  for (std::uint32_t i = 0; i < parts_.size(); ++i)
    if (may_be_told(i)) {
      climbs_ = climbs(tree);
      break;
    }
}

double GroundField::outline() const {
  const auto held = std::ranges::count_if(top_, [](float z) { return std::isfinite(z); });
  return static_cast<double>(held - std::ranges::count(wet_, 1)) * cell_ * cell_;
}

// Marks unreached parts as sealed if they are behind walls: under a cover, and not one step above or below a reached
// part next to them.
void GroundField::tell_apart() {
  // across a wall and the margins on both sides
  const auto far = static_cast<std::int64_t>(std::ceil(4 * radius_ / cell_));
  std::vector<std::int64_t> level(parts_.size(), 0);  // votes for minus votes against
  parallel::for_all(std::uint32_t{0}, static_cast<std::uint32_t>(z_.size()), [&](std::uint32_t s) {
    if (part_[s] == kNowhere || access_[part_[s]] == Access::reached) return;
    std::int64_t votes = 0;
    for_columns_beside(column_[s], far, [&](std::uint32_t other) {
      for (std::uint32_t n = first_[other]; n < first_[other + 1]; ++n) {
        if (part_[n] == kNowhere || access_[part_[n]] != Access::reached) continue;
        const double step = std::abs(double{z_[n]} - z_[s]);
        votes += step <= climb_ ? 1 : step <= height_ ? -1 : 0;
      }
    });
    if (votes != 0) std::atomic_ref<std::int64_t>(level[part_[s]]).fetch_add(votes, std::memory_order_relaxed);
  });
  for (std::size_t i = 0; i < parts_.size(); ++i)
    if (access_[i] != Access::reached && parts_[i].area(cell_) >= room() && level[i] >= 0 &&
        2 * parts_[i].in_the_sky <= parts_[i].samples)
      access_[i] = Access::sealed;
}

// Returns true if no sample without room lies between a sample and a column `columns` away: a gap has none.
bool GroundField::is_gap(std::uint32_t sample, std::uint32_t to, std::int64_t columns) const {
  const std::int64_t from = column_[sample], one = (std::int64_t{to} - from) / columns;
  for (std::int64_t k = 1; k < columns; ++k) {
    const auto column = static_cast<std::size_t>(from + k * one);
    for (std::uint32_t m = first_[column]; m < first_[column + 1]; ++m)
      if (!has_room(m) && std::abs(double{z_[m]} - z_[sample]) <= 2 * climb_) return false;
  }
  return true;
}

std::vector<GroundField::Step> GroundField::steps_between_parts() const {
  const auto across = static_cast<std::int64_t>(std::ceil(radius_ / cell_)) + 1;
  tbb::enumerable_thread_specific<std::vector<Step>> found;
  parallel::for_all(std::uint32_t{0}, static_cast<std::uint32_t>(z_.size()), [&](std::uint32_t s) {
    if (part_[s] == kNowhere) return;
    for_columns_beside(column_[s], across, [&](std::uint32_t other) {
      for (std::uint32_t n = first_[other]; n < first_[other + 1]; ++n) {
        if (part_[n] == kNowhere || part_[n] == part_[s]) continue;
        const double rise = std::abs(double{z_[n]} - z_[s]);
        if (rise > 2 * climb_ || (rise <= climb_ && !is_gap(s, other, across))) continue;
        found.local().push_back({part_[s], part_[n], rise});
      }
    });
  });
  std::vector<Step> steps;
  for (const std::vector<Step>& some : found) steps.insert(steps.end(), some.begin(), some.end());
  parallel::sort(steps.begin(), steps.end(), [](const Step& a, const Step& b) {
    return std::tie(a.from, a.to, a.rise) < std::tie(b.from, b.to, b.rise);
  });
  steps.erase(std::unique(steps.begin(), steps.end(),
                          [](const Step& a, const Step& b) { return a.from == b.from && a.to == b.to; }),
              steps.end());
  return steps;
}

template <class Visit>
void GroundField::for_parts_by_steps(std::span<const Step> steps, double highest, Visit&& visit) const {
  std::vector<char> seen(parts_.size(), 0);
  std::vector<std::uint32_t> open;
  for (std::uint32_t i = 0; i < parts_.size(); ++i)
    if (access_[i] == Access::reached) seen[i] = 1, open.push_back(i);
  while (!open.empty()) {
    const std::uint32_t from = open.back();
    open.pop_back();
    for (auto step = std::ranges::lower_bound(steps, from, {}, &Step::from); step != steps.end() && step->from == from;
         ++step) {
      if (seen[step->to] || step->rise > highest) continue;
      seen[step->to] = 1;
      open.push_back(step->to);
      visit(*step);
    }
  }
}

// Reports steps that bar a hall, but not steps onto a bed. Each tread of a stair that is too steep is a separate part,
// so the search goes from part to part.
void GroundField::look_beyond_high_steps(std::span<const Step> steps) {
  HighSteps beyond;
  for_parts_by_steps(steps, 2 * climb_, [&](const Step& step) {
    beyond.highest_m = std::max(beyond.highest_m, step.rise);
    if (const double area = parts_[step.to].area(cell_); area >= 10 * room()) beyond.area_m2 += area;
  });
  if (beyond.area_m2 > 0) high_steps_ = beyond;
}

double GroundField::covered_area() const {
  double area = 0;
  for (const Part& part : parts_)
    if (2 * part.in_the_sky <= part.samples && part.area(cell_) >= room()) area += part.area(cell_);
  return area;
}

double GroundField::walled_area(const MeshTree& tree, double highest_z) const {
  constexpr double kMostOpen = 0.85;  // of a roof's edge hardly anything is seen to rise
  double area = 0;
  for (std::uint32_t i = 0; i < parts_.size(); ++i) {
    const Part& part = parts_[i];
    if (is_roof(part) || part.mean_z > highest_z || part.area(cell_) < 10 * room()) continue;
    if (ways_out(tree, i).share <= kMostOpen) area += part.area(cell_);
  }
  return area;
}

std::optional<std::uint32_t> GroundField::column_at(double x, double y) const {
  const double c = std::floor((x - corner_.x) / cell_), r = std::floor((y - corner_.y) / cell_);
  if (!(c >= -1 && r >= -1 && c <= columns_ && r <= rows_)) return std::nullopt;
  const auto inside = [](double i, std::uint32_t n) {
    return static_cast<std::uint32_t>(std::clamp(i, 0.0, static_cast<double>(n - 1)));
  };
  return inside(r, rows_) * columns_ + inside(c, columns_);
}

std::optional<std::uint32_t> GroundField::nearest(std::uint32_t column, double z, double tolerance) const {
  std::optional<std::uint32_t> best;
  for (std::uint32_t s = first_[column]; s < first_[column + 1]; ++s) {
    const double distance = std::abs(z_[s] - z);
    if (distance <= tolerance) tolerance = distance, best = s;
  }
  return best;
}

bool GroundField::is_ridge(const MeshTree& tree, const glm::dvec3& place) const {
  const double least = 0.5 / 0.3 * radius_, beyond = std::max(cell_, 0.15 * least);
  // Width of the ground on a side, and whether it then ends in the air.
  struct Side {
    double width;
    bool in_the_air;
  };
  const auto side = [&](const glm::dvec3& from, const glm::dvec2& way) -> Side {
    double z = from.z;
    for (double width = 0;; width += cell_) {
      const glm::dvec2 q = glm::dvec2(from.x, from.y) + way * (width + cell_);
      const auto column = column_at(q.x, q.y);
      const auto sample = column ? nearest(*column, z, climb_) : std::nullopt;
      if (!sample) {
        const glm::dvec2 end = glm::dvec2(from.x, from.y) + way * (width + beyond);
        return {width, !tree.between({end.x, end.y, z + climb_}, {end.x, end.y, z - climb_})};
      }
      if (width >= least) return {width, false};
      z = z_[*sample];
    }
  };
  constexpr double kHalf = 0.70710678118654752;
  constexpr std::array<glm::dvec2, 4> kWays{glm::dvec2(1, 0), glm::dvec2(0, 1), glm::dvec2(kHalf, kHalf),
                                            glm::dvec2(kHalf, -kHalf)};
  const auto is_narrow = [&](const glm::dvec3& from) {
    return std::ranges::any_of(kWays, [&](const glm::dvec2& way) {
      const Side one = side(from, way);
      if (!one.in_the_air) return false;
      const Side other = side(from, -way);
      return other.in_the_air && one.width + cell_ + other.width < least;
    });
  };
  if (!is_narrow(place)) return false;
  // A corner of wide ground is narrow as well, and so are places next to it.
  return std::ranges::none_of(kWays, [&](const glm::dvec2& way) {
    return std::ranges::any_of(std::array{1.0, -1.0}, [&](double sign) {
      const glm::dvec2 q = glm::dvec2(place.x, place.y) + way * (sign * 0.7 * least);
      const auto column = column_at(q.x, q.y);
      const auto sample = column ? nearest(*column, place.z, climb_) : std::nullopt;
      return sample && !is_narrow({q.x, q.y, z_[*sample]});
    });
  });
}

Access GroundField::at(const glm::dvec3& place) const {
  const auto column = column_at(place.x, place.y);
  if (!column) return Access::narrow;
  const double tolerance = std::max(0.5 * climb_, std::tan(slope_) * cell_);
  std::optional<std::uint32_t> sample = nearest(*column, place.z, tolerance);
  if (!sample) {  // a strip too thin to cover the column's middle
    const std::int64_t x = *column % columns_, y = *column / columns_;
    double best = std::numeric_limits<double>::infinity();
    for (std::int64_t ny = std::max<std::int64_t>(0, y - 1); ny <= std::min<std::int64_t>(y + 1, rows_ - 1); ++ny)
      for (std::int64_t nx = std::max<std::int64_t>(0, x - 1); nx <= std::min<std::int64_t>(x + 1, columns_ - 1);
           ++nx) {
        const auto other = static_cast<std::uint32_t>(ny * columns_ + nx);
        const auto candidate = nearest(other, place.z, tolerance);
        const double distance = squared(middle(other) - glm::dvec2(place.x, place.y));
        if (candidate && distance < best) best = distance, sample = candidate;
      }
  }
  if (!sample) return Access::narrow;
  if (part_[*sample] != kNowhere) return access_[part_[*sample]];
  return taken_[*sample] & kOverhead ? Access::headroom : Access::narrow;
}

double GroundField::ground_area(double highest_z) const {
  const std::vector<std::uint32_t> first = first_of_connected(0);
  std::vector<char> reached(z_.size(), 0);  // by the first of those connected
  for (std::uint32_t s = 0; s < z_.size(); ++s)
    if (part_[s] != kNowhere && access_[part_[s]] == Access::reached) reached[first[s]] = 1;
  std::uint64_t columns = 0;
  std::uint32_t last = kNowhere;
  for (std::uint32_t s = 0; s < z_.size(); ++s)
    if (reached[first[s]] && z_[s] <= highest_z && column_[s] != last) ++columns, last = column_[s];
  return static_cast<double>(columns) * cell_ * cell_;
}

}  // namespace vantage
