// SPDX-License-Identifier: Apache-2.0
/// Scenes from code: meshes from arrays, glTF from memory, and meshes that move, in any scene.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "vantage/scene.hpp"
#include "vantage/types.hpp"

namespace vantage {

/// Placement of a mesh: its points are rotated, then moved.
struct Pose {
  Vec3 translation = {};                          ///< Metres, survey frame.
  std::array<double, 4> rotation = {0, 0, 0, 1};  ///< Quaternion x, y, z, w, of any length but 0.
};

/// A mesh as arrays. `Role::search` makes it part of the search area, `Role::ignore` leaves it out.
struct SceneMesh {
  std::string name = "mesh";         ///< For patterns and tables.
  std::vector<Vec3> positions = {};  ///< Metres, Z up; in the survey frame under the default `pose`.
  std::vector<std::array<std::uint32_t, 3>> triangles =
      {};                                      ///< Indices into `positions`, counter-clockwise from outside.
  std::optional<Role> role = std::nullopt;     ///< Empty: surveyed, or blocking once any mesh is marked surveyed.
  double diffuse = 0.5;                        ///< Diffuse reflection coefficient R, in [0, 1].
  std::uint32_t weight = 1;                    ///< Weight of its voxels in coverage, 1 to 255.
  bool door = false;                           ///< A closed leaf; walking passes it, rays do not.
  bool station_area = false;                   ///< Stations may stand on it, whatever its role.
  double detail_m = 0;                         ///< Widest beam footprint of a counted point, metres; 0: any.
  double accuracy_m = 0;                       ///< Largest range noise (σ) of a counted point, metres; 0: any.
  std::array<float, 4> colour = {1, 1, 1, 1};  ///< Linear red, green, blue and alpha, in [0, 1].
  Pose pose = {};                              ///< Place of the mesh.
};

/// Collects meshes and builds immutable, independent scenes from them. One thread at a time; finished scenes may be
/// read from any thread.
/// After the first call, `build` remakes only moved or replaced meshes if that provably gives the same scene as a full
/// build; `rebuilt_all` says whether it made all of them. A full build is needed if roles change, search meshes change,
/// or the bounds need another local origin; also if, near the changed mesh, triangles are dropped, repeat each other or
/// lie in one plane with those of another role.
/// `Simulator::set_scene` takes the next scene.
class SceneBuilder {
 public:
  /// Starts without meshes.
  SceneBuilder();
  ~SceneBuilder();
  SceneBuilder(SceneBuilder&&) noexcept;
  SceneBuilder& operator=(SceneBuilder&&) noexcept;

  /// Adds a mesh and returns its number, from 0. Throws Error invalid_argument: an index or a value out of range.
  std::size_t add(SceneMesh mesh);
  /// Moves a mesh to a pose. Throws Error invalid_argument: no such mesh, or a pose that is not finite.
  void move(std::size_t mesh, const Pose& pose);
  /// Replaces a mesh. Throws Error invalid_argument, as above.
  void replace(std::size_t mesh, SceneMesh with);
  std::size_t size() const noexcept;  ///< Meshes added.

  /// Returns the scene as it stands now. Throws Error malformed_file if nothing is surveyed, as `Scene::load` does.
  Scene build();
  bool rebuilt_all() const noexcept;  ///< True if the last `build` remade every mesh.

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Changes to a scene. Patterns are shell globs (`*`, `?`) on the names of `Scene::meshes()`, which are those of
/// nodes.
struct SceneChange {
  /// Patterns of meshes to move, with their new pose: from where they stand in the scene, rotated about the origin of
  /// the survey frame, then moved. The first pattern that matches a mesh counts.
  std::vector<std::pair<std::string, Pose>> move = {};
  std::vector<std::string> remove = {};  ///< Patterns of meshes to leave out.
  /// Meshes to add behind the others, but before those of glass. `Role` must be `surveyed`, `blocking` or empty:
  /// surveyed.
  std::vector<SceneMesh> add = {};
};

/// Returns a scene with some of its meshes changed. Any scene will do, a loaded one too, with its normals, colours,
/// glass and rooms. The search area stays, and so does the local origin; meshes that nodes share are stored where they
/// stand. Triangles without area are left out. Others are taken as they are: what lies in one plane with triangles of
/// another role is not cut, and does not hide these for certain. Positions are rounded to float each time, so change
/// the first scene again rather than the last. Throws Error: invalid_argument (a pattern that matches nothing, a pose
/// or an added mesh with a value out of range, a mesh that goes beyond 1000 km), malformed_file (nothing is surveyed
/// then), out_of_memory.
Scene with_changes(const Scene& scene, const SceneChange& change);

/// Loads a scene from the bytes of a .glb or .gltf file, as `Scene::load` does. Data URIs are read, other files are
/// not. Messages begin with `name`. Throws Error as `Scene::load`, and malformed_file if it refers to another file.
Scene load_gltf(std::span<const std::uint8_t> bytes, const SceneOptions& options = {},
                const std::string& name = "glTF in memory");

}  // namespace vantage
