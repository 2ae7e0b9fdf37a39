// SPDX-License-Identifier: Apache-2.0
// Small scenes of quadrilaterals with closed-form results.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "scene/scene_data.hpp"
#include "vantage/scanner.hpp"
#include "vantage/scene.hpp"

namespace vantage::test {

// A scene of quadrilaterals, one mesh each, numbered as added. Local frame = survey frame − origin.
class QuadScene {
 public:
  explicit QuadScene(const Vec3& origin = {}) { data_.origin = origin; }

  // Takes a corner and the two edges from it; texture coordinates run from (0, 0) at the corner along the edges.
  QuadScene& quad(const Float3& corner, const Float3& u, const Float3& v, Role role = Role::surveyed,
                  double diffuse = 0.5, const Material& material = {}) {
    const auto first = static_cast<std::uint32_t>(data_.positions.size());
    const auto triangle = static_cast<std::uint32_t>(data_.triangles.size());
    for (const auto& [a, b] : {std::pair{0.0f, 0.0f}, {1.0f, 0.0f}, {1.0f, 1.0f}, {0.0f, 1.0f}}) {
      data_.positions.push_back(
          {corner.x + a * u.x + b * v.x, corner.y + a * u.y + b * v.y, corner.z + a * u.z + b * v.z});
      data_.texcoords.push_back({a, b});
      const Float3& p = data_.positions.back();
      data_.local_bounds.extend({p.x, p.y, p.z});
    }
    data_.triangles.push_back({first, first + 1, first + 2});
    data_.triangles.push_back({first, first + 2, first + 3});
    data_.ranges.push_back({triangle, 2, static_cast<std::uint32_t>(data_.materials.size())});
    data_.meshes.push_back(
        {.name = "quad " + std::to_string(data_.meshes.size()), .role = role, .diffuse = diffuse, .triangle_count = 2});
    data_.materials.push_back(material);
    return *this;
  }
  SceneData& data() { return data_; }
  Scene scene() const { return Scene(std::make_shared<const SceneData>(data_)); }

 private:
  SceneData data_;
};

// A surveyed wall 6 m wide and 4 m high at x = 5, and a blocking floor 20 m square at z = −1.5.
inline QuadScene wall_and_floor(const Vec3& origin = {}) {
  QuadScene scene(origin);
  scene.quad({5, -3, -1.5f}, {0, 6, 0}, {0, 0, 4});
  scene.quad({-10, -10, -1.5f}, {20, 0, 0}, {0, 20, 0}, Role::blocking, 0.2);
  return scene;
}

// That wall, which wants a detail of 0.08 m, and another that wants 0.2 m.
inline QuadScene walls_of_two_details() {
  QuadScene scene = wall_and_floor();
  scene.quad({-6, -3, -1.5f}, {0, 6, 0}, {0, 0, 4});
  scene.data().meshes[0].detail_m = 0.08, scene.data().meshes[2].detail_m = 0.2;
  return scene;
}

inline Scanner coarse_scanner(double step_deg = 1) {
  Scanner scanner;
  scanner.azimuth_step = scanner.zenith_step = Angle::degrees(step_deg);
  return scanner;
}

}  // namespace vantage::test
