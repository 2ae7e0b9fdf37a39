// SPDX-License-Identifier: Apache-2.0
#include "scene/room_floors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <sstream>

#include "scene/columns.hpp"
#include "scene/shared_meshes.hpp"

namespace vantage {
namespace {

constexpr double kCell_m = 0.1;
constexpr double kMostFloorCells = 4e6, kMostWork = 2e8;  // of one level; cells are coarser if needed
constexpr double kLevel_m = 0.02;                         // rooms whose bottoms differ by less share a level
constexpr double kNear_m = 0.35;                          // between a floor and the bottom of its room, for finishes
constexpr double kWall_m = 0.3;                           // thickest wall with a doorway between two rooms
constexpr double kStep_m = 0.05, kHeadroom_m = 2.2;       // over a stair
constexpr double kLeastFloor = 0.5;                       // share of a room
constexpr double kLargest_m = 1e4;                        // larger ones are no rooms

bool is_sound(const Box& box) {
  const Vec3 size = box.size();
  return size.x > 0 && size.y > 0 && size.x <= kLargest_m && size.y <= kLargest_m && size.z <= kLargest_m &&
         std::max({std::abs(box.min.x), std::abs(box.min.y), std::abs(box.min.z)}) < 1e7;
}

bool is_stair(const std::string& name) { return name.starts_with("IfcStair") || name.starts_with("IfcRamp"); }

// Rooms with the same bottom height, in cells seen from above.
class Level {
 public:
  Level(const RawScene& raw, std::vector<std::size_t> rooms) : raw_(raw), rooms_(std::move(rooms)) {
    z_ = raw.rooms[rooms_.front()].box.min.z;
    Box all;
    double work = 0;
    for (const std::size_t r : rooms_) {
      const Room& room = raw.rooms[r];
      all.extend(room.box.min), all.extend(room.box.max);
      const auto corners = std::accumulate(room.outline.begin(), room.outline.end(), std::size_t{4},
                                           [](std::size_t sum, const auto& loop) { return sum + loop.size(); });
      const Vec3 size = room.box.size();
      work += (size.x + 2 * kWall_m) * (size.y + 2 * kWall_m) * static_cast<double>(corners);
    }
    corner_ = {all.min.x - kWall_m, all.min.y - kWall_m};
    const glm::dvec2 size{all.size().x + 2 * kWall_m, all.size().y + 2 * kWall_m};
    cell_ = std::max({kCell_m, std::sqrt(size.x * size.y / kMostFloorCells), std::sqrt(work / kMostWork)});
    columns_ = static_cast<std::size_t>(std::ceil(size.x / cell_));
    rows_ = static_cast<std::size_t>(std::ceil(size.y / cell_));
  }

  // Returns the rooms without a floor.
  std::vector<std::size_t> find_floorless() const {
    const std::vector<char> surface =
        cells_with(kWalkableUp, z_ - kNear_m, z_ + kNear_m, [](const MeshInfo&) { return true; });
    std::vector<std::size_t> floorless;
    for (const std::size_t r : rooms_) {
      std::size_t inside = 0, covered = 0;
      for_cells(r, [&](std::size_t cell, double distance) {
        if (distance > 0) return;
        ++inside;
        covered += surface[cell];
      });
      if (inside > 0 && static_cast<double>(covered) < kLeastFloor * static_cast<double>(inside))
        floorless.push_back(r);
    }
    return floorless;
  }

  // Returns rectangles (x, y, x, y) that make up the floors of these rooms.
  std::vector<std::array<double, 4>> floors(const std::vector<std::size_t>& floorless) const {
    const std::vector<char> stair =
        cells_with(0, z_ - kHeadroom_m, z_ - kStep_m, [](const MeshInfo& mesh) { return is_stair(mesh.name); });
    std::vector<char> floor(columns_ * rows_, 0);
    for (const std::size_t r : floorless)
      for_cells(r, [&](std::size_t cell, double distance) {
        if (distance < kWall_m && !stair[cell]) floor[cell] = 1;
      });
    return merge(floor);
  }

  double z() const { return z_; }

 private:
  struct Run {
    std::size_t from, to, first_row;
  };

