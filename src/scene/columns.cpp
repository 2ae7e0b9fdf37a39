// SPDX-License-Identifier: Apache-2.0
#include "scene/columns.hpp"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>

#include "core/parallel.hpp"
#include "scene/positions.hpp"
#include "scene/sound_triangle.hpp"

namespace vantage {
namespace {

// Thousands of triangles may lie on each other; there are fewer columns then. 8 bytes each.
constexpr double kMostCrossings = 4'000'000;
constexpr double kMostColumns = 160'000, kFewestColumns = 2000, kColumnsPerTriangle = 1000;
constexpr double kBeside = 0.38196601125;  // offset of the first column: models are drawn on round lines

// Heights in 2^-29 of the whole, and three bits below them.
constexpr double kSteps = 1 << 29;
constexpr std::uint64_t kDown = 1, kGentle = 2;
constexpr std::uint32_t kSame = 1 << 13;  // 1.5e-5 of the whole: one height

using Corners = std::array<glm::dvec3, 3>;

struct WallAt {
  std::uint32_t edge;
  Columns::Wall wall;
  auto key() const { return std::tie(edge, wall.low, wall.high); }
};

// Finds the part of a triangle where axis `k` (0 or 1) equals `at`, from (along, z) a to b; false if there is none.
bool cut(const Corners& t, int k, double at, glm::dvec2& a, glm::dvec2& b) {
  int found = 0;
  for (int e = 0; e < 3; ++e) {
    glm::dvec3 p = t[static_cast<std::size_t>(e)], q = t[static_cast<std::size_t>((e + 1) % 3)];
    if ((p[k] <= at) == (q[k] <= at)) continue;
    if (std::tie(q.x, q.y, q.z) < std::tie(p.x, p.y, p.z)) std::swap(p, q);  // both triangles of an edge agree
    const double share = (at - p[k]) / (q[k] - p[k]);
    const glm::dvec2 point{p[1 - k] + (q[1 - k] - p[1 - k]) * share, p.z + (q.z - p.z) * share};
    (found++ == 0 ? a : b) = point;
  }
  return found == 2;
}

// The lines: where the model lies in them, how far apart they are, and how many there are in x and y.
struct ColumnGrid {
  double limit = 0;              // vertices with a larger coordinate are broken
  glm::dvec3 low{}, size{};      // `low`: lowest corner of the model, one column further out in x and y
  double cell = 0, tall = 1;     // `tall`: height of the model, above 0
  std::uint32_t nx = 0, ny = 0;  // 0: there is no model
};

bool is_within(const RawScene& raw, const Triangle& t, double limit) {
  return std::ranges::all_of(t, [&](std::uint32_t v) {
    const glm::dvec3& p = raw.positions[v];
    return std::abs(p.x) < limit && std::abs(p.y) < limit && std::abs(p.z) < limit;
  });
}

ColumnGrid grid_of(const RawScene& raw, UpAxis up_axis) {
  // Ignores broken vertices. In a site in millimetres, however, all vertices may lie as far out.
  constexpr double kFarthest = 1e12;
  const bool near =
      std::ranges::any_of(raw.triangles, [&](const Triangle& t) { return is_within(raw, t, kFarthest_m); });
  ColumnGrid grid{.limit = near ? kFarthest_m : kFarthest};
  const auto place = [&](std::uint32_t v) { return with_up(up_axis, raw.positions[v]); };
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high = -low;
  for (const Triangle& t : raw.triangles)
    if (is_within(raw, t, grid.limit))
      for (const std::uint32_t v : t) {
        const glm::dvec3 p = place(v);
        for (int c = 0; c < 3; ++c) low[c] = std::min(low[c], p[c]), high[c] = std::max(high[c], p[c]);
      }
  if (!(low.x <= high.x)) return grid;
  grid.size = high - low;
  const double widest = std::max({grid.size.x, grid.size.y, grid.size.z});
  const double width = std::max(grid.size.x, 1e-6 * widest), depth = std::max(grid.size.y, 1e-6 * widest);
  if (!(widest > 0)) return grid;
  const double columns =
      std::min(kMostColumns, kFewestColumns + kColumnsPerTriangle * static_cast<double>(raw.triangles.size()));
  grid.cell = std::max(std::sqrt(width * depth / columns), std::max(width, depth) / columns);
  double in_squares = 0, in_lines = 0;
  for (const Triangle& t : raw.triangles) {
    if (!is_within(raw, t, grid.limit)) continue;
    const glm::dvec3 a = place(t[0]), b = place(t[1]), c = place(t[2]);
    const glm::dvec3 extent = (glm::max(glm::max(a, b), c) - glm::min(glm::min(a, b), c)) / grid.cell;
    in_squares += extent.x * extent.y, in_lines += extent.x + extent.y;
  }
  grid.cell *= std::max({1.0, std::sqrt(in_squares / kMostCrossings), in_lines / kMostCrossings});
  // Adds one column on each side, outside the model.
  grid.nx = static_cast<std::uint32_t>(width / grid.cell) + 3,
  grid.ny = static_cast<std::uint32_t>(depth / grid.cell) + 3;
  grid.low = {low.x - grid.cell, low.y - grid.cell, low.z};
  if (grid.size.z > 0) grid.tall = grid.size.z;
  return grid;
}

// Surfaces that the lines meet, sorted: column, height and bits of each crossing, and parts of steep ones between
// columns.
struct Met {
  std::vector<std::uint64_t> crossings;
  std::vector<WallAt> walls;
  double upright = 0;  // share of steep faces that are vertical but along no horizontal axis
};

// Adds what one triangle, relative to the grid's lowest corner, has in the lines. `n`: its normal, of any length.
void add_triangle(const ColumnGrid& grid, const Corners& t, const glm::dvec3& n, bool gentle, Met& met) {
  const auto column_near = [&](double x) { return static_cast<std::int64_t>(std::floor(x / grid.cell - kBeside)); };
  const auto middle = [&](std::int64_t i) { return (static_cast<double>(i) + kBeside) * grid.cell; };
  for (int k = 0; k < (gentle ? 1 : 2); ++k) {  // lines along x, then along y
    const int across = 1 - k;                   // the axis that numbers the lines
    const double from = std::min({t[0][across], t[1][across], t[2][across]}),
                 to = std::max({t[0][across], t[1][across], t[2][across]});
    const std::int64_t lines = across == 1 ? grid.ny : grid.nx, along = across == 1 ? grid.nx : grid.ny;
    for (std::int64_t line = std::max<std::int64_t>(0, column_near(from));
         line <= std::min(lines - 1, column_near(to) + 1); ++line) {
      glm::dvec2 a{}, b{};
      if (!cut(t, across, middle(line), a, b)) continue;
      if (b.x < a.x) std::swap(a, b);
      const auto column = [&](std::int64_t i) {
        return static_cast<std::uint32_t>(across == 1 ? line * grid.nx + i : i * grid.nx + line);
      };
      const auto z_at = [&](double x) {
        return b.x > a.x ? a.y + (b.y - a.y) * std::clamp((x - a.x) / (b.x - a.x), 0.0, 1.0) : a.y;
      };
      if (k == 0 && n.z != 0)
        for (std::int64_t c = std::max<std::int64_t>(0, column_near(a.x)); c < along && middle(c) < b.x; ++c) {
          if (middle(c) < a.x) continue;
          const auto height = static_cast<std::uint64_t>(std::clamp(z_at(middle(c)) / grid.tall, 0.0, 1.0) * kSteps);
          met.crossings.push_back(std::uint64_t{column(c)} << 32 | height << 2 | (n.z < 0 ? kDown : 0) |
                                  (gentle ? kGentle : 0));
        }
      if (gentle) continue;
      for (std::int64_t c = std::max<std::int64_t>(0, column_near(a.x)); c + 1 < along && middle(c) <= b.x; ++c) {
        double z0 = z_at(middle(c)), z1 = z_at(middle(c + 1));
        if (!(b.x > a.x)) z0 = a.y, z1 = b.y;
        met.walls.push_back({2 * column(c) + static_cast<std::uint32_t>(k),
                             {static_cast<float>(std::min(z0, z1)), static_cast<float>(std::max(z0, z1))}});
      }
    }
  }
}

// Returns all that the lines meet.
Met find_met(const RawScene& raw, UpAxis up_axis, const ColumnGrid& grid, const std::vector<std::uint8_t>& left_out) {
  tbb::enumerable_thread_specific<Met> found;
  constexpr std::size_t kBlock = 256;
  std::vector<std::array<double, 2>> areas((raw.triangles.size() + kBlock - 1) / kBlock);  // in the order of blocks
  parallel::for_all(std::size_t{0}, areas.size(), [&](std::size_t block) {
    Met& own = found.local();
    for (std::size_t i = block * kBlock; i < std::min(raw.triangles.size(), (block + 1) * kBlock); ++i) {
      if (!is_within(raw, raw.triangles[i], grid.limit) || (!left_out.empty() && left_out[i])) continue;
      Corners t;
      for (std::size_t c = 0; c < 3; ++c) t[c] = with_up(up_axis, raw.positions[raw.triangles[i][c]]) - grid.low;
      const glm::dvec3 n = cross(t[1] - t[0], t[2] - t[0]);
      const double area = length(n);
      if (!(area > 0)) continue;
      const bool gentle = std::abs(n.z) >= kWalkableUp * area;
      if (!gentle) {
        constexpr double kUpright = 0.01, kTurned = 0.1;
        areas[block][1] += area;
        if (std::abs(n.z) < kUpright * area && std::min(std::abs(n.x), std::abs(n.y)) > kTurned * area)
          areas[block][0] += area;
      }
      add_triangle(grid, t, n, gentle, own);
    }
  });
  double turned = 0, steep = 0;
  for (const auto& [a, b] : areas) turned += a, steep += b;

  Met met{.crossings = {}, .walls = {}, .upright = steep > 0 ? turned / steep : 0};
  for (const Met& some : found) {
    met.crossings.insert(met.crossings.end(), some.crossings.begin(), some.crossings.end());
    met.walls.insert(met.walls.end(), some.walls.begin(), some.walls.end());
  }
  parallel::sort(met.crossings.begin(), met.crossings.end());
  parallel::sort(met.walls.begin(), met.walls.end(),
                 [](const WallAt& a, const WallAt& b) { return a.key() < b.key(); });
  return met;
}

}  // namespace

Columns::Columns(const RawScene& raw, UpAxis up_axis, const std::vector<std::uint8_t>& left_out, bool either_way) {
  const ColumnGrid grid = grid_of(raw, up_axis);
  size_ = grid.size;
  if (grid.nx == 0) return;
  cell_ = grid.cell, nx_ = grid.nx, ny_ = grid.ny;
  const Met met = find_met(raw, up_axis, grid, left_out);
  upright_ = met.upright;
  first_wall_.assign(2 * std::size_t{count()} + 1, 0);
  for (const WallAt& wall : met.walls) ++first_wall_[wall.edge + 1], walls_.push_back(wall.wall);
  for (std::size_t e = 1; e < first_wall_.size(); ++e) first_wall_[e] += first_wall_[e - 1];

  find_levels(met.crossings, grid.tall, true);
  inside_out_ = faces_outwards(met.crossings, grid.tall);
  constexpr double kFewLevels = 0.3;
  if (inside_out_ || either_way || static_cast<double>(levels_.size()) < kFewLevels * static_cast<double>(outline_))
    find_levels(met.crossings, grid.tall, false);
}

void Columns::find_levels(const std::vector<std::uint64_t>& crossings, double tall, bool facing) {
  first_.assign(std::size_t{count()} + 1, 0);
  levels_.clear();
  outline_ = 0;
  for (std::size_t i = 0; i < crossings.size();) {
    const auto column = static_cast<std::uint32_t>(crossings[i] >> 32);
    ++outline_;
    int shells = 0;
    while (i < crossings.size() && crossings[i] >> 32 == column) {
      const auto height = [&](std::size_t k) { return static_cast<std::uint32_t>(crossings[k]) >> 2; };
      std::size_t end = i;
      int up = 0, down = 0;
      bool floor = false;
      for (; end < crossings.size() && crossings[end] >> 32 == column && height(end) <= height(i) + kSame; ++end) {
        const bool downward = crossings[end] & kDown;
        (downward ? down : up) += 1;
        floor = floor || ((crossings[end] & kGentle) && (!downward || !facing));
      }
      shells = facing ? std::max(0, shells - up) + down : 0;
      const bool last = end == crossings.size() || crossings[end] >> 32 != column;
      if (floor && (shells == 0 || last)) {
        const double z = height(end - 1) / kSteps * tall;
        const double above = last ? std::numeric_limits<double>::infinity() : height(end) / kSteps * tall - z;
        levels_.push_back({static_cast<float>(z), static_cast<float>(above)});
        ++first_[column + 1];
      }
      i = end;
    }
  }
  for (std::size_t c = 1; c < first_.size(); ++c) first_[c] += first_[c - 1];
}

bool Columns::faces_outwards(const std::vector<std::uint64_t>& crossings, double tall) const {
  // In a shell seen from outside, a column has a floor that faces down and, above it, a ceiling that faces up.
  constexpr double kMostShell = 0.6, kFewCovered = 0.05;
  constexpr std::size_t kFewestOpen = 4;  // columns at an open side
  const auto covered = std::ranges::count_if(levels_, [](const Level& level) { return !std::isinf(level.free); });
  if (static_cast<double>(covered) > kFewCovered * static_cast<double>(outline_)) return false;
  enum : std::uint8_t { nothing, other, shell };
  std::vector<std::uint8_t> kind(count(), nothing);
  std::vector<Wall> hollow(count());
  std::size_t shells = 0;
  for (std::size_t i = 0; i < crossings.size();) {
    const auto column = static_cast<std::uint32_t>(crossings[i] >> 32);
    std::size_t end = i;
    while (end < crossings.size() && crossings[end] >> 32 == column) ++end;
    kind[column] = other;
    if (end == i + 2 && (crossings[i] & kDown) && (crossings[i] & kGentle) && !(crossings[i + 1] & kDown)) {
      const auto height = [&](std::size_t k) {
        return static_cast<float>((static_cast<std::uint32_t>(crossings[k]) >> 2) / kSteps * tall);
      };
      kind[column] = shell, ++shells;
      hollow[column] = {height(i), height(i + 1)};
    }
    i = end;
  }
  if (static_cast<double>(shells) < kMostShell * static_cast<double>(outline_)) return false;
  std::size_t open = 0;
  for (std::uint32_t column = 0; column < count(); ++column) {
    if (kind[column] != shell) continue;
    const float low = hollow[column].low, span = hollow[column].high - low;
    const std::uint32_t x = column % nx_;
    const auto opens = [&](bool border, std::uint32_t beside, std::uint32_t edge, int axis) {
      return !border && kind[beside] == nothing && !wall(edge, axis, low + 0.3F * span, low + 0.6F * span);
    };
    open += opens(x + 1 == nx_, column + 1, column, 0) || opens(x == 0, column - 1, column - 1, 0) ||
            opens(column + nx_ >= count(), column + nx_, column, 1) ||
            opens(column < nx_, column - nx_, column - nx_, 1);
  }
  return open >= kFewestOpen;
}

bool Columns::wall(std::uint32_t column, int axis, float low, float high) const {
  const std::size_t edge = 2 * std::size_t{column} + static_cast<std::size_t>(axis);
  for (std::uint32_t w = first_wall_[edge]; w < first_wall_[edge + 1]; ++w)
    if (walls_[w].low < high && walls_[w].high > low) return true;
  return false;
}

}  // namespace vantage
