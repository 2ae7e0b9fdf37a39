// SPDX-License-Identifier: Apache-2.0
#include "trace/vulkan/compute_bvh/bvh.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numeric>
#include <utility>

#include "core/philox.hpp"
#include "trace/vulkan/compute_bvh/moving_bvh.hpp"

namespace vantage {
namespace {

struct Soup {
  std::vector<Float3> positions;
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> ids;

  void add(const Float3& at, float size) {
    const auto first = static_cast<std::uint32_t>(positions.size());
    positions.insert(positions.end(), {at, {at.x + size, at.y, at.z}, {at.x, at.y + size, at.z + size}});
    triangles.push_back({first, first + 1, first + 2});
    ids.push_back(static_cast<std::uint32_t>(ids.size()) | (ids.size() % 3 == 0 ? surveyed_bit : 0));
  }
  Bvh bvh() const { return build_bvh(positions, triangles, ids); }
};

Soup random_soup(std::size_t n) {
  RandomStream random(17);
  Soup soup;
  const auto uniform = [&] { return static_cast<float>(random.uniform()); };
  for (std::size_t k = 0; k < n; ++k) soup.add({10 * uniform(), 7 * uniform(), uniform()}, 0.3f * uniform());
  return soup;
}

// Each item is so far beyond the rest that a cut by area separates only that one: the deepest possible tree.
Soup nested_soup() {
  Soup soup;
  for (int axis = 0; axis < 3; ++axis)
    for (int k = -12; k <= 12; ++k) {
      const float far = std::pow(40.0f, static_cast<float>(k));
      for (int copy = 0; copy < 40; ++copy)
        soup.add({axis == 0 ? far : 0, axis == 1 ? far : 0, axis == 2 ? far : 0}, far * 1e-3f);
    }
  return soup;
}

// Walks the tree, checks that boxes contain everything below them, and computes how many nodes a traversal may have on
// its stack. A traversal leaves one child there at each inner node.
class Walk {
 public:
  // Walks from a node on. In a tree that places meshes, `placed` has the corners of each placement, where they stand.
  explicit Walk(const Bvh& bvh, std::uint32_t root = 0, std::span<const std::vector<Float3>> placed = {})
      : bvh_(bvh), placed_(placed), seen_(bvh.triangles.size()), places_(placed.size()) {
    node(root, 1);
  }
  std::uint32_t stack() const { return stack_; }
  bool sees_each_triangle_once() const {
    return std::all_of(seen_.begin(), seen_.end(), [](int times) { return times == 1; });
  }
  std::vector<std::uint32_t> ids() const {  // ascending
    std::vector<std::uint32_t> ids;
    for (std::size_t k = 0; k < seen_.size(); ++k)
      for (int times = 0; times < seen_[k]; ++times) ids.push_back(bvh_.triangles[k].id);
    std::sort(ids.begin(), ids.end());
    return ids;
  }
  const std::vector<int>& places() const { return places_; }  // how often each placement is seen

 private:
  void node(std::uint32_t at, std::uint32_t on_stack) {
    stack_ = std::max(stack_, on_stack);
    const BvhNode& n = bvh_.nodes.at(at);
    child(n.child0, n.centre0, n.half0, on_stack);
    child(n.child1, n.centre1, n.half1, on_stack);
  }
  void child(std::uint32_t word, const vec3& centre, const vec3& half, std::uint32_t on_stack) {
    if (half.x < 0) return;  // an empty box that no ray enters
    const std::size_t before = boxes_.size();
    boxes_.push_back({centre, half});
    if (word & bvh_leaf_bit) {
      const std::uint32_t first = word & bvh_leaf_first_mask, more = (word >> bvh_leaf_count_shift) & 7u;
      if (more == bvh_placement_count)
        place(first);
      else
        for (std::uint32_t k = first; k <= first + more; ++k) triangle(k);
    } else {
      node(word, on_stack + 1);
    }
    boxes_.resize(before);
  }
  void triangle(std::uint32_t k) {
    ++seen_.at(k);
    const BvhTriangle& t = bvh_.triangles[k];
    for (const vec3& p : {t.a, t.b, t.c}) inside({p.x, p.y, p.z});
  }
  void place(std::uint32_t k) {
    ++places_.at(k);
    for (const Float3& p : placed_[k]) inside(p);
  }
  void inside(const Float3& p) const {
    for (const auto& [centre, half] : boxes_) {
      EXPECT_LE(std::abs(double{p.x} - double{centre.x}), half.x);
      EXPECT_LE(std::abs(double{p.y} - double{centre.y}), half.y);
      EXPECT_LE(std::abs(double{p.z} - double{centre.z}), half.z);
    }
  }

