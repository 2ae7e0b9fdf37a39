// SPDX-License-Identifier: Apache-2.0
#include "trace/vulkan/compute_bvh/bvh.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/first_numbers.hpp"
#include "core/glm.hpp"
#include "core/parallel.hpp"
#include "trace/vulkan/compute_bvh/bvh_boxes.hpp"

namespace vantage {
namespace {

constexpr std::uint32_t kMaxLeaf = 2;
constexpr int kBins = 32;
// From this depth on, items are halved by count.
constexpr std::uint32_t kMaxSahDepth = 34;
// Halving n items takes bit_width(n − 1) steps until each part is a leaf of one, and n < bvh_leaf_first_mask. An inner
// node thus has fewer than kMaxSahDepth + kMostHalvings nodes above it. A traversal leaves on its stack at most one
// child for each of these, one of the node's own, and an end mark.
constexpr std::uint32_t kMostHalvings = std::bit_width(bvh_leaf_first_mask);
static_assert(kMaxLeaf == 2 && kMaxSahDepth + kMostHalvings < bvh_stack_size);
constexpr std::size_t kParallelGrain = 8192;

struct Item {
  Bounds3 box;
  std::uint32_t triangle;  // or a placement, numbered after the triangles
  float centre(std::size_t axis) const { return 0.5f * (box.min[axis] + box.max[axis]); }
};

// A subtree over items [begin, end) may use node slots [slot, slot + end − begin), which no other subtree uses.
class Builder {
 public:
  // Items from number `triangles` on are placements.
  Builder(std::vector<Item>& items, std::size_t triangles, float widening)
      : items_(items), triangles_(triangles), widening_(widening), nodes_(items.size()) {}

  // Builds a subtree and returns its child word.
  std::uint32_t build(std::size_t begin, std::size_t end, std::uint32_t slot, std::uint32_t depth) {
    const std::size_t count = end - begin;
    const auto places = [&](const Item& item) { return item.triangle >= triangles_; };
    if (count == 1 && places(items_[begin]))
      return bvh_leaf_bit | bvh_placement_count << bvh_leaf_count_shift |
             (items_[begin].triangle - static_cast<std::uint32_t>(triangles_));
    if (count <= kMaxLeaf && std::none_of(at(begin), at(end), places))
      return bvh_leaf_bit | static_cast<std::uint32_t>(count - 1) << bvh_leaf_count_shift |
             static_cast<std::uint32_t>(begin);
    const std::size_t middle = split(begin, end, depth);
    Bounds3 left, right;
    std::uint32_t left_word = 0, right_word = 0;
    const auto build_left = [&] {
      for (std::size_t i = begin; i < middle; ++i) left.extend(items_[i].box);
      left_word = build(begin, middle, slot + 1, depth + 1);
    };
    const auto build_right = [&] {
      for (std::size_t i = middle; i < end; ++i) right.extend(items_[i].box);
      right_word = build(middle, end, slot + static_cast<std::uint32_t>(middle - begin), depth + 1);
    };
    if (count > kParallelGrain) {
      parallel::both(build_left, build_right);
    } else {
      build_left();
      build_right();
    }
    nodes_[slot] = node_of({left, right, left_word, right_word}, widening_);
    return slot;
  }

  const std::vector<BvhNode>& nodes() const { return nodes_; }

 private:
  // A plane between two bins of an axis.
  struct Cut {
    float cost;
    std::size_t axis;
    int bin;  // the last on the left
    float low, scale;
    int bin_of(const Item& item) const {
      return std::clamp(static_cast<int>((item.centre(axis) - low) * scale), 0, kBins - 1);
    }
  };
  struct Bin {
    Bounds3 box;
    std::size_t count = 0;
    void add(const Bin& other) {
      box.extend(other.box);
      count += other.count;
    }
    float cost() const { return count ? box.half_area() * static_cast<float>(count) : 0; }
  };

  // Splits items [begin, end) into two non-empty parts, reorders them, and returns the boundary.
  std::size_t split(std::size_t begin, std::size_t end, std::uint32_t depth) {
    Bounds3 centres;
    for (std::size_t i = begin; i < end; ++i)
      centres.extend(Float3{items_[i].centre(0), items_[i].centre(1), items_[i].centre(2)});
    std::optional<Cut> best;
    for (std::size_t axis = 0; axis < 3 && depth < kMaxSahDepth; ++axis) {
      const std::optional<Cut> cut = cheapest_cut(begin, end, axis, centres);
      if (cut && (!best || cut->cost < best->cost)) best = cut;
    }
    return best ? partition(begin, end, *best) : halve(begin, end, centres);
  }

