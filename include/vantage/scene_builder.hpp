// SPDX-License-Identifier: Apache-2.0
/// Scenes from code: meshes from arrays, glTF from memory, and meshes that move.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "vantage/scene.hpp"
#include "vantage/types.hpp"

namespace vantage {

/// Where a mesh stands: its points are rotated, then moved.
struct Pose {
  Vec3 translation = {};                          ///< Metres, survey frame.
  std::array<double, 4> rotation = {0, 0, 0, 1};  ///< Quaternion x, y, z, w, of any length but 0.
};

/// A mesh as arrays. `Role::search` makes it part of the search area, `Role::ignore` leaves it out.
struct SceneMesh {
  std::string name = "mesh";
  std::vector<Vec3> positions = {};  ///< Metres, Z up; the survey frame where `pose` is as it begins.
  std::vector<std::array<std::uint32_t, 3>> triangles =
      {};                                      ///< Indices into `positions`, counter-clockwise from outside.
  std::optional<Role> role = std::nullopt;     ///< Empty: surveyed, or blocking once any mesh is marked surveyed.
  double diffuse = 0.5;                        ///< Diffuse reflection coefficient R, in [0, 1].
  std::uint32_t weight = 1;                    ///< What a voxel of it counts in coverage, 1 to 255.
  std::array<float, 4> colour = {1, 1, 1, 1};  ///< Linear red, green, blue and alpha, in [0, 1].
  Pose pose = {};
};

/// Collects meshes and makes scenes of them, each immutable and on its own. After the first, `build` makes anew only
/// the meshes that were moved or replaced, where that provably gives the same scene as building everything does;
/// `rebuilt_all` says whether it did. Everything is built where roles change, search meshes change, bounds come to
/// need another local origin, or triangles are dropped, repeat each other or lie in one plane with those of another
/// role near the changed mesh. A `Simulator` is made for one scene, and is made again for the next.
/// One thread at a time; scenes that were made may be read by any.
class SceneBuilder {
 public:
  SceneBuilder();
  ~SceneBuilder();
  SceneBuilder(SceneBuilder&&) noexcept;
  SceneBuilder& operator=(SceneBuilder&&) noexcept;

  /// Adds a mesh and gives its number, from 0. Throws Error invalid_argument: an index or a value out of range.
  std::size_t add(SceneMesh mesh);
  /// Puts a mesh elsewhere. Throws Error invalid_argument: no such mesh, or a pose that is not finite.
  void move(std::size_t mesh, const Pose& pose);
  /// Puts another mesh in the place of one. Throws Error invalid_argument, as above.
  void replace(std::size_t mesh, SceneMesh with);
  std::size_t size() const noexcept;  ///< Meshes added.

  /// The scene as it stands now. Throws Error malformed_file where nothing is to be surveyed, as `Scene::load` does.
  Scene build();
  bool rebuilt_all() const noexcept;  ///< Whether the last `build` made every mesh anew.

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Loads a scene from the bytes of a .glb or .gltf file, as `Scene::load` does; data URIs are read, other files are
/// not. `name` opens messages. Throws Error as `Scene::load`, and malformed_file where it names another file.
Scene load_gltf(std::span<const std::uint8_t> bytes, const SceneOptions& options = {},
                const std::string& name = "glTF in memory");

}  // namespace vantage
