// SPDX-License-Identifier: Apache-2.0
// All surveyed and blocking triangles in an Embree scene, for distances and lines of sight on the host.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>

#include "core/glm.hpp"
#include "scene/scene_data.hpp"

namespace vantage {

// Safe to read from any thread. Local frame throughout.
class MeshTree {
 public:
  // Keeps no reference to `scene`. Throws Error: out_of_memory, device_failure.
  explicit MeshTree(const SceneData& scene) : MeshTree(scene, scene.triangle_count()) {}
  // Builds it over the scene's first triangles.
  MeshTree(const SceneData& scene, std::uint32_t triangles);
  ~MeshTree();
  MeshTree(MeshTree&&) noexcept;
  MeshTree& operator=(MeshTree&&) noexcept;

  // Returns the distance from `point` to the nearest triangle, at most `limit`, in double on the float vertices.
  double distance(const glm::dvec3& point, double limit) const;
  // A triangle by its number in the scene, and its distance.
  struct Hit {
    double distance;
    std::uint32_t triangle;
  };
  // Returns the triangle nearest to `point`, if one is nearer than `limit`.
  std::optional<Hit> nearest(const glm::dvec3& point, double limit) const;
  // Returns the first triangle on a ray from `point`; `way`: unit.
  std::optional<Hit> first(const glm::dvec3& point, const glm::dvec3& way) const;
  // Returns true if a triangle is nearer to `point` than `radius`. Faster than distance(): it stops at any such one.
  bool within(const glm::dvec3& point, double radius) const;
  // Returns true if a triangle is nearer to the segment from a to b than `radius`.
  bool within_of_segment(const glm::dvec3& a, const glm::dvec3& b, double radius) const;
  // Returns the distance of the first triangle straight below `point`.
  std::optional<double> drop(const glm::dvec3& point) const;
  // Returns true if a triangle meets the vertical segment from `point` + `from` to `point` + `to`.
  bool covered(const glm::dvec3& point, double from, double to) const;
  // Returns true if a triangle meets the segment from a to b.
  bool between(const glm::dvec3& a, const glm::dvec3& b) const;
  // Returns true if `point` lies within a closed solid, such as a tank, but not in a room or under a roof that is a
  // mere sheet. Tests the nearest surfaces straight above and level to all four sides: each must show its back, except
  // that one of the five may show its front, e.g. if another solid stands on this one. Faces of meshes whose winding
  // tells nothing show no back.
  bool inside_solid(const glm::dvec3& point) const;
  // Returns true if the winding of a mesh's triangles tells nothing, so that they have no front.
  bool wound_either_way(std::uint32_t mesh) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// Returns the distance from p to the closed triangle (a, b, c), which may be degenerate.
double distance_to_triangle(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c);

// Returns the distance between the segment from p to q and the closed triangle (a, b, c); either may be degenerate.
double distance_to_triangle(const glm::dvec3& p, const glm::dvec3& q, const glm::dvec3& a, const glm::dvec3& b,
                            const glm::dvec3& c);

}  // namespace vantage