  // Returns the cheapest cut; empty if all centres fall into one bin.
  std::optional<Cut> cheapest_cut(std::size_t begin, std::size_t end, std::size_t axis, const Bounds3& centres) const {
    const float extent = centres.max[axis] - centres.min[axis];
    if (!(extent > 0)) return std::nullopt;
    Cut cut{std::numeric_limits<float>::infinity(), axis, -1, centres.min[axis], static_cast<float>(kBins) / extent};
    std::array<Bin, kBins> filled;
    for (std::size_t i = begin; i < end; ++i) {
      Bin& bin = filled[static_cast<std::size_t>(cut.bin_of(items_[i]))];
      bin.box.extend(items_[i].box);
      ++bin.count;
    }
    std::array<float, kBins> right_cost{};  // of this bin and all to its right
    Bin side;
    for (std::size_t b = kBins - 1; b > 0; --b) {
      side.add(filled[b]);
      right_cost[b] = side.cost();
    }
    side = Bin();
    for (std::size_t b = 0; b + 1 < kBins; ++b) {
      side.add(filled[b]);
      if (side.count == 0 || side.count == end - begin) continue;
      const float cost = side.cost() + right_cost[b + 1];
      if (cost < cut.cost) {
        cut.cost = cost;
        cut.bin = static_cast<int>(b);
      }
    }
    return cut.bin >= 0 ? std::optional(cut) : std::nullopt;
  }

  std::size_t partition(std::size_t begin, std::size_t end, const Cut& cut) {
    const auto middle =
        std::stable_partition(at(begin), at(end), [&](const Item& item) { return cut.bin_of(item) <= cut.bin; });
    return static_cast<std::size_t>(middle - items_.begin());
  }

  // Splits by count along the longest axis; used if all centres coincide or the tree is deep.
  std::size_t halve(std::size_t begin, std::size_t end, const Bounds3& centres) {
    std::size_t axis = 0;
    for (std::size_t k = 1; k < 3; ++k)
      if (centres.max[k] - centres.min[k] > centres.max[axis] - centres.min[axis]) axis = k;
    const std::size_t middle = begin + (end - begin) / 2;
    std::nth_element(at(begin), at(middle), at(end), [&](const Item& a, const Item& b) {
      const float x = a.centre(axis), y = b.centre(axis);
      return x != y ? x < y : a.triangle < b.triangle;
    });
    return middle;
  }

  std::vector<Item>::iterator at(std::size_t i) { return items_.begin() + static_cast<std::ptrdiff_t>(i); }

