// SPDX-License-Identifier: Apache-2.0
// The surfaces of a scene that stop rays, for comparison with points of scans.
#pragma once

#include <cstdint>
#include <optional>

#include "core/glm.hpp"
#include "placement/mesh_tree.hpp"
#include "vantage/scene.hpp"

namespace vantage {

// Safe to read from any thread. Survey frame.
class ModelSurface {
 public:
  explicit ModelSurface(const Scene& scene);

  struct Near {
    std::uint32_t mesh;
    double distance;    // from the point to the surface
    double height;      // and to the plane of the triangle, along `normal`
    glm::dvec3 normal;  // unit
    // Returns true if the surface is straight below or above the point, not an edge beside it.
    bool inside() const;
    glm::dvec3 foot(const glm::dvec3& point) const { return inside() ? point - height * normal : point; }
  };
  std::optional<Near> nearest(const glm::dvec3& point, double limit) const;

  struct Met {
    std::uint32_t mesh;
    double distance;
    glm::dvec3 normal;
  };
  std::optional<Met> first(const glm::dvec3& from, const glm::dvec3& way) const;
  // Returns true if nothing stops a ray from a to b.
  bool passes(const glm::dvec3& a, const glm::dvec3& b) const;

 private:
  glm::dvec3 corner(std::uint32_t triangle, std::size_t k) const;
  glm::dvec3 normal(std::uint32_t triangle) const;

  Scene scene_;
  glm::dvec3 origin_;
  MeshTree tree_;
};

}  // namespace vantage
