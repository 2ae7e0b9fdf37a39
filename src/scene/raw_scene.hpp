// SPDX-License-Identifier: Apache-2.0
// A scene in the survey frame in double precision, before cleaning and before subtracting a local origin.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "core/glm.hpp"
#include "scene/scene_data.hpp"

namespace vantage {

// A mesh that several nodes share, in its own frame. Every position is used by a triangle.
struct SharedMesh {
  std::vector<Float3> positions;
  std::vector<Float3> normals;         // empty, or one per position
  std::vector<Float2> texcoords;       // empty, or one per position
  std::vector<std::uint32_t> colours;  // empty, or one per position
  std::vector<Triangle> triangles;     // into `positions`
};

struct PlacedShared {
  std::uint32_t mesh = 0;  // index into RawScene::shared
  MeshPlace place;
};

struct RawScene {
  std::vector<glm::dvec3> positions;
  std::vector<Float3> normals;         // empty, or one per position
  std::vector<Float2> texcoords;       // empty, or one per position
  std::vector<std::uint32_t> colours;  // empty, or one per position
  std::vector<Triangle> triangles;
  std::vector<MeshRange> ranges;
  std::vector<MeshInfo> meshes;
  // Meshes that are stored once, beside the arrays above, and their places: for each range, what it has besides its own
  // triangles. Empty if nothing is shared.
  std::vector<SharedMesh> shared;
  std::vector<std::vector<PlacedShared>> placed;
  std::vector<Material> materials;
  std::vector<Image> images;
  std::vector<glm::dvec3> search_positions;
  std::vector<Uv> search_uvs;
  std::vector<Triangle> search_triangles;
  std::vector<Room> rooms;
  // Coarsest spacing, in metres, of the float32 values of the file's positions; 0 if they were exact.
  double coarsest_input_spacing_m = 0;
  // Memory that cleaning may use beyond what these arrays require.
  std::uint64_t spare_bytes = std::numeric_limits<std::uint64_t>::max();
  std::vector<std::string> notes;
  std::string defaults_json = "{}";
  SceneOptions options = {};
};

// Drops triangles that no ray can meet soundly (not finite, absurdly far, without area, exact duplicates), subtracts
// the local origin in double, rounds to float, cuts blocking triangles back from surveyed ones in their plane, and
// removes unused vertices. Notes report what was dropped. Throws Error, prefixed with `source`: malformed_file if no
// surveyed triangle is left; out_of_memory if too many blocking triangles lie in one plane with surveyed ones to be
// cut.
std::shared_ptr<const SceneData> finish_scene(RawScene&& raw, const std::string& source);

// Keeps the triangles whose entry in `keep` is not 0, and removes meshes that have none left.
void keep_triangles(RawScene& raw, const std::vector<std::uint8_t>& keep);

// Removes meshes without triangles, shared ones counted; sets the other meshes' counts from their ranges.
void drop_empty_meshes(RawScene& raw);

// Local origin for a box of coordinates: its centre, rounded to a multiple of the smallest power of ten not below the
// largest extent. A site modelled around 0 therefore keeps 0, and one shifted by kilometres gets the same local
// coordinates as the unshifted one. No local coordinate exceeds 5.5 times the extent.
Vec3 local_origin(const Box& bounds);

}  // namespace vantage