  double x_of(std::size_t column) const { return corner_.x + static_cast<double>(column) * cell_; }
  double y_of(std::size_t row) const { return corner_.y + static_cast<double>(row) * cell_; }
  glm::dvec2 middle(std::size_t column, std::size_t row) const {
    return {x_of(column) + cell_ / 2, y_of(row) + cell_ / 2};
  }

  // Returns the first cell whose middle may lie between low and high, and the end.
  std::array<std::size_t, 2> range(double low, double high, double corner, std::size_t count) const {
    const auto most = static_cast<double>(count);
    return {static_cast<std::size_t>(std::clamp(std::ceil((low - corner) / cell_ - 0.5), 0.0, most)),
            static_cast<std::size_t>(std::clamp(std::floor((high - corner) / cell_ - 0.5) + 1, 0.0, most))};
  }

  // Visits the cells around a room with their distance from it.
  template <class Visit>
  void for_cells(std::size_t r, Visit&& visit) const {
    const Room& room = raw_.rooms[r];
    const auto [left, right] = range(room.box.min.x - kWall_m, room.box.max.x + kWall_m, corner_.x, columns_);
    const auto [low, high] = range(room.box.min.y - kWall_m, room.box.max.y + kWall_m, corner_.y, rows_);
    for (std::size_t row = low; row < high; ++row)
      for (std::size_t column = left; column < right; ++column) {
        const glm::dvec2 p = middle(column, row);
        visit(row * columns_ + column, distance_to(room, {p.x, p.y, room.box.min.z}, kWall_m));
      }
  }

  // Marks cells over whose middles a triangle of these meshes, at least as level as that, lies between low and high.
  template <class Wanted>
  std::vector<char> cells_with(double least_up, double low, double high, Wanted&& wanted) const {
    std::vector<char> cells(columns_ * rows_, 0);
    for (std::size_t m = 0; m < raw_.meshes.size(); ++m) {
      if (!wanted(raw_.meshes[m])) continue;
      for_each_placed(raw_, m, [&](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
        if (!(std::max({a.z, b.z, c.z}) >= low && std::min({a.z, b.z, c.z}) <= high)) return;
        const glm::dvec3 n = cross(b - a, c - a);
        if (!(std::abs(n.z) >= least_up * length(n)) || n.z == 0) return;
        const auto [left, right] = range(std::min({a.x, b.x, c.x}), std::max({a.x, b.x, c.x}), corner_.x, columns_);
        const auto [bottom, top] = range(std::min({a.y, b.y, c.y}), std::max({a.y, b.y, c.y}), corner_.y, rows_);
        for (std::size_t row = bottom; row < top; ++row)
          for (std::size_t column = left; column < right; ++column) {
            const glm::dvec2 p = middle(column, row);
            const auto side = [&](const glm::dvec3& from, const glm::dvec3& to) {
              return ((to.x - from.x) * (p.y - from.y) - (to.y - from.y) * (p.x - from.x)) * (n.z > 0 ? 1 : -1);
            };
            if (side(a, b) < 0 || side(b, c) < 0 || side(c, a) < 0) continue;
            const double z = a.z - (n.x * (p.x - a.x) + n.y * (p.y - a.y)) / n.z;
            if (z >= low && z <= high) cells[row * columns_ + column] = 1;
          }
      });
    }
    return cells;
  }

  // Merges equal runs of cells in consecutive rows into rectangles.
  std::vector<std::array<double, 4>> merge(const std::vector<char>& floor) const {
    std::vector<std::array<double, 4>> rectangles;
    std::vector<Run> open, next;
    const auto close = [&](const Run& run, std::size_t row) {
      rectangles.push_back({x_of(run.from), y_of(run.first_row), x_of(run.to), y_of(row)});
    };
    for (std::size_t row = 0; row <= rows_; ++row) {
      next.clear();
      for (std::size_t column = 0; row < rows_ && column < columns_;) {
        if (!floor[row * columns_ + column]) {
          ++column;
          continue;
        }
        const std::size_t from = column;
        while (column < columns_ && floor[row * columns_ + column]) ++column;
        next.push_back({from, column, row});
      }
      for (const Run& run : open) {
        const auto same =
            std::ranges::find_if(next, [&](const Run& other) { return other.from == run.from && other.to == run.to; });
        if (same != next.end())
          same->first_row = run.first_row;
        else
          close(run, row);
      }
      std::swap(open, next);
    }
    return rectangles;
  }

