// SPDX-License-Identifier: Apache-2.0
// Finds where a person can walk: samples of the scene's surfaces on a grid seen from above, with room for a person, and
// their connected parts.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
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

  // REQUIRES: the scene has triangles. Doors do not block.
  GroundField(const SceneData& scene, const WalkableOptions& options, std::optional<Plane> plane = {});

  // Determines the reached parts: from `enter` if given; from the border if a plane is laid; otherwise from the parts
  // where people enter. These are the lowest large parts that are in the open or lead there, by a door or an opening,
  // as several dwellings do; without one, the rooms that have a way out, however small; else the largest of the lowest.
  // Throws Error invalid_argument if there is no room for a person near one of `enter`.
  void reach(const MeshTree& tree, std::span<const glm::dvec3> enter);

  // Access of the sample at this place, or of its nearest neighbour; narrow if there is none. REQUIRES: reach() was
  // called.
  Access at(const glm::dvec3& place) const;
  // Entrances of the reached parts, the largest first; empty if nothing is reached.
  const std::vector<glm::dvec3>& entries() const { return entries_; }
  // Sealed parts as large as a room, and covered ones as large as a hall beyond a step. Largest first.
  struct NotEntered {
    double area_m2 = 0;
    glm::dvec3 middle{};
    std::vector<std::uint32_t> doors = {};  // meshes of closed doors on the way from what is reached
  };
  std::vector<NotEntered> rooms_not_entered(const SceneData& scene) const;
  // Area of the columns that hold anything.
  double outline() const;
  // Area, seen from above and up to this height, of the surfaces that continue the reached ones, with or without room.
  double ground_area(double highest_z) const;
  // Area of parts with room under a cover, reached or not: large in a building, small in a machine.
  double covered_area() const;
  // Area of parts as large as a hall, reached or not, no higher on average, from which one sees walls around: a site's
  // floors, whatever steps lie between them, and not the tops of a machine.
  double walled_area(const MeshTree& tree, double highest_z) const;
  // Large parts beyond steps higher than a person takes but less than twice as high, and the highest of those steps.
  struct HighSteps {
    double highest_m = 0, area_m2 = 0;
  };
  std::optional<HighSteps> high_steps() const { return high_steps_; }

 private:
  struct Part {
    std::uint64_t samples = 0, in_the_sky = 0, above_others = 0;
    std::uint32_t first = 0;
    double mean_z = 0;
    bool at_door = false;
    double area(double cell) const { return static_cast<double>(samples) * cell * cell; }
  };
  static constexpr std::uint32_t nowhere = 0xFFFFFFFFu;

  void lay_grid(const SceneData& scene, std::optional<Plane> plane);
  void find_samples(const SceneData& scene, std::optional<Plane> plane);
  void find_room(const SceneData& scene);
  void find_parts();
  bool is_layer(std::uint32_t sample) const;
  // Level lines of sight, at knee and head height, that lead out of the model from the edge of the part.
  struct WaysOut {
    bool any = false;
    double share = 0;  // of all directions at the edge
  };
  WaysOut ways_out(const MeshTree& tree, const Part& part, std::uint32_t number) const;
  std::vector<std::uint32_t> choose_parts(const MeshTree& tree) const;
  // The sample of a part nearest to its middle.
  glm::dvec3 middle_of(std::uint32_t part) const;
  // Parts on both sides of each closed door.
  struct ClosedDoor {
    std::uint32_t mesh, parts[2];
  };
  std::vector<ClosedDoor> closed_doors(const SceneData& scene) const;
  void tell_apart();
  void look_beyond_high_steps();

  glm::dvec2 middle(std::uint32_t column) const {
    return {corner_.x + (column % columns_ + 0.5) * cell_, corner_.y + (column / columns_ + 0.5) * cell_};
  }
  std::optional<std::uint32_t> column_at(double x, double y) const;
  // The sample of a column nearest in height.
  std::optional<std::uint32_t> nearest(std::uint32_t column, double z, double tolerance) const;
  template <class Visit>
  void for_columns_beside(std::uint32_t column, std::int64_t far, Visit&& visit) const;
  // Smallest area of a room, as opposed to a table: 0.9 m² for a passage of 0.6 m.
  double room() const { return 10 * radius_ * radius_; }
  template <class Visit>
  void for_neighbours(std::uint32_t sample, Visit&& visit) const;

  double radius_, climb_, height_, slope_;
  bool border_ = false;  // a plane is laid, and people enter from its border
  double cell_ = 0;
  glm::dvec2 corner_{};
  std::uint32_t columns_ = 0, rows_ = 0;
  std::vector<float> top_;             // per column: the highest surface at its middle
  std::vector<std::uint32_t> first_;   // per column: its start in the samples, which ascend in z
  std::vector<std::uint32_t> column_;  // per sample
  std::vector<float> z_;               // per sample
  std::vector<std::uint8_t> taken_;    // per sample: bits of obstacles to a person there
  std::vector<std::uint32_t> part_;    // per sample with room
  std::vector<Part> parts_;
  std::vector<Access> access_;  // per part
  std::vector<glm::dvec3> entries_;
  std::optional<HighSteps> high_steps_;
};

}  // namespace vantage
