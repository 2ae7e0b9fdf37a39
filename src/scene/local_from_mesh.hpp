// SPDX-License-Identifier: Apache-2.0
// Frame of a mesh that nodes share. Engines with two levels of trees move rays into it, instead of moving corners out
// of it.
#pragma once

#include <array>
#include <cmath>

#include "scene/scene_data.hpp"

namespace vantage {

// Bounds how much a linear map, given by its columns, multiplies the roundings of a ray that is moved through it and
// back: the product of the Frobenius norms of its matrix and the inverse. 3 if the map only turns; not finite if it
// flattens space.
inline double condition(const Vec3& x, const Vec3& y, const Vec3& z) {
  const auto norm = [](const Vec3& a, const Vec3& b, const Vec3& c) {
    return std::sqrt(dot(a, a) + dot(b, b) + dot(c, c));
  };
  const Vec3 yz = cross(y, z), zx = cross(z, x), xy = cross(x, y);  // cofactors; the inverse has them over
  return norm(x, y, z) * norm(yz, zx, xy) / std::abs(dot(x, yz));   // the determinant
}

// Returns the columns of the affine map from the mesh to the scene's local frame, in float.
inline std::array<float, 12> local_from_mesh(const SceneData& scene, const MeshPlace& place) {
  std::array<float, 12> out{};
  std::size_t n = 0;
  for (const Vec3& column : {place.x, place.y, place.z}) {
    // Embree moves a ray's direction into the mesh's frame, where a component below 1e-18 makes it miss every box
    // (RayCaster::safe). The rounding error of a right angle must therefore become 0. It is 1e-9 of a coordinate, less
    // than float's rounding.
    const double least = 0x1p-30 * std::sqrt(dot(column, column));
    for (const double c : {column.x, column.y, column.z}) out[n++] = std::abs(c) < least ? 0 : static_cast<float>(c);
  }
  const Vec3 at = place.origin - scene.origin;
  for (const double c : {at.x, at.y, at.z}) out[n++] = static_cast<float>(c);
  return out;
}

}  // namespace vantage
