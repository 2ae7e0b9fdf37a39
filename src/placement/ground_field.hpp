// SPDX-License-Identifier: Apache-2.0
// Where a person gets to: the scene's surfaces as samples on a grid seen from above, which of them have room for a
// person, and which of those hang together.
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

// What keeps a person from a place.
enum class Access : std::uint8_t {
  reached,      // nothing
  narrow,       // something stands beside it
  headroom,     // something hangs above it
  unreachable,  // there is room, but nothing leads there: a roof, a table, the top of a wall
  sealed,       // there is room behind walls without an opening
};

// A field of the kind that robots and games find their way on (Mononen, Recast Navigation, 2009), but with heights and
// clearances from the triangles themselves and not from boxes: only a sample's place is rounded to the grid.
//
// Samples lie at the middles of square columns, wherever an upward triangle of no more than the slope that a person
// walks covers one. A sample has room where a person's outline is free of triangles: three upright cylinders about it,
// the narrower the taller, so that stairs and the edge of a ceiling above them leave room where a wall of the same
// height does not. Samples of neighbouring columns hang together where both have room and the step is one that a person
// takes. Radii are smaller than half the passage by half a column, so that every passage of that width has a row of
// samples with room, whichever way it runs; and at least so large that no wall, however thin, passes between two
// neighbours.
//
// Local frame; z up. Immutable but for reach(). Deterministic.
class GroundField {
 public:
  // A plane that is laid under the model: how far beyond its bounds, and at which height.
  struct Plane {
    double reach = 0, z = 0;
  };

  // REQUIRES: the scene has triangles. Doors do not block.
  GroundField(const SceneData& scene, const WalkableOptions& options, std::optional<Plane> plane = {});

  // Decides what is reached: from `enter`, where that is given; from the border, where a plane is laid; otherwise from
  // the part where people come in, the lowest large one that lies in the open or leads there, by a door or an opening.
  // Where none does, the largest of the lowest. Throws Error invalid_argument where there is no place for a person near
  // `enter`.
  void reach(const MeshTree& tree, std::optional<glm::dvec3> enter);

  // Of the sample of this place, or else of its nearest neighbour; narrow where there is none. REQUIRES: reach() was
  // called.
  Access at(const glm::dvec3& place) const;
  // Where one comes in; empty where nothing is reached.
  std::optional<glm::dvec3> entry() const { return entry_; }
  // Seen from above, the area of surfaces that the reached ones continue, with or without room, up to this height.
  double ground_area(double highest_z) const;
  // The area of parts with room that lie under a cover, reached or not: large in a building, small in a machine.
  double covered_area() const;
  // Large parts beyond steps that are higher than a person takes, but not twice as high, and the highest of those.
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
  bool leads_out(const MeshTree& tree, const Part& part, std::uint32_t number) const;
  std::optional<std::uint32_t> choose_part(const MeshTree& tree) const;
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
  // What parts have to be to be told apart from a table: 0.9 m² for a passage of 0.6 m.
  double room() const { return 10 * radius_ * radius_; }
  template <class Visit>
  void for_neighbours(std::uint32_t sample, Visit&& visit) const;

  double radius_, climb_, height_, slope_;
  bool border_ = false;  // a plane is laid, and entered from its border
  double cell_ = 0;
  glm::dvec2 corner_{};
  std::uint32_t columns_ = 0, rows_ = 0;
  std::vector<float> top_;             // of each column: the highest surface at its middle
  std::vector<std::uint32_t> first_;   // of each column, into the samples, which ascend in z
  std::vector<std::uint32_t> column_;  // of each sample
  std::vector<float> z_;               // of each sample
  std::vector<std::uint8_t> taken_;    // of each sample: bits of what is in a person's way there
  std::vector<std::uint32_t> part_;    // of each sample that has room
  std::vector<Part> parts_;
  std::vector<Access> access_;  // of each part
  std::optional<glm::dvec3> entry_;
  std::optional<HighSteps> high_steps_;
};

}  // namespace vantage
