// SPDX-License-Identifier: Apache-2.0
// A tree whose triangles move: boxes above them are refitted, and the tree's shape stays.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "scene/scene_data.hpp"
#include "scene/scene_difference.hpp"
#include "shared/bvh_types.h"
#include "shared/trace_types.h"

namespace vantage {

class MovingBvh {
 public:
  // Takes a tree of build_bvh() whose ids are numbers of triangles from 0 on, perhaps with surveyed_bit.
  MovingBvh(std::vector<BvhNode> nodes, std::span<const BvhTriangle> triangles);

  // Nodes and triangles that a move changes, and their places, ascending.
  struct Change {
    std::vector<std::uint32_t> node_at = {}, triangle_at = {};
    std::vector<BvhNode> nodes = {};
    std::vector<BvhTriangle> triangles = {};
    double cost = 0;
  };
  // Moves the triangles of some runs, by their numbers, to new positions. Empty if a new tree would be faster to walk,
  // or needs larger boxes.
  std::optional<Change> move(std::span<const Float3> positions, std::span<const Triangle> triangles,
                             std::span<const KeptRun> moved) const;
  void take(const Change& change);

 private:
  std::vector<BvhNode> nodes_;
  std::vector<std::uint32_t> parent_;         // of each node; the root's is itself
  std::vector<std::uint32_t> ids_, leaf_of_;  // of the triangle at each place: its id, and the node of its leaf
  std::vector<std::uint32_t> place_;          // of each triangle
  double built_cost_ = 0, cost_ = 0;          // areas of all boxes
};

}  // namespace vantage
