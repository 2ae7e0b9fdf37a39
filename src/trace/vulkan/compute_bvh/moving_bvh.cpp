// SPDX-License-Identifier: Apache-2.0
#include "trace/vulkan/compute_bvh/moving_bvh.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "trace/vulkan/compute_bvh/bvh.hpp"
#include "trace/vulkan/compute_bvh/bvh_boxes.hpp"

namespace vantage {
namespace {

// The number of boxes that a ray enters grows with their areas. A growth by more than this factor makes a new tree
// worthwhile.
constexpr double kMostCost = 1.2;
constexpr std::uint32_t kNowhere = 0xFFFFFFFFu;

bool is_leaf(std::uint32_t child) { return (child & bvh_leaf_bit) != 0; }
std::uint32_t first_of(std::uint32_t leaf) { return leaf & bvh_leaf_first_mask; }
std::uint32_t count_of(std::uint32_t leaf) { return (leaf >> bvh_leaf_count_shift & 7u) + 1; }

bool is_empty(const vec3& half) { return half.x < 0; }
double half_area(const vec3& half) {
  if (is_empty(half)) return 0;
  return double{half.x} * half.y + double{half.y} * half.z + double{half.z} * half.x;
}
double cost_of(const BvhNode& node) { return half_area(node.half0) + half_area(node.half1); }

// Returns a box that holds the child's original box, and exceeds it only by roundings.
Bounds3 without_widening(const vec3& centre, const vec3& half, float widening) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Bounds3 box;
  if (is_empty(half)) return box;
  const std::array<float, 3> c{centre.x, centre.y, centre.z}, h{half.x, half.y, half.z};
  for (std::size_t k = 0; k < 3; ++k) {
    const double reach = double{h[k]} - double{widening};
    box.min[k] = std::nextafter(static_cast<float>(c[k] - reach), -kInfinity);
    box.max[k] = std::nextafter(static_cast<float>(c[k] + reach), kInfinity);
  }
  return box;
}

}  // namespace

MovingBvh::MovingBvh(std::vector<BvhNode> nodes, std::span<const BvhTriangle> triangles)
    : nodes_(std::move(nodes)),
      parent_(nodes_.size()),
      ids_(triangles.size()),
      leaf_of_(triangles.size()),
      place_(triangles.size()) {
  for (std::uint32_t at = 0; at < triangles.size(); ++at) {
    ids_[at] = triangles[at].id;
    place_[triangles[at].id & ~surveyed_bit] = at;
  }
  for (std::uint32_t n = 0; n < nodes_.size(); ++n) {
    for (const std::uint32_t child : {nodes_[n].child0, nodes_[n].child1}) {
      if (is_leaf(child))
        std::fill_n(leaf_of_.begin() + first_of(child), count_of(child), n);
      else
        parent_[child] = n;
    }
    built_cost_ += cost_of(nodes_[n]);
  }
  cost_ = built_cost_;
}

std::optional<MovingBvh::Change> MovingBvh::move(std::span<const Float3> positions, std::span<const Triangle> triangles,
                                                 std::span<const KeptRun> moved) const {
  Change change{.cost = cost_};
  for (const KeptRun& run : moved)
    for (std::uint32_t t = run.first; t < run.first + run.count; ++t) change.triangle_at.push_back(place_[t]);
  std::ranges::sort(change.triangle_at);
  std::vector<std::uint32_t> order(nodes_.size(), kNowhere);  // of the changed nodes
  Bounds3 moving;
  for (const std::uint32_t at : change.triangle_at) {
    const std::uint32_t id = ids_[at];
    const Triangle& triangle = triangles[id & ~surveyed_bit];
    for (const std::uint32_t vertex : triangle) moving.extend(positions[vertex]);
    change.triangles.push_back(bvh_triangle(positions, triangle, id));
    for (std::uint32_t n = leaf_of_[at]; order[n] == kNowhere; n = parent_[n]) {
      order[n] = 0;
      change.node_at.push_back(n);
    }
  }
  if (change.node_at.empty()) return change;
  if (widening_of(moving) > nodes_.front().widening) return std::nullopt;
  std::ranges::sort(change.node_at);
  for (std::uint32_t k = 0; k < change.node_at.size(); ++k) order[change.node_at[k]] = k;

  std::vector<Bounds3> whole(change.node_at.size());
  change.nodes.resize(change.node_at.size());
  // Children have larger numbers than their parents.
  for (std::size_t k = change.node_at.size(); k-- > 0;) {
    const BvhNode& before = nodes_[change.node_at[k]];
    const auto box_of = [&](std::uint32_t child, const vec3& centre, const vec3& half) {
      Bounds3 box;
      if (is_empty(half)) return box;
      if (!is_leaf(child))
        return order[child] == kNowhere ? without_widening(centre, half, before.widening) : whole[order[child]];
      for (std::uint32_t at = first_of(child); at < first_of(child) + count_of(child); ++at)
        for (const std::uint32_t vertex : triangles[ids_[at] & ~surveyed_bit]) box.extend(positions[vertex]);
      return box;
    };
    const auto stays = [&](std::uint32_t child) { return !is_leaf(child) && order[child] == kNowhere; };
    const Children children{box_of(before.child0, before.centre0, before.half0),
                            box_of(before.child1, before.centre1, before.half1), before.child0, before.child1};
    BvhNode& node = change.nodes[k] = node_of(children, before.widening);
    if (stays(before.child0)) node.centre0 = before.centre0, node.half0 = before.half0;
    if (stays(before.child1)) node.centre1 = before.centre1, node.half1 = before.half1;
    whole[k].extend(children.box0), whole[k].extend(children.box1);
    change.cost += cost_of(node) - cost_of(before);
  }
  if (change.cost > kMostCost * built_cost_) return std::nullopt;
  return change;
}

void MovingBvh::take(const Change& change) {
  for (std::size_t k = 0; k < change.node_at.size(); ++k) nodes_[change.node_at[k]] = change.nodes[k];
  cost_ = change.cost;
}

}  // namespace vantage
