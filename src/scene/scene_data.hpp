// SPDX-License-Identifier: Apache-2.0
// Contents of a loaded scene: flat arrays in the local frame, the only input of all later stages.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
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
inline Triangle turned(const Triangle& t, bool mirrored) { return mirrored ? Triangle{t[0], t[2], t[1]} : t; }
// Returns the least and the largest index of the triangles' corners.
std::pair<std::uint32_t, std::uint32_t> corner_range(std::span<const Triangle> triangles);

// Base colour only, for the colours of points.
struct Material {
  std::array<float, 4> base_colour{1, 1, 1, 1};  // linear
  std::int32_t image = -1;                       // index into SceneData::images; sRGB encoded
  bool repeat_u = true, repeat_v = true;
  bool water = false;  // by its name
};

// A mesh is a run of triangles; the MeshInfo of the same index has its name and role.
struct MeshRange {  // triangles by their numbers in the scene
  std::uint32_t first_triangle = 0, triangle_count = 0;
  std::uint32_t material = 0;  // index into SceneData::materials
};

// Place at which a node puts a mesh that several nodes share.
struct MeshPlace {
  Vec3 x, y, z, origin;               // columns of survey_from_mesh, affine
  Vec3 normal_x, normal_y, normal_z;  // of the map of normals, up to a positive length
  bool mirrored = false;              // turns right-handed axes into left-handed ones
  Vec3 operator()(const Float3& p) const { return x * p.x + y * p.y + z * p.z + origin; }
  friend bool operator==(const MeshPlace&, const MeshPlace&) = default;
};

// Returns the position of a shared mesh's corner in place, in the local frame around `origin`. It is computed in double
// and rounded once; −0 becomes 0, so that equal positions have equal bits.
Float3 placed_position(const MeshPlace& place, const Float3& stored, const Vec3& origin);
// Returns the normal of a shared mesh in place; unit, or (0, 0, 0) if the file has none.
Float3 placed_normal(const MeshPlace& place, const Float3& normal);

// A run of the scene's triangles that are stored elsewhere: number t is stored as t − first_triangle + first_stored.
struct MeshInstance {
  static constexpr std::uint32_t kNoPlace = 0xFFFFFFFFu;
  std::uint32_t first_triangle = 0, triangle_count = 0, first_stored = 0;
  std::uint32_t place = kNoPlace;  // index into SceneData::places, or kNoPlace: stored in the local frame
  Box bounds = {};                 // of its corners in the local frame; empty without a place
};

struct SceneData {
  Vec3 origin;  // survey frame; local = survey − origin, subtracted in double before rounding to float
  // Surveyed and blocking meshes. Triangle number = the scene's primitive id. Read positions and normals by corners()
  // and corner_normals(): meshes that nodes share are stored once, in their own frame, behind everything else.
  std::vector<Float3> positions;        // local frame
  std::vector<Float3> normals;          // empty, or one per position; (0,0,0) if the file has none
  std::vector<Float2> texcoords;        // empty, or one per position
  std::vector<std::uint32_t> colours;   // empty, or one per position, 0xAABBGGRR, linear; white if the file has none
  std::vector<Triangle> triangles;      // no degenerate, no non-finite triangle: dropped on load, counted in notes
  std::vector<MeshInstance> instances;  // empty: all triangles are stored by their numbers. Otherwise consecutive
  std::vector<MeshPlace> places;
  std::vector<std::uint32_t> instance_at;  // the instance of every 2^kBlockBits-th triangle
  static constexpr int kBlockBits = 10;
  std::vector<MeshRange> ranges;    // consecutive: ranges[m].first_triangle ascends; those of glass come last
  std::vector<MeshInfo> meshes;     // as long as ranges
  std::vector<Material> materials;  // at least one
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
  bool shares() const { return !instances.empty(); }
  std::uint32_t triangle_count() const {
    return shares() ? instances.back().first_triangle + instances.back().triangle_count
                    : static_cast<std::uint32_t>(triangles.size());
  }
  std::uint32_t opaque_count() const;                  // triangles that stop rays: all but the last ones, of glass
  std::span<const Triangle> opaque_triangles() const;  // REQUIRES: !shares()
  bool has_glass() const { return opaque_count() < triangle_count(); }

  // Returns corners in the local frame. A shared mesh is placed in double and rounded once, as any other on loading, so
  // that a corner has the same bits whether its mesh is shared or not.
  std::array<Float3, 3> corners(std::uint32_t triangle) const {
    if (shares()) [[unlikely]]
      return placed_corners(triangle);
    const Triangle& v = triangles[triangle];
    return {positions[v[0]], positions[v[1]], positions[v[2]]};
  }
  // Returns normals in the local frame; unit, or (0, 0, 0) if the file has none. REQUIRES: !normals.empty().
  std::array<Float3, 3> corner_normals(std::uint32_t triangle) const;
  // Returns the indices of its corners' texture coordinates and colours.
  Triangle attributes(std::uint32_t triangle) const;
  const MeshInstance& instance_of(std::uint32_t triangle) const;  // REQUIRES: shares()
  // Returns the triangles of a run as they are stored.
  std::span<const Triangle> stored(const MeshInstance& run) const {
    return std::span(triangles).subspan(run.first_stored, run.triangle_count);
  }
  // Returns a corner of a stored triangle, local frame.
  Float3 placed(const MeshPlace& place, const Float3& stored) const { return placed_position(place, stored, origin); }

  // REQUIRES: consecutive from triangle 0 on.
  void set_instances(std::vector<MeshInstance> all);
  std::array<Float3, 3> placed_corners(std::uint32_t triangle) const;  // of corners(). REQUIRES: shares()
};

// Copies the scene with every mesh stored in place, for callers that need flat arrays. Throws Error out_of_memory if
// that does not fit.
std::shared_ptr<SceneData> flat_copy(const SceneData& scene);
// Does the same, but shares `scene` if it is flat already.
std::shared_ptr<const SceneData> flattened(std::shared_ptr<const SceneData> scene);

}  // namespace vantage