  const RawScene& raw_;
  std::vector<std::size_t> rooms_;
  double z_ = 0, cell_ = kCell_m;
  glm::dvec2 corner_{};
  std::size_t columns_ = 0, rows_ = 0;
};

// Inserts the mesh before those of glass, which come last.
void append(RawScene& raw, const std::vector<glm::dvec3>& corners) {
  const auto first = static_cast<std::uint32_t>(raw.positions.size());
  raw.positions.insert(raw.positions.end(), corners.begin(), corners.end());
  if (!raw.normals.empty()) raw.normals.resize(raw.positions.size(), Float3{0, 0, 1});
  if (!raw.texcoords.empty()) raw.texcoords.resize(raw.positions.size());
  if (!raw.colours.empty()) raw.colours.resize(raw.positions.size(), 0xFFFFFFFF);
  std::vector<Triangle> triangles;
  for (std::uint32_t v = first; v < raw.positions.size(); v += 4)
    triangles.push_back({v, v + 1, v + 2}), triangles.push_back({v, v + 2, v + 3});
  const auto glass = std::ranges::find_if(raw.meshes, &MeshInfo::glass) - raw.meshes.begin();
  const auto at = glass < static_cast<std::ptrdiff_t>(raw.ranges.size())
                      ? raw.ranges[static_cast<std::size_t>(glass)].first_triangle
                      : static_cast<std::uint32_t>(raw.triangles.size());
  const auto count = static_cast<std::uint32_t>(triangles.size());
  for (std::size_t m = static_cast<std::size_t>(glass); m < raw.ranges.size(); ++m)
    raw.ranges[m].first_triangle += count;
  raw.triangles.insert(raw.triangles.begin() + at, triangles.begin(), triangles.end());
  const auto material = static_cast<std::uint32_t>(raw.materials.size());
  raw.materials.emplace_back();
  raw.ranges.insert(raw.ranges.begin() + glass, {.first_triangle = at, .triangle_count = count, .material = material});
  raw.meshes.insert(raw.meshes.begin() + glass, {.name = std::string(kRoomFloors),
                                                 .role = Role::blocking,
                                                 .diffuse = raw.options.default_diffuse,
                                                 .triangle_count = count});
  if (!raw.placed.empty()) raw.placed.emplace(raw.placed.begin() + glass);
}

}  // namespace

void lay_room_floors(RawScene& raw, LoadBudget& budget) {
  std::vector<std::size_t> order;
  for (std::size_t r = 0; r < raw.rooms.size(); ++r)
    if (is_sound(raw.rooms[r].box)) order.push_back(r);
  const auto bottom = [&](std::size_t r) { return raw.rooms[r].box.min.z; };
  std::ranges::stable_sort(order, {}, bottom);
  std::vector<glm::dvec3> corners;
  std::size_t rooms = 0;
  double area = 0;
  for (std::size_t i = 0; i < order.size();) {
    std::size_t end = i;
    while (end < order.size() && bottom(order[end]) <= bottom(order[i]) + kLevel_m) ++end;
    Level level(raw,
                {order.begin() + static_cast<std::ptrdiff_t>(i), order.begin() + static_cast<std::ptrdiff_t>(end)});
    i = end;
    const std::vector<std::size_t> floorless = level.find_floorless();
    if (floorless.empty()) continue;
    rooms += floorless.size();
    for (const auto& [x0, y0, x1, y1] : level.floors(floorless)) {
      area += (x1 - x0) * (y1 - y0);
      for (const auto& [x, y] : {std::array{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}})
        corners.push_back({x, y, level.z()});
    }
  }
  if (corners.empty()) return;
  constexpr std::uint64_t kCorner = 24 + 12 + 8 + 16 + 15;  // with half a triangle
  budget.keep(kCorner * corners.size(), "floors of rooms");
  append(raw, corners);
  std::ostringstream note;
  note.precision(3);
  note << rooms << " of " << raw.rooms.size() << (raw.rooms.size() == 1 ? " room has" : " rooms have")
       << " no floor in the model (their slabs may be in another file); " << area
       << " m² of floor are laid at the bottom of their spaces, which block rays and carry stations, and are not "
          "surveyed";
  raw.notes.push_back(note.str());
}

}  // namespace vantage
