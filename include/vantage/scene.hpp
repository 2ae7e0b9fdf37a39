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

/// Purpose of a mesh (section 4.1 of the method).
enum class Role {
  surveyed,  ///< Hit by rays; its points count towards coverage and overlap.
  blocking,  ///< Hit by rays and kept clear of by stations; its points do not count.
  search,    ///< Stations may stand on it. Rays never hit it.
  ignore,    ///< Left out.
};

/// One mesh of the scene: a glTF primitive, placed by one node.
struct MeshInfo {
  std::string name;                  ///< The node's name; the mesh's if the node has none.
  Role role = Role::surveyed;        ///< `surveyed` or `blocking`; a loaded scene holds no other meshes.
  double diffuse = 0.5;              ///< Diffuse reflection coefficient R of the material, in [0, 1].
  std::uint32_t triangle_count = 0;  ///< Its triangles with an area.
  /// Weight of its voxels in coverage, 1 to 255, relative to voxels of other surveyed meshes.
  std::uint32_t weight = 1;
  bool door = false;          ///< A closed door leaf: people walk through it, rays do not.
  bool station_area = false;  ///< Stations may stand on it, whatever its role.
  bool glass = false;         ///< Rays pass it; people and stations do not. Such a mesh is `blocking`.
  bool mirror = false;        ///< Rays are reflected: it has no points of its own. Such a mesh is `blocking`.
  double detail_m = 0;        ///< Widest beam footprint of a point that counts, in metres; 0: any.
  double accuracy_m = 0;  ///< Largest range noise (one standard deviation) of a point that counts, in metres; 0: any.
};

/// A room that the file names, as IFC does (`IfcSpace`). Survey frame.
struct Room {
  std::string name = {};    ///< Its number and its long name.
  std::string storey = {};  ///< Name of the `IfcBuildingStorey` above it; "" if there is none.
  Box box = {};             ///< Around it.
  /// Loops around its floor, seen from above: corners (x, y). A point is in the room if it is within an odd number of
  /// them. Empty: the box alone.
  std::vector<std::vector<std::array<double, 2>>> outline = {};
};
/// Area of a room's floor, m².
double floor_area(const Room& room);
/// Distance of a point from a room, level and upright, at most `most_m`; 0 inside.
double distance_to(const Room& room, const Vec3& point, double most_m);
/// The room that holds a point, or the nearest one up to `within_m` away, as surfaces around a room stand for it; the
/// first of those equally near. Empty: there is none.
std::optional<std::size_t> room_at(std::span<const Room> rooms, const Vec3& point, double within_m = 0.15);

/// Unit of length of a file.
enum class Unit {
  metre,       ///< "m"
  centimetre,  ///< "cm"
  millimetre,  ///< "mm"
  inch,        ///< "in", 25.4 mm
  foot,        ///< "ft", 12 inches
};
double metres_in(Unit unit) noexcept;  ///< Length of one, in metres.
/// "m", "cm", "mm", "in", "ft".
const char* to_string(Unit unit) noexcept;
/// Throws Error invalid_argument for any other text.
Unit unit_from_string(const std::string& text);

/// Axis of a file that points up.
enum class UpAxis {
  x,  ///< "x"
  y,  ///< "y"
  z,  ///< "z"
};
const char* to_string(UpAxis up) noexcept;  ///< "x", "y", "z".
/// Throws Error invalid_argument unless the text is "x", "y" or "z".
UpAxis up_axis_from_string(const std::string& text);

/// The way in which a mesh that several nodes place is stored: once, or at each of its places.
enum class SharedMeshes {
  automatic,  ///< Once, in scenes too large to store every place: of more than 8 million triangles.
  always,     ///< Once.
  never,      ///< At each place.
};
const char* to_string(SharedMeshes shared) noexcept;  ///< "auto", "always", "never".
/// Throws Error invalid_argument for any other text.
SharedMeshes shared_meshes_from_string(const std::string& text);

