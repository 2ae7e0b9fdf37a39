// SPDX-License-Identifier: Apache-2.0
// A scene along a few hundred thousand vertical lines: level surfaces, the free height above each, and walls between
// neighbouring lines. Lengths are in the file's unit, so that one pass serves every unit.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/glm.hpp"
#include "scene/raw_scene.hpp"

namespace vantage {

inline constexpr double kWalkableUp = 0.766;  // cosine of 40°, the steepest slope that people walk on

class Columns {
 public:
  // A surface no steeper than people walk on.
  struct Level {
    float z = 0;     // above the lowest point
    float free = 0;  // free height; infinite under the sky
  };
  // Part of a steep surface between two neighbouring columns.
  struct Wall {
    float low = 0, high = 0;
  };

  // `raw`: read by glTF's rule. Triangles whose `left_out` is not 0 are ignored; it may be empty. `either_way`: the
  // winding of faces tells nothing, and all count as floors. Deterministic.
  Columns(const RawScene& raw, UpAxis up, const std::vector<std::uint8_t>& left_out = {}, bool either_way = false);

  bool empty() const { return outline_ == 0; }
  double cell() const { return cell_; }
  std::uint32_t nx() const { return nx_; }
  std::uint32_t count() const { return nx_ * ny_; }
  glm::dvec3 size() const { return size_; }
  double outline() const { return static_cast<double>(outline_) * cell_ * cell_; }  // area seen from above
  // Returns the share of steep faces that are vertical but along no horizontal axis: columns, tanks, turned walls.
  double upright() const { return upright_; }
  // Returns true for a shell of sheets, such as a tunnel, that is open at its sides and shows its faces to the outside.
  // The floor of such a model faces down.
  bool inside_out() const { return inside_out_; }
  const std::vector<Level>& levels() const { return levels_; }
  std::uint32_t first(std::uint32_t column) const { return first_[column]; }  // ascending in z; up to `count()`
  // Returns true if a wall stands between a column and its neighbour along x (0) or y (1), somewhere in (low, high).
  bool wall(std::uint32_t column, int axis, float low, float high) const;

 private:
  // Finds levels with air above them. Those inside a solid are none, unless `facing` is false: then faces point
  // anywhere. `crossings`: column, height and bits of each, sorted. `tall`: height of the model.
  void find_levels(const std::vector<std::uint64_t>& crossings, double tall, bool facing);
  bool faces_outwards(const std::vector<std::uint64_t>& crossings, double tall) const;

  double cell_ = 0, upright_ = 0;
  std::uint32_t nx_ = 0, ny_ = 0;
  std::size_t outline_ = 0;
  bool inside_out_ = false;
  glm::dvec3 size_{};
  std::vector<std::uint32_t> first_, first_wall_;
  std::vector<Level> levels_;
  std::vector<Wall> walls_;
};

}  // namespace vantage