  std::vector<Item>& items_;
  std::size_t triangles_;
  float widening_;
  std::vector<BvhNode> nodes_;
};

// Copies the used nodes depth first, so that a node's first child follows it.
std::vector<BvhNode> compact(const std::vector<BvhNode>& sparse, std::uint32_t root) {
  std::vector<BvhNode> dense;
  struct Todo {
    std::uint32_t slot, parent, child;
  };
  std::vector<Todo> todo{{root, no_primitive, 0}};
  while (!todo.empty()) {
    const Todo t = todo.back();
    todo.pop_back();
    const auto at = static_cast<std::uint32_t>(dense.size());
    dense.push_back(sparse[t.slot]);
    if (t.parent != no_primitive) (t.child == 0 ? dense[t.parent].child0 : dense[t.parent].child1) = at;
    const BvhNode node = dense.back();
    if (!(node.child1 & bvh_leaf_bit)) todo.push_back({node.child1, at, 1});
    if (!(node.child0 & bvh_leaf_bit)) todo.push_back({node.child0, at, 0});
  }
  return dense;
}

// Builds the tree over boxes of triangles, followed by placements.
Bvh tree_over(std::vector<Item>& items, std::span<const Float3> positions, std::span<const Triangle> triangles,
              std::span<const std::uint32_t> ids) {
  assert(triangles.size() == ids.size() && items.size() < bvh_leaf_first_mask);
  parallel::for_all(std::size_t{0}, items.size(), [&](std::size_t k) {
    if (k < triangles.size())
      for (const std::uint32_t vertex : triangles[k]) items[k].box.extend(positions[vertex]);
    items[k].triangle = static_cast<std::uint32_t>(k);
  });

  Bounds3 all;
  for (const auto& item : items) all.extend(item.box);

  Bvh bvh;
  Builder builder(items, triangles.size(), widening_of(all));
  const std::uint32_t root = builder.build(0, items.size(), 0, 0);
  if (root & bvh_leaf_bit) {
    // The root must be a node: one child holds everything, and no ray enters the other's empty box.
    bvh.nodes = {node_of({all, Bounds3(), root, root}, widening_of(all))};
  } else {
    bvh.nodes = compact(builder.nodes(), root);
  }
  bvh.triangles.resize(items.size());
  parallel::for_all(std::size_t{0}, items.size(), [&](std::size_t k) {
    const std::uint32_t t = items[k].triangle;
    if (t >= triangles.size()) return;  // a placement, which is no triangle of a leaf
    bvh.triangles[k] = bvh_triangle(positions, triangles[t], ids[t]);
  });
  return bvh;
}

struct WideBox {
  glm::dvec3 centre, half;
};

// Returns about a hundred boxes, or fewer, that together hold the tree. They fit a turned mesh better than one box.
std::vector<WideBox> boxes_within(const Bvh& bvh) {
  constexpr std::size_t kEnough = 128;
  std::vector<std::uint32_t> open{0};
  std::vector<WideBox> closed;
  for (std::size_t k = 0; k < open.size(); ++k) {
    const BvhNode& node = bvh.nodes[open[k]];
    const auto child = [&](std::uint32_t word, const vec3& centre, const vec3& half) {
      if (half.x < 0) return;
      if (!(word & bvh_leaf_bit) && open.size() + closed.size() < k + kEnough)
        open.push_back(word);
      else
        closed.push_back({{centre.x, centre.y, centre.z}, {half.x, half.y, half.z}});
    };
    child(node.child0, node.centre0, node.half0);
    child(node.child1, node.centre1, node.half1);
  }
  return closed;
}

// Returns the box around a placed mesh, in the local frame, including the boxes of all its triangles.
WideBox box_of(const vulkan::MeshPlacement& place, std::span<const WideBox> boxes) {
  const glm::dmat3 local_from_mesh = place.linear();
  glm::dmat3 sizes;
  for (int c = 0; c < 3; ++c) sizes[c] = abs(local_from_mesh[c]);
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high = -low;
  for (const WideBox& box : boxes) {
    const glm::dvec3 centre = local_from_mesh * box.centre + place.origin(), half = sizes * box.half;
    low = min(low, centre - half), high = max(high, centre + half);
  }
  return {(low + high) * 0.5, (high - low) * 0.5};
}

Bounds3 bounds_of(const WideBox& box, double doubt) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Bounds3 bounds;
  for (int k = 0; k < 3; ++k) {
    const auto at = static_cast<std::size_t>(k);
    bounds.min[at] = std::nextafter(static_cast<float>(box.centre[k] - box.half[k] - doubt), -kInfinity);
    bounds.max[at] = std::nextafter(static_cast<float>(box.centre[k] + box.half[k] + doubt), kInfinity);
  }
  return bounds;
}

// Widens boxes of placements to hold all hits in them. In the mesh's frame, a triangle's own box is widened by 2^-19 of
// the largest coordinate of the mesh or of the ray's origin, alike on all axes (lib/triangle_hit.glsl). This allows for
// rays from up to twice the scene's size; rays from further away use larger boxes. The remaining factor of 4 covers
// lengths instead of coordinates, and the roundings that move the ray, 2^-22 of the same lengths.
void bound_placements(std::span<Item> items, std::span<const Float3> positions, std::span<const Triangle> triangles,
                      const vulkan::PlacedMeshes& placed, std::span<const std::vector<WideBox>> boxes) {
  if (items.empty()) return;
  std::vector<WideBox> own(placed.placements.size());
  parallel::for_all(std::size_t{0}, own.size(),
                    [&](std::size_t k) { own[k] = box_of(placed.placements[k], boxes[placed.placements[k].mesh]); });
  double size = 0;
  for (const WideBox& box : own) size = std::max(size, length(abs(box.centre) + box.half));
  for (const Triangle& t : triangles)
    for (const std::uint32_t v : t) {
      const Float3& p = positions[v];
      size = std::max(size, length(glm::dvec3(p.x, p.y, p.z)));
    }
  for (std::size_t k = 0; k < own.size(); ++k) {
    const vulkan::MeshPlacement& place = placed.placements[k];
    items[k].box = bounds_of(own[k], 0x1p-17 * place.condition() * (size + length(place.origin())));
  }
}

// Appends a mesh's tree and returns its root.
std::uint32_t append(Bvh& bvh, const Bvh& mesh) {
  const auto root = static_cast<std::uint32_t>(bvh.nodes.size()),
             first = static_cast<std::uint32_t>(bvh.triangles.size());
  assert(bvh.triangles.size() + mesh.triangles.size() < bvh_leaf_first_mask);
  for (BvhNode node : mesh.nodes) {
    for (std::uint32_t* const child : {&node.child0, &node.child1}) *child += *child & bvh_leaf_bit ? first : root;
    bvh.nodes.push_back(node);
  }
  bvh.triangles.insert(bvh.triangles.end(), mesh.triangles.begin(), mesh.triangles.end());
  return root;
}

}  // namespace

