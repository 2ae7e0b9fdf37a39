// SPDX-License-Identifier: Apache-2.0
// Finds where a person can walk: samples of the scene's surfaces on a grid seen from above that have room for a person,
// and their connected components.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/glm.hpp"
#include "placement/mesh_tree.hpp"
#include "scene/scene_data.hpp"
#include "vantage/placement.hpp"

namespace vantage {

// Obstacle between a person and a place.
enum class Access : std::uint8_t {
  reached,      // nothing
  narrow,       // something stands beside it
  headroom,     // something hangs above it
  unreachable,  // there is room but no way to it: a roof, a table, the top of a wall
  sealed,       // there is room behind walls without an opening
};

// A walkability field as used for robots and games (Mononen, Recast Navigation, 2009), but with heights and clearances
// from the triangles themselves instead of boxes. Only a sample's place is rounded to the grid.
//
// Samples lie at the middles of square columns, on every upward triangle there that is no steeper than a person walks.
// A sample has room if a person's outline is free of triangles. The outline is three upright cylinders, narrower the
// taller they are, so that stairs and the edge of a ceiling above them leave room while a wall of the same height does
// not. Samples of neighbouring columns are connected if both have room and a person can take the step between them.
//
// Radii are smaller than half the passage by half a column, so that every passage of that width has a row of samples
// with room, whatever its direction. They are large enough that no wall, however thin, passes between two neighbours.
//
// Local frame; z up. Immutable except for reach(). Deterministic.
class GroundField {
 public:
  // A plane laid under the model: its extent beyond the bounds, and its height.
  struct Plane {
    double reach = 0, z = 0;
  };

  // `turned`: triangles that face down and carry a person nevertheless, rising (drawn_face_down()).
  // REQUIRES: the scene has triangles. Doors do not block.
  GroundField(const SceneData& scene, const WalkableOptions& options, std::span<const std::uint32_t> turned,
              std::optional<Plane> plane = {});

  // Determines the reached parts: from `enter` if given; from the border if a plane is laid; otherwise from the parts
  // where people enter. That is the largest ground under the sky, at any height. Without such ground, it is the lowest
  // large parts that lead into the open by a door or an opening, as several dwellings do; else all rooms that have a
  // way out; else the largest of the lowest parts.
  // Throws Error invalid_argument if there is no room for a person near one of `enter`.
  void reach(const MeshTree& tree, std::span<const glm::dvec3> enter);
  // Also reaches parts behind obstacles, as if one had entered them: ground under the sky, and rooms, from a tenth of
  // the reached floor or 20 m² on. REQUIRES: reach() was called.
  void enter_closed(const MeshTree& tree);

  // Returns the access of the sample at this place, or of its nearest neighbour; narrow if there is none. REQUIRES:
  // reach() was called.
  Access at(const glm::dvec3& place) const;
  // Returns true if the ground at this place ends in the air on both sides within half a metre (for a passage of 0.6
  // m), like the top of a wall or a beam: a person may cross it, and no tripod stands there.
  bool is_ridge(const MeshTree& tree, const glm::dvec3& place) const;
  // Returns the entrances of the reached parts, largest first; empty if nothing is reached.
  const std::vector<glm::dvec3>& entries() const { return entries_; }
  // A part behind an obstacle.
  struct ClosedPart {
    double area_m2 = 0;
    glm::dvec3 middle{};
    ClosedKind kind = ClosedKind::room;
    Bar bar = Bar::no_way;
    double height_m = 0;                    // least headroom, or highest step, on the way there
    std::vector<std::uint32_t> doors = {};  // meshes of closed leaves and panes on the way from what is reached
  };
  // Returns the parts that enter_closed() reached, largest first.
  const std::vector<ClosedPart>& entered() const { return entered_; }
  // Returns other sealed parts as large as a room, and covered ones as large as a hall beyond a step. Largest first.
  // REQUIRES: reach() was called.
  std::vector<ClosedPart> not_entered(const MeshTree& tree);
  // Returns the area of the reached parts.
  double reached_area() const;
  // Returns the area of ground under the sky, reached or not, at any height: no roof, and no top of an object.
  double open_ground_area(const MeshTree& tree) const;
  // Floors of gratings and boards without a triangle of some width: rectangles at the reached samples.
  struct Patch {
    glm::dvec3 low;
    glm::dvec2 high;
  };
  std::vector<Patch> thin_floors() const;
  // Returns the area of the columns whose top is not water.
  double outline() const;
  // Returns the area, seen from above, up to this height, of surfaces that continue reached ones, with room or not.
  double ground_area(double highest_z) const;
  // Returns the area of parts with room under a cover, reached or not: large in a building, small in a machine.
  double covered_area() const;
  // Returns the area of parts as large as a hall, reached or not, no higher on average, from which walls are in view: a
  // site's floors, whatever steps lie between them, but not the tops of a machine.
  double walled_area(const MeshTree& tree, double highest_z) const;
  // Large parts beyond steps higher than a person takes but less than twice as high, and the highest of those steps.
  struct HighSteps {
    double highest_m = 0, area_m2 = 0;
  };
  std::optional<HighSteps> high_steps() const { return high_steps_; }

