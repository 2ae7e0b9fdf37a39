// SPDX-License-Identifier: Apache-2.0
/// The 3D model of a site: what is surveyed, what blocks, and where a scanner may stand.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "vantage/settings.hpp"
#include "vantage/types.hpp"

namespace vantage {

struct SceneData;  // internal: flat arrays in the local frame, see src/scene/scene_data.hpp

/// What a mesh is for (section 4.1 of the method).
enum class Role {
  surveyed,  ///< Hit by rays; its points count towards coverage and overlap.
  blocking,  ///< Hit by rays and kept clear of by stations; its points do not count.
  search,    ///< Where stations may stand. Never hit by rays.
  ignore,    ///< Left out.
};

/// One mesh of the scene: a glTF primitive as one node places it.
struct MeshInfo {
  std::string name;            ///< The node's name, or the mesh's where the node has none.
  Role role = Role::surveyed;  ///< `surveyed` or `blocking`; the others are no meshes of the loaded scene.
  double diffuse = 0.5;        ///< Diffuse reflection coefficient R of its material, in [0, 1].
  std::uint32_t triangle_count = 0;
  /// What a voxel of it counts in coverage, 1 to 255, relative to voxels of other surveyed meshes.
  std::uint32_t weight = 1;
  bool door = false;          ///< A closed leaf that counts as open for who walks, and still blocks rays.
  bool station_area = false;  ///< Stations may stand on it, whatever else it is for.
  double detail_m = 0;        ///< Widest footprint of the beam whose point counts, in metres; 0: any.
  double accuracy_m = 0;  ///< Largest range noise (one standard deviation) of a point that counts, in metres; 0: any.
};

/// What a length of 1 in a file stands for.
enum class Unit { metre, centimetre, millimetre, inch, foot };
double metres_in(Unit unit) noexcept;
/// "m", "cm", "mm", "in", "ft".
const char* to_string(Unit unit) noexcept;
/// Throws Error invalid_argument for any other text.
Unit unit_from_string(const std::string& text);

/// Which of a file's axes points up.
enum class UpAxis { y, z };
const char* to_string(UpAxis up) noexcept;
/// Throws Error invalid_argument where the text is neither "y" nor "z".
UpAxis up_axis_from_string(const std::string& text);

/// How `Scene::load` reads a file. Patterns are shell globs (`*`, `?`) on node names (a node without one goes by its
/// mesh's); a node hands its role down to its children. Precedence: pattern, then extras on node, mesh, material; where
/// several patterns match one node, the one with most letters other than `*` and `?`, and of equals the last in the
/// order below. Once any mesh is marked surveyed, meshes without a role block; until then they are surveyed.
struct SceneOptions {
  std::vector<std::string> surveyed = {};  ///< Nodes that are surveyed.
  std::vector<std::string> blocking = {};  ///< Nodes that only block.
  std::vector<std::string> search = {};    ///< Nodes that form the search area.
  std::vector<std::string> ignore = {};    ///< Nodes that are left out.
  /// Nodes by pattern, and what their voxels count in coverage; where several match one node, as with roles.
  std::vector<std::pair<std::string, std::uint32_t>> weights = {};
  std::vector<std::string> doors = {};         ///< Nodes that are `MeshInfo::door`.
  std::vector<std::string> station_area = {};  ///< Nodes that are `MeshInfo::station_area`.
  /// Nodes by pattern, and the detail and accuracy wanted of them, in millimetres (`MeshInfo`); likewise.
  std::vector<std::pair<std::string, double>> details_mm = {}, accuracies_mm = {};
  std::optional<std::size_t> scene_index = std::nullopt;  ///< Which glTF scene; empty: the file's default.
  double default_diffuse = 0.5;  ///< R where neither extras nor a plain base colour (its luminance) give one.
  bool allow_outside = false;    ///< Let the file name buffers and images outside its own folder.
  /// What the file's lengths are. Empty: metres, as glTF says, unless its size, the sizes of things by their names,
  /// stairs and storeys say otherwise, which a note then tells. A file with any `vantage` extras is never asked.
  std::optional<Unit> unit = std::nullopt;
  std::optional<UpAxis> up = std::nullopt;  ///< Which axis points up. Empty: Y, as glTF says, or as with `unit`.
  /// Memory that the process may take while the scene is loaded, in bytes; what takes more is refused before it is
  /// read. 0: half of what is free.
  std::uint64_t max_memory_bytes = 0;
};

/// None decides by itself what a run finds: the scene's fingerprint does.
Settings settings(const SceneOptions& options);

/// Immutable triangle scene. Copies share storage; safe to read from any thread.
class Scene {
 public:
  /// Loads a .glb or .gltf file. Y up becomes Z up: (x, y, z) ↦ (x, −z, y); other units become metres.
  /// Buffers and images are read from the file itself and from regular files below its folder, links followed; from
  /// elsewhere only if `allow_outside`.
  /// Throws Error: io, malformed_file (bad reference, unknown required extension, nothing to survey), invalid_argument
  /// (a pattern that matches nothing, a scene index, weight or coefficient out of range), out_of_memory (estimated to
  /// take more than `max_memory_bytes`).
  static Scene load(const std::filesystem::path& file, const SceneOptions& options = {});

  /// One surveyed mesh from an indexed triangle list in the survey frame. Throws Error: invalid_argument (an index or
  /// coefficient out of range), malformed_file (no triangle with area).
  static Scene from_triangles(std::span<const Vec3> positions, std::span<const std::array<std::uint32_t, 3>> triangles,
                              double diffuse = 0.5);

  /// Bounds of all surveyed and blocking meshes, survey frame.
  Box bounds() const noexcept;
  std::span<const MeshInfo> meshes() const noexcept;
  std::size_t triangle_count() const noexcept;
  /// Whether the file marks a search area; where it does not, one is derived from walkable surfaces.
  bool has_search_area() const noexcept;
  /// Human-readable notes of the load: what was dropped or turned, precision lost, and how much of it.
  std::span<const std::string> notes() const noexcept;
  /// The `vantage` object of the file's `asset.extras` as JSON text ("{}" where absent): default parameters of built-in
  /// scenes.
  const std::string& defaults_json() const noexcept;
  const SceneOptions& options() const noexcept;  ///< How the file was read.
  /// Hash of everything that can change a result: geometry, roles, weights, materials, search area. Names do not count.
  std::uint64_t fingerprint() const noexcept;

  /// Internal storage, for the library's own modules.
  const SceneData& data() const noexcept { return *data_; }
  explicit Scene(std::shared_ptr<const SceneData> data) : data_(std::move(data)) {}

 private:
  std::shared_ptr<const SceneData> data_;
};

/// Names of the scenes that `write_built_in_scene` can make.
std::span<const std::string> built_in_scene_names() noexcept;

/// Writes a built-in scene as GLB: `three-walls`, `four-walls` or `industrial`. `triangles` is the wished number for
/// `industrial` (20 000 and up; met within 2 %), ignored by the others. The same arguments give the same bytes. Throws
/// Error: invalid_argument, io.
void write_built_in_scene(const std::string& name, std::size_t triangles, const std::filesystem::path& file);

}  // namespace vantage
