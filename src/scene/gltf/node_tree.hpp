// SPDX-License-Identifier: Apache-2.0
// The nodes of one glTF scene, flattened: placed meshes, with the marks inherited from nodes.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/glm.hpp"
#include "scene/gltf/file.hpp"
#include "vantage/scene.hpp"

namespace vantage::gltf {

// Entry of SceneOptions::doors that keeps doors closed, as they are in the file.
inline constexpr std::string_view kClosedDoors = "closed";

// Entry of SceneOptions::glass that makes all glass opaque.
inline constexpr std::string_view kOpaqueGlass = "opaque";

// Entry of SceneOptions::mirror that makes all surfaces matt.
inline constexpr std::string_view kNoMirror = "none";

// Marks in the extras of an element.
struct Marks {
  std::optional<Role> role;
  std::optional<double> diffuse;
  std::optional<std::uint32_t> weight;
  std::optional<double> detail_mm, accuracy_mm;
  std::optional<bool> door;   // a leaf, open unless SceneOptions::doors says otherwise
  std::optional<bool> glass;  // rays pass it, unless SceneOptions::glass says otherwise
  std::optional<bool> mirror;
};
// Reads the marks in an element's extras. Throws Error malformed_file for an unknown role, a diffuse coefficient
// outside [0, 1], a weight outside 1 … 255, or a detail or accuracy that is not above 0.
Marks read_marks(const File& file, const char* array, int index, const std::string& name);

// Names are cut to this many bytes, since they are copied to every mesh, table and page.
constexpr std::size_t kLongestName = 200;

// Marks that a node has from itself and the nodes above it. Patterns match names of nodes.
struct NodeMarks {
  std::optional<Role> pattern_role = {};  // from the nearest node whose name matches a pattern
  std::optional<std::uint32_t> pattern_weight = {};
  std::optional<double> pattern_detail_mm = {}, pattern_accuracy_mm = {};
  bool door = false, station_area = false, glass = false, mirror = false;  // true if a pattern matches any of them
  Marks marks = {};                                                        // from the nearest node that has them
  bool own_role = false;  // true if a role's pattern matches this node itself
};

// A node with a mesh.
struct PlacedMesh : NodeMarks {
  int node = 0, mesh = 0;
  std::string name;  // the node's, the mesh's, that of the nearest node above, or "node N"; at most kLongestName bytes
  std::vector<glm::dmat4> world_from_mesh;  // affine, to the survey frame; several with EXT_mesh_gpu_instancing
};

// Flattens the scene. Throws Error: malformed_file (cycles, nodes with two parents, matrices not finite or not affine),
// invalid_argument (scene index out of range, a pattern that matches no node), out_of_memory (instances).
std::vector<PlacedMesh> flatten_scene(const File& file, const SceneOptions& options, LoadBudget& budget,
                                      std::vector<std::string>& notes);

}  // namespace vantage::gltf
