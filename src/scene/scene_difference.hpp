// SPDX-License-Identifier: Apache-2.0
// What two scenes have in common, mesh by mesh.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "scene/scene_data.hpp"

namespace vantage {

// Consecutive triangles of one numbering, and their numbers in another.
struct KeptRun {
  std::uint32_t first = 0, count = 0, other = 0;
  friend bool operator==(const KeptRun&, const KeptRun&) = default;
};

struct SceneDifference {
  static constexpr std::uint32_t kNew = 0xFFFFFFFFu;
  // Of each mesh of the later scene: the one of the earlier scene with the same role, corners and normals, or kNew.
  // Ascending but for kNew.
  std::vector<std::uint32_t> mesh_before;
  std::vector<std::uint32_t> gone;  // meshes of the earlier scene that the later one lacks, ascending
  // Triangles of both, by their numbers in the earlier scene, ascending; `other`: in the later one, ascending, too.
  std::vector<KeptRun> kept;
  bool shifted() const;  // whether a triangle of both has different numbers
};

// Empty if nothing of an earlier scene could serve the later one: their local origins differ, or nodes share meshes.
// Meshes of both are found if they have the same order. Parallel.
std::optional<SceneDifference> difference(const SceneData& before, const SceneData& after);

// Triangles of the later scene below `end` that no run has; numbers alone.
std::vector<KeptRun> not_kept(std::span<const KeptRun> kept, std::uint32_t end);

// Follows `first` and then `then`: runs by the numbers before both.
std::vector<KeptRun> joined(std::span<const KeptRun> first, std::span<const KeptRun> then);

}  // namespace vantage