 private:
  struct Part {
    std::uint64_t samples = 0, in_the_sky = 0;
    std::uint64_t above_others = 0, above_surfaces = 0;  // above a room; above anything level, a person's height below
    std::uint32_t first = 0;
    double mean_z = 0;
    bool at_door = false;
    double area(double cell) const { return static_cast<double>(samples) * cell * cell; }
    bool under_the_sky() const { return 2 * in_the_sky > samples; }
  };
  static constexpr std::uint32_t kNowhere = 0xFFFFFFFFu;
  // Facts about a sample, as bits.
  static constexpr std::uint8_t kBeside = 1;    // something stands beside a person there
  static constexpr std::uint8_t kOverhead = 2;  // something hangs above
  static constexpr std::uint8_t kAtDoor = 4;    // a door that counts as open stands there
  static constexpr std::uint8_t kLeaf = 8;      // a closed leaf or a pane stands there
  static constexpr std::uint8_t kLow = 16;      // something is beside or above a person who stoops
  static constexpr std::uint8_t kThin = 32;     // all surfaces there are narrower than a column
  static constexpr std::uint8_t kCovered = 64;  // one of these lies at the middle of the column
  static constexpr std::uint8_t kObstacles = kBeside | kOverhead | kLeaf;  // to a person who walks upright
  static constexpr double kStoops = 0.8;                                   // of the height of a passage: 1.5 m

  void lay_grid(const SceneData& scene, std::optional<Plane> plane);
  void find_samples(const SceneData& scene, std::span<const std::uint32_t> turned, std::optional<Plane> plane);
  void find_room(const SceneData& scene);
  void close_under_floors();
  // Returns for each sample the first of those connected with it by neighbours with the bits of `taken` clear; the
  // sample itself if its own are not clear.
  std::vector<std::uint32_t> first_of_connected(std::uint8_t taken) const;
  void find_parts();
  bool is_layer(std::uint32_t sample) const;
  // Level lines of sight, at knee and head height, that lead out of the model from the edge of the part.
  struct WaysOut {
    bool any = false;
    double share = 0;  // of all directions at the edge
  };
  WaysOut ways_out(const MeshTree& tree, std::uint32_t part) const;
  std::vector<std::uint32_t> choose_parts(const MeshTree& tree) const;
  // Returns the sample of a part nearest to its middle.
  glm::dvec3 middle_of(std::uint32_t part) const;
  // Effort to reach a sample from the reached parts: the hardest obstacle on the easiest way.
  // Steps have a class for each tenth of a metre or so, so that the lowest is found.
  enum Effort : std::uint8_t { walk, through_door, step_over, stoop, climb, high_step, kEfforts = high_step + 8 };
  struct Ways {
    std::vector<std::uint8_t> effort;  // per sample; kEfforts: none
    std::vector<std::uint32_t> from;   // per sample: the one before it
  };
  const Ways& ways_from_reached();
  Ways find_ways() const;
  // Returns pairs of samples linked by rungs or steep steps, in both directions, sorted.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> climbs(const MeshTree& tree) const;
  std::vector<std::uint32_t> narrow_ones(std::vector<std::uint8_t>& marked) const;
  ClosedPart closed_part(const MeshTree& tree, const Ways& ways, std::uint32_t part) const;
  // Enters parts as enter_closed() does, as seen from those reached now; returns false if none is left. Parts beyond an
  // entered one may be easier to reach from there.
  bool enter_next_closed(const MeshTree& tree, double enough);
  // Returns for each closed part the first closed part on the way to it.
  std::vector<std::uint32_t> first_closed(const Ways& ways) const;
  std::vector<std::uint32_t> easiest_samples(const Ways& ways) const;
  bool is_roof(const Part& part) const { return part.under_the_sky() && 2 * part.above_others > part.samples; }
  bool is_attic(std::uint32_t part) const;
  // Returns true if most of it is the back of ceilings, by their names.
  bool is_above_ceiling(const MeshTree& tree, std::uint32_t part) const;
  bool is_wide(std::uint32_t part) const;
  struct Rim {
    std::uint32_t sample;
    glm::dvec3 out;
    bool bare;  // no surface goes on
  };
  // Returns some samples at the ends of a part, on all its sides.
  std::vector<Rim> rims_of(std::uint32_t part) const;
  // Returns true for the top of an object: steep faces lead down below most of its edge.
  bool is_top(const MeshTree& tree, std::uint32_t part) const;
  // Returns true for a large part under the sky that is no top.
  bool is_open_ground(const MeshTree& tree, std::uint32_t part) const;
  // Returns how far beyond a rim a rail or a wall is searched: a metre.
  double beyond_rim() const { return 3.3 * radius_; }
  // Returns true if something stands beyond a rim at these shares of a person's height.
  bool stands_beyond(const MeshTree& tree, const Rim& rim, std::span<const double> heights) const;
  std::optional<std::uint32_t> column_beyond(const Rim& rim) const;
  // Returns true if a person looks down on reached floor over a rail, so that nobody falls off.
  bool is_gallery(const MeshTree& tree, std::uint32_t part) const;
  // Returns true for a floor that ends in the air high above another, like a wing: nobody walks on it.
  bool is_open_deck(const MeshTree& tree, std::uint32_t part) const;
  // Returns true if reached floor, or the outside of the model, is in view from it.
  bool has_openings(const MeshTree& tree, std::uint32_t part) const;
  bool may_be_told(std::uint32_t part) const;
  // Returns large floors that people reach, and cross, only by stooping.
  std::vector<ClosedPart> low_floors(const MeshTree& tree);
  bool has_room(std::uint32_t sample) const;
  void tell_apart();
  // The lowest step between samples of two parts, across a gap in the floor that a person steps over: half a passage.
  // In both directions, sorted by parts.
  struct Step {
    std::uint32_t from, to;
    double rise;  // up or down
  };
  std::vector<Step> steps_between_parts() const;
  bool is_gap(std::uint32_t sample, std::uint32_t to, std::int64_t columns) const;
  // Visits a step to each part that steps up to `highest` lead to from the reached parts, perhaps by other parts.
  template <class Visit>
  void for_parts_by_steps(std::span<const Step> steps, double highest, Visit&& visit) const;
  void look_beyond_high_steps(std::span<const Step> steps);

