// SPDX-License-Identifier: Apache-2.0
// Contents of a loaded scene: flat arrays in the local frame, the only input of all later stages.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "vantage/image.hpp"
#include "vantage/scene.hpp"

namespace vantage {

struct Float2 {
  float x = 0, y = 0;
  friend bool operator==(const Float2&, const Float2&) = default;
};
struct Float3 {
  float x = 0, y = 0, z = 0;
  friend bool operator==(const Float3&, const Float3&) = default;
};
inline Vec3 widen(const Float3& p) { return {p.x, p.y, p.z}; }
inline Float3 narrow(const Vec3& p) {
  return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}
using Triangle = std::array<std::uint32_t, 3>;  // indices into SceneData::positions

// Base colour only, for the colours of points.
struct Material {
  std::array<float, 4> base_colour{1, 1, 1, 1};  // linear
  std::int32_t image = -1;                       // index into SceneData::images; sRGB encoded
  bool repeat_u = true, repeat_v = true;
};

// A mesh is a run of triangles; the MeshInfo of the same index has its name and role.
struct MeshRange {
  std::uint32_t first_triangle = 0, triangle_count = 0;
  std::uint32_t material = 0;  // index into SceneData::materials
};

struct SceneData {
  Vec3 origin;  // survey frame; local = survey − origin, subtracted in double before rounding to float
  // Surveyed and blocking meshes. Triangle number = the scene's primitive id.
  std::vector<Float3> positions;       // local frame
  std::vector<Float3> normals;         // empty, or one per position; (0,0,0) if the file has none
  std::vector<Float2> texcoords;       // empty, or one per position
  std::vector<std::uint32_t> colours;  // empty, or one per position, 0xAABBGGRR, linear; white if the file has none
  std::vector<Triangle> triangles;     // no degenerate, no non-finite triangle: dropped on load, counted in notes
  std::vector<MeshRange> ranges;       // consecutive: ranges[m].first_triangle ascends; those of glass come last
  std::vector<MeshInfo> meshes;        // as long as ranges
  std::vector<Material> materials;     // at least one
  std::vector<Image> images;
  // Marked search area, survey frame in double; uvs are empty if the file has none.
  std::vector<Vec3> search_positions;
  std::vector<Uv> search_uvs;
  std::vector<Triangle> search_triangles;

  std::vector<Room> rooms;  // survey frame
  Box local_bounds;         // bounds of positions used by triangles
  std::vector<std::string> notes;
  std::string defaults_json = "{}";
  SceneOptions options = {};  // how the file was read

  std::uint32_t mesh_of(std::uint32_t triangle) const;  // by binary search over ranges
  std::span<const Triangle> opaque_triangles() const;   // those that stop rays: all but the last, of glass
  bool has_glass() const { return opaque_triangles().size() < triangles.size(); }
};

}  // namespace vantage