Bvh build_bvh(std::span<const Float3> positions, std::span<const Triangle> triangles,
              std::span<const std::uint32_t> ids) {
  std::vector<Item> items(triangles.size());
  return tree_over(items, positions, triangles, ids);
}

BvhTriangle bvh_triangle(std::span<const Float3> positions, const Triangle& triangle, std::uint32_t id) {
  const Float3 a = positions[triangle[0]], b = positions[triangle[1]], c = positions[triangle[2]];
  return {{a.x, a.y, a.z}, id, {b.x, b.y, b.z}, 0, {c.x, c.y, c.z}, 0};
}

// Roundings of a ray moved into the mesh's frame, and of corners in place, are some 22 times the place's condition in
// units of 2^-24 of the distances involved; they grow as the inverse does.
BvhPlacement bvh_placement(const vulkan::MeshPlacement& place, float widening) {
  const glm::dmat3 inverse = glm::inverse(place.linear());
  const glm::dvec3 origin = place.origin();
  double growth = 0;
  for (int r = 0; r < 3; ++r)
    growth = std::max(growth, std::abs(inverse[0][r]) + std::abs(inverse[1][r]) + std::abs(inverse[2][r]));
  const auto row = [&](int r) {
    return vec3{static_cast<float>(inverse[0][r]), static_cast<float>(inverse[1][r]),
                static_cast<float>(inverse[2][r])};
  };
  return {.row0 = row(0),
          .root = 0,
          .row1 = row(1),
          .base = place.base_id,
          .row2 = row(2),
          .widening = widening,
          .origin = {static_cast<float>(origin.x), static_cast<float>(origin.y), static_cast<float>(origin.z)},
          .doubt = static_cast<float>(0x1p-19 * place.condition() * growth)};
}

Bvh build_placed_bvh(std::span<const Float3> positions, std::span<const Triangle> triangles,
                     std::span<const std::uint32_t> ids, const vulkan::PlacedMeshes& placed) {
  std::vector<Bvh> meshes(placed.meshes.size());
  std::vector<std::vector<WideBox>> boxes(meshes.size());
  parallel::for_all(std::size_t{0}, meshes.size(), [&](std::size_t m) {
    std::vector<std::uint32_t> own = first_numbers<std::uint32_t>(placed.meshes[m].size());
    meshes[m] = build_bvh(positions, placed.meshes[m], own);
    boxes[m] = boxes_within(meshes[m]);
  });

  std::vector<Item> items(triangles.size() + placed.placements.size());
  bound_placements(std::span(items).subspan(triangles.size()), positions, triangles, placed, boxes);
  std::vector<BvhPlacement> placements(placed.placements.size());
  parallel::for_all(std::size_t{0}, placements.size(), [&](std::size_t k) {
    const vulkan::MeshPlacement& place = placed.placements[k];
    placements[k] = bvh_placement(place, meshes[place.mesh].nodes.front().widening);
  });
  Bvh bvh = tree_over(items, positions, triangles, ids);
  std::vector<std::uint32_t> roots;
  for (Bvh& mesh : meshes) {
    roots.push_back(append(bvh, mesh));
    mesh = Bvh();  // frees its memory
  }
  for (std::size_t k = 0; k < placements.size(); ++k) placements[k].root = roots[placed.placements[k].mesh];
  bvh.placements = std::move(placements);
  return bvh;
}

}  // namespace vantage