  glm::dvec2 middle(std::uint32_t column) const {
    return {corner_.x + (column % columns_ + 0.5) * cell_, corner_.y + (column / columns_ + 0.5) * cell_};
  }
  std::optional<std::uint32_t> column_at(double x, double y) const;
  // Returns the sample of a column nearest in height.
  std::optional<std::uint32_t> nearest(std::uint32_t column, double z, double tolerance) const;
  template <class Visit>
  void for_columns_beside(std::uint32_t column, std::int64_t far, Visit&& visit) const;
  // Returns the smallest area of a room, as opposed to a table: 0.9 m² for a passage of 0.6 m.
  double room() const { return 10 * radius_ * radius_; }
  template <class Visit>
  void for_neighbours(std::uint32_t sample, Visit&& visit) const;

  std::span<const std::uint32_t> members(std::uint32_t part) const {
    return std::span(members_).subspan(begin_[part], begin_[part + 1] - begin_[part]);
  }

  double radius_, climb_, height_, slope_;
  std::uint32_t opaque_;  // triangles from here on are of glass
  bool border_ = false;   // a plane is laid, and people enter from its border
  double cell_ = 0;
  glm::dvec2 corner_{};
  std::uint32_t columns_ = 0, rows_ = 0;
  std::vector<float> top_;             // per column: the highest surface at its middle
  std::vector<std::uint8_t> wet_;      // per column: 1 if water is on top
  std::vector<MeshRange> ceilings_;    // the triangles of meshes that are named as ceilings, ascending
  std::vector<std::uint32_t> first_;   // per column: its start in the samples, which ascend in z
  std::vector<std::uint32_t> column_;  // per sample
  std::vector<float> z_;               // per sample
  std::vector<std::uint8_t> taken_;    // per sample: bits of obstacles to a person there
  std::vector<std::pair<std::uint32_t, std::uint32_t>> leaves_;  // samples at closed leaves and panes, and their mesh
  std::vector<std::uint32_t> part_;                              // per sample with room
  std::vector<Part> parts_;
  std::vector<std::uint32_t> begin_, members_;                   // samples with room, by their parts
  std::vector<Access> access_;                                   // per part
  std::vector<std::pair<std::uint32_t, std::uint32_t>> climbs_;  // if any part is to be told
  std::vector<glm::dvec3> entries_;
  std::vector<ClosedPart> entered_;
  std::optional<Ways> ways_;  // as long as nothing more is entered
  std::optional<HighSteps> high_steps_;
};

template <class Visit>
void GroundField::for_neighbours(std::uint32_t sample, Visit&& visit) const {
  const std::uint32_t column = column_[sample], x = column % columns_, y = column / columns_;
  const double step = std::max(climb_, 1.1 * std::tan(slope_) * std::sqrt(2.0) * cell_);
  for (std::uint32_t ny = y > 0 ? y - 1 : 0; ny <= std::min(y + 1, rows_ - 1); ++ny)
    for (std::uint32_t nx = x > 0 ? x - 1 : 0; nx <= std::min(x + 1, columns_ - 1); ++nx) {
      if (nx == x && ny == y) continue;
      const std::uint32_t other = ny * columns_ + nx;
      for (std::uint32_t s = first_[other]; s < first_[other + 1]; ++s)
        if (std::abs(double{z_[s]} - z_[sample]) <= step) visit(s);
    }
}

// Visits the columns `far` steps away along x and y.
template <class Visit>
void GroundField::for_columns_beside(std::uint32_t column, std::int64_t far, Visit&& visit) const {
  const std::int64_t x = column % columns_, y = column / columns_;
  for (const auto& [dx, dy] : {std::pair<int, int>{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
    const std::int64_t nx = x + dx * far, ny = y + dy * far;
    if (nx < 0 || ny < 0 || nx >= columns_ || ny >= rows_) continue;
    visit(static_cast<std::uint32_t>(ny * columns_ + nx));
  }
}

}  // namespace vantage
