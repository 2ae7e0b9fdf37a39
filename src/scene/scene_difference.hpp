// SPDX-License-Identifier: Apache-2.0
// Meshes that two scenes have in common.
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
  // For each mesh of the later scene: the mesh of the earlier one with the same role, corners and normals, or kNew.
  // Ascending, apart from kNew.
  std::vector<std::uint32_t> mesh_before;
  std::vector<std::uint32_t> gone;  // meshes of the earlier scene that the later one lacks, ascending
  // Triangles of both, by their numbers in the earlier scene, ascending; `other`: in the later one, also ascending.
  std::vector<KeptRun> kept;
  bool shifted() const;  // true if a triangle of both has different numbers
};

// Compares two scenes. Empty if their local origins differ or nodes share meshes, as no part of the earlier one serves
// the later one then. Finds meshes that both have in the same order. Parallel.
std::optional<SceneDifference> difference(const SceneData& before, const SceneData& after);

// Returns the triangles of the later scene below `end` that are in no run; by number only.
std::vector<KeptRun> not_kept(std::span<const KeptRun> kept, std::uint32_t end);

// Applies `first` and then `then`: runs of triangles in both, by the numbers before both.
std::vector<KeptRun> joined(std::span<const KeptRun> first, std::span<const KeptRun> then);

}  // namespace vantage