/// Settings of `Scene::load`. Patterns are shell globs (`*`, `?`) on node names; a node without a name goes by its
/// mesh's. A node hands its role down to its children.
/// Precedence: pattern, then extras on node, mesh, material. If several patterns match a node, the one with most
/// letters other than `*` and `?` wins; among equals, the last in the order below.
/// Meshes without a role are surveyed; once any mesh is marked surveyed, they are blocking.
struct SceneOptions {
  /// Further files or folders of the same site, in the format of the file itself, read with it as one scene: IFC models
  /// of several disciplines, scans, floor plans.
  std::vector<std::string> beside = {};
  std::vector<std::string> surveyed = {};  ///< Surveyed nodes.
  std::vector<std::string> blocking = {};  ///< Nodes that only block.
  std::vector<std::string> search = {};    ///< Nodes of the search area.
  std::vector<std::string> ignore = {};    ///< Nodes that are left out.
  /// Node patterns with the weight of their voxels in coverage. Precedence among patterns as with roles.
  std::vector<std::pair<std::string, std::uint32_t>> weights = {};
  /// Nodes with `MeshInfo::door`. Leaves that the file marks as doors, or that are doors by name or shape, are open and
  /// left out, except those that a pattern here or above names. The word `closed` here keeps all of them.
  std::vector<std::string> doors = {};
  std::vector<std::string> station_area = {};  ///< Nodes with `MeshInfo::station_area`.
  /// Nodes of glass (`MeshInfo::glass`), besides meshes whose material or extras say so. A role pattern that names a
  /// node itself, and not one above it, makes its glass opaque. The word `opaque` here does so for all nodes.
  std::vector<std::string> glass = {};
  /// Mirrors (`MeshInfo::mirror`), by the rules of glass. The word `none` here makes all surfaces matt.
  std::vector<std::string> mirror = {};
  /// Node patterns with the wanted detail and accuracy, in millimetres (`MeshInfo`). Precedence as with roles.
  std::vector<std::pair<std::string, double>> details_mm = {}, accuracies_mm = {};
  std::optional<std::size_t> scene_index = std::nullopt;  ///< Which glTF scene; empty: the file's default.
  double default_diffuse = 0.5;  ///< R if neither extras nor a plain base colour (its luminance) give one.
  bool allow_outside = false;    ///< Lets the file name buffers and images outside its own folder.
  /// Unit of the file's lengths. Empty: recognised by what a person could do in the model. A note reports another unit
  /// than glTF's metres, and `load` throws malformed_file, with the choices as details, where none is clear. Files with
  /// any `vantage` extras are always read in metres.
  std::optional<Unit> unit = std::nullopt;
  std::optional<UpAxis> up = std::nullopt;  ///< Which axis points up. Empty: Y, as glTF says, or as with `unit`.
  /// Patterns (case does not matter) of the layers that a floor plan has its walls on. Empty: those named as walls,
  /// else those whose lines enclose rooms.
  std::vector<std::string> wall_layers = {};
  std::optional<double> wall_height_m = std::nullopt;  ///< Height of a floor plan's walls, above 0. Empty: 2.7.
  /// Storage of meshes that several nodes place (docs/scenes.md). It changes memory, and results by no more than the
  /// rounding of coordinates (docs/evidence/stability.md).
  SharedMeshes shared_meshes = SharedMeshes::automatic;
  /// Memory that the process may take while the scene is loaded, in bytes; what takes more is refused before it is
  /// read. 0: half of what is free.
  std::uint64_t max_memory_bytes = 0;
};

/// None of these is marked as deciding what a run finds: the scene's fingerprint covers them.
Settings settings(const SceneOptions& options);

/// Immutable triangle scene. Copies share storage. Safe to read from any thread.
class Scene {
 public:
  /// Loads a glTF file (.glb, .gltf), or a model (IFC, OBJ, STL, PLY, FBX, COLLADA, 3DS, X3D, DXF), a floor plan (DXF)
  /// or points (E57, LAS, PLY, XYZ, PTS, PTX, PCD) through an importer, a program of its own (docs/scenes.md). Y up
  /// becomes Z up: (x, y, z) ↦ (x, −z, y); other units become metres. Buffers and images come from the file itself and
  /// from regular files below its folder, links followed; from elsewhere only if `allow_outside`. Throws Error: io (a
  /// missing importer included), malformed_file (bad reference, unknown required extension, nothing to survey, no
  /// model, a file that its importer refuses or crashes on), invalid_argument (a pattern that matches nothing, a scene
  /// index, weight or coefficient out of range, a setting of floor plans for another file), out_of_memory (estimated to
  /// take more than `max_memory_bytes`).
  static Scene load(const std::filesystem::path& file, const SceneOptions& options = {});

  /// One surveyed mesh from an indexed triangle list in the survey frame. Throws Error: invalid_argument (an index or
  /// coefficient out of range), malformed_file (no triangle with area).
  static Scene from_triangles(std::span<const Vec3> positions, std::span<const std::array<std::uint32_t, 3>> triangles,
                              double diffuse = 0.5);

  /// Bounds of all surveyed and blocking meshes, survey frame.
  Box bounds() const noexcept;
  /// Surveyed and blocking ones; indices of meshes are their places here.
  std::span<const MeshInfo> meshes() const noexcept;
  std::size_t triangle_count() const noexcept;   ///< Triangles of all surveyed and blocking meshes.
  std::span<const Room> rooms() const noexcept;  ///< In the file's order; empty if it has none.
  /// True if the file marks a search area. If not, one is derived from walkable surfaces.
  bool has_search_area() const noexcept;
  /// Readable notes of the load: what was dropped or turned, how much precision was lost.
  std::span<const std::string> notes() const noexcept;
  /// The `vantage` object of the file's `asset.extras` as JSON text, "{}" if absent: default parameters of built-in
  /// scenes.
  const std::string& defaults_json() const noexcept;
  const SceneOptions& options() const noexcept;  ///< Settings the file was read with.
  /// Hash of everything that can change a result: geometry, roles, weights, materials, search area. Names are left out.
  std::uint64_t fingerprint() const noexcept;

  /// Internal storage, for the library's own modules.
  const SceneData& data() const noexcept { return *data_; }
  /// From that storage, likewise.
  explicit Scene(std::shared_ptr<const SceneData> data) : data_(std::move(data)) {}

 private:
  std::shared_ptr<const SceneData> data_;
};

}  // namespace vantage