  const Bvh& bvh_;
  std::span<const std::vector<Float3>> placed_;
  std::vector<int> seen_, places_;
  std::vector<std::array<vec3, 2>> boxes_;  // from the root downwards
  std::uint32_t stack_ = 0;
};

void expect_sound(const Soup& soup) {
  const Bvh bvh = soup.bvh();
  ASSERT_EQ(bvh.triangles.size(), soup.triangles.size());
  const Walk walk(bvh);
  EXPECT_TRUE(walk.sees_each_triangle_once());
  EXPECT_LE(walk.stack(), bvh_stack_size);
  std::vector<std::uint32_t> ids;
  for (const BvhTriangle& t : bvh.triangles) {
    ids.push_back(t.id);
    EXPECT_EQ(t.a.x, soup.positions[soup.triangles[t.id & ~surveyed_bit][0]].x);
  }
  std::vector<std::uint32_t> expected = soup.ids;
  std::sort(ids.begin(), ids.end());
  std::sort(expected.begin(), expected.end());
  EXPECT_EQ(ids, expected);
}

TEST(Bvh, HoldsEveryTriangleOnceInBoxesThatHoldIt) {
  for (const std::size_t n : {1u, 2u, 3u, 4u, 5u, 100u, 20'000u}) {
    SCOPED_TRACE(n);
    expect_sound(random_soup(n));
  }
}

// Two meshes in frames of their own, one placed turned, scaled and mirrored, among some triangles or none.
TEST(Bvh, PlacesMeshesInBoxesThatHoldThem) {
  for (const std::size_t n : {0u, 1u, 3u, 200u}) {
    SCOPED_TRACE(n);
    Soup soup = random_soup(n);
    const std::size_t own = soup.triangles.size();
    const Soup mesh = random_soup(700);
    vulkan::PlacedMeshes placed;
    std::vector<Triangle> shared;
    for (const Triangle& t : mesh.triangles) {
      const auto first = static_cast<std::uint32_t>(3 * n);
      shared.push_back({t[0] + first, t[1] + first, t[2] + first});
    }
    soup.positions.insert(soup.positions.end(), mesh.positions.begin(), mesh.positions.end());
    placed.meshes = {std::span<const Triangle>(shared).first(500), std::span<const Triangle>(shared).subspan(500)};
    placed.placements = {{0, 1000, {1, 0, 0, 0, 1, 0, 0, 0, 1, 2, -3, 4}},
                         {0, 1500 | surveyed_bit, {0, 2, 0.5F, -1.5F, 0, 0, 0, 0.25F, 1, 30, 7, -9}},
                         {1, 2000, {-1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 0}}};
    std::vector<std::vector<Float3>> corners;
    for (const vulkan::MeshPlacement& place : placed.placements)
      for (corners.emplace_back(); const Triangle& t : placed.meshes[place.mesh])
        for (const std::uint32_t v : t) {
          const Float3& p = soup.positions[v];
          const glm::dvec3 at = place.linear() * glm::dvec3(p.x, p.y, p.z) + place.origin();
          corners.back().push_back({static_cast<float>(at.x), static_cast<float>(at.y), static_cast<float>(at.z)});
        }
    const Bvh bvh =
        build_placed_bvh(soup.positions, std::span(soup.triangles).first(own), std::span(soup.ids).first(own), placed);
    const Walk top(bvh, 0, corners);
    EXPECT_EQ(top.ids().size(), own);
    EXPECT_EQ(top.places(), (std::vector<int>{1, 1, 1}));
    ASSERT_EQ(bvh.placements.size(), 3u);
    for (std::size_t k = 0; k < 3; ++k) {
      const BvhPlacement& place = bvh.placements[k];
      EXPECT_EQ(place.base, placed.placements[k].base_id);
      EXPECT_EQ(place.widening, bvh.nodes.at(place.root).widening);
      std::vector<std::uint32_t> all(placed.meshes[placed.placements[k].mesh].size());
      std::iota(all.begin(), all.end(), 0u);
      EXPECT_EQ(Walk(bvh, place.root).ids(), all) << "numbers within the mesh";
      // There and back.
      const glm::dvec3 p(0.3, -0.7, 1.1), at = placed.placements[k].linear() * p;
      for (const auto& [row, coordinate] : {std::pair(place.row0, p.x), {place.row1, p.y}, {place.row2, p.z}})
        EXPECT_NEAR(row.x * at.x + row.y * at.y + row.z * at.z, coordinate, 1e-6);
    }
  }
}

TEST(Bvh, OneSpotIsHalvedByCount) {
  Soup soup;
  for (int k = 0; k < 5000; ++k) soup.add({1, 2, 3}, 0.5f);
  expect_sound(soup);
  EXPECT_LE(Walk(soup.bvh()).stack(), 13u) << "2^13 > 5000 / 2";
}

TEST(Bvh, StaysShallowEnoughForTheStackWhereAreasAlwaysCutOffOne) {
  const Soup soup = nested_soup();
  expect_sound(soup);
  EXPECT_GT(Walk(soup.bvh()).stack(), 34u) << "no tree to try the bound with";
}

TEST(Bvh, IsTheSameTreeWhateverTheThreads) {
  const Soup soup = random_soup(50'000);
  const Bvh many = soup.bvh();
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const Bvh alone = soup.bvh();
  ASSERT_EQ(many.nodes.size(), alone.nodes.size());
  EXPECT_EQ(std::memcmp(many.nodes.data(), alone.nodes.data(), many.nodes.size() * sizeof(BvhNode)), 0);
  EXPECT_EQ(std::memcmp(many.triangles.data(), alone.triangles.data(), many.triangles.size() * sizeof(BvhTriangle)), 0);
}

// Moves some triangles again and again, and checks each time that boxes hold what is below them.
TEST(MovingBvh, HoldsWhatMoves) {
  Soup soup = random_soup(3000);
  Bvh bvh = soup.bvh();
  MovingBvh moving(bvh.nodes, bvh.triangles);
  RandomStream random(4);
  const auto below = [&](std::uint32_t n) { return static_cast<std::uint32_t>(random.uniform() * n); };
  for (int time = 0; time < 20; ++time) {
    const std::vector<KeptRun> moved{{below(1000), 1 + below(400), 0}, {2000 + below(500), 1 + below(400), 0}};
    for (const KeptRun& run : moved)
      for (std::uint32_t t = run.first; t < run.first + run.count; ++t)
        for (const std::uint32_t v : soup.triangles[t]) soup.positions[v].y += 0.05f * (time % 3 == 0 ? 1.0f : -1.0f);
    const auto change = moving.move(soup.positions, soup.triangles, moved);
    ASSERT_TRUE(change);
    moving.take(*change);
    for (std::size_t k = 0; k < change->node_at.size(); ++k) bvh.nodes[change->node_at[k]] = change->nodes[k];
    for (std::size_t k = 0; k < change->triangle_at.size(); ++k)
      bvh.triangles[change->triangle_at[k]] = change->triangles[k];
    EXPECT_EQ(change->triangles.size(), moved[0].count + moved[1].count);
    EXPECT_LT(change->nodes.size(), bvh.nodes.size());
    EXPECT_TRUE(Walk(bvh).sees_each_triangle_once());
    for (const BvhTriangle& t : bvh.triangles) {
      const BvhTriangle expected = bvh_triangle(soup.positions, soup.triangles[t.id & ~surveyed_bit], t.id);
      EXPECT_EQ(std::memcmp(&t, &expected, sizeof t), 0);
    }
  }
}

TEST(MovingBvh, LeavesItToANewTreeWhereItsOwnWouldBeSlowOrTooTight) {
  Soup soup = random_soup(3000);
  const Bvh bvh = soup.bvh();
  const MovingBvh moving(bvh.nodes, bvh.triangles);
  const std::vector<KeptRun> every_tenth = [] {
    std::vector<KeptRun> runs;
    for (std::uint32_t t = 0; t < 3000; t += 10) runs.push_back({t, 1, 0});
    return runs;
  }();
  const Soup before = soup;
  for (const KeptRun& run : every_tenth)
    for (const std::uint32_t v : soup.triangles[run.first]) soup.positions[v].x = 10 - soup.positions[v].x;
  EXPECT_FALSE(moving.move(soup.positions, soup.triangles, every_tenth)) << "its boxes would overlap all over";
  soup = before;
  for (const std::uint32_t v : soup.triangles[0]) soup.positions[v].z += 1e4f;
  EXPECT_FALSE(moving.move(soup.positions, soup.triangles, std::vector<KeptRun>{{0, 1, 0}})) << "far away";
}

TEST(MovingBvh, TakesATreeOfASingleLeaf) {
  Soup soup = random_soup(1);
  Bvh bvh = soup.bvh();
  MovingBvh moving(bvh.nodes, bvh.triangles);
  for (const std::uint32_t v : soup.triangles[0]) soup.positions[v].x -= 0.1f;
  const auto change = moving.move(soup.positions, soup.triangles, std::vector<KeptRun>{{0, 1, 0}});
  ASSERT_TRUE(change);
  bvh.nodes = change->nodes, bvh.triangles = change->triangles;
  EXPECT_TRUE(Walk(bvh).sees_each_triangle_once());
}

}  // namespace
}  // namespace vantage
