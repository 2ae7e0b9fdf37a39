// SPDX-License-Identifier: Apache-2.0
// Geometry of one glTF primitive.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "scene/gltf/accessor.hpp"
#include "scene/scene_data.hpp"

namespace vantage::gltf {

// Numbers of skipped parts, over all primitives.
struct SkippedPrimitives {
  std::size_t points_or_lines = 0, without_positions = 0, morphed = 0, cut_short = 0;
};

struct Primitive {
  std::string name;  // "mesh 3 primitive 0"
  int material = -1;
  std::vector<Triangle> triangles;
  std::unique_ptr<Accessor> position, normal, colour;  // null if absent, except position
  int texcoords[2] = {-1, -1};                         // accessors of TEXCOORD_0 and _1

  // Reads TEXCOORD_`set`; null if the primitive has none.
  std::unique_ptr<Accessor> texcoord(const File& file, int set) const;
};

// Upper bounds for a primitive, from its accessors before they are checked or read.
struct PrimitiveSize {
  std::uint64_t vertices = 0, triangles = 0;
  bool normals = false, colours = false;
};
PrimitiveSize primitive_size(const File& file, int mesh, std::size_t primitive);

// Returns null for points, lines and primitives without positions. Throws Error malformed_file.
std::unique_ptr<Primitive> read_primitive(const File& file, int mesh, std::size_t primitive,
                                          SkippedPrimitives& skipped);

}  // namespace vantage::gltf
