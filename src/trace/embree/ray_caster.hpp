// SPDX-License-Identifier: Apache-2.0
// Nearest hits of bundles of rays, mostly from one point. Embree proposes hits; this file chooses.
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/embree.hpp"
#include "scene/scene_data.hpp"
#include "scene/scene_tree.hpp"
#include "trace/embree/planes.hpp"

namespace vantage {

// Up to `kCapacity` rays, mostly from a common origin. Neighbours should have similar directions.
struct RayBundle {
  static constexpr std::uint32_t kCapacity = 256;
  static constexpr std::uint32_t kNoHit = 0xFFFFFFFFu;

  Float3 origin;
  const Float3* origins = nullptr;  // one for each ray, in place of `origin`; slower
  float start = 0;                  // rays start at this multiple of their direction
  std::uint32_t size = 0;
  alignas(64) float x[kCapacity], y[kCapacity], z[kCapacity];  // directions
  alignas(64) float end[kCapacity];

  alignas(64) float t[kCapacity];                  // output: distance of the hit, by Planes
  alignas(64) std::uint32_t primitive[kCapacity];  // output: scene triangle, or kNoHit
};

// Returns a bundle of one ray.
inline RayBundle one_ray(const Float3& origin, const Float3& d, float start, float end) {
  RayBundle ray;
  ray.origin = origin;
  ray.start = start;
  ray.size = 1;
  ray.x[0] = d.x;
  ray.y[0] = d.y;
  ray.z[0] = d.z;
  ray.end[0] = end;
  return ray;
}

// Query for any triangle that blocks a ray before `end`.
struct Probe {
  Float3 d;
  float end = 0;
  std::uint32_t hit = RayBundle::kNoHit;  // output: any triangle that the ray hits before its end
};

// Triangles of a scene in Embree's tree. Safe to use from any thread.
class RayCaster {
 public:
  enum class Of : std::uint8_t { opaque, glass };
  // Shares ownership of `scene` and its planes. Throws Error: out_of_memory, device_failure.
  RayCaster(std::shared_ptr<const SceneData> scene, std::shared_ptr<const Planes> planes, Of of = Of::opaque);

  // Fills t and primitive. The hit is the least (t, primitive) over all triangles with start < t <= end that Embree
  // finds the ray to pass through and that the ray comes near (Planes::beside), whatever the other rays of the bundle.
  // Embree's own distance depends on the processor's maker, and its choice among coincident triangles on the order of
  // visits; neither is used. Its tree is searched by `kDoubt` past the nearest hit and past both ends.
  static constexpr float kDoubt = 0x1p-8f;
  void cast(RayBundle& rays) const;

  // A triangle that a ray passes through.
  struct Crossing {
    std::uint32_t ray;  // of the bundle
    float t;
    std::uint32_t triangle;
  };
  // Returns all crossings in order of ray, t and triangle; leaves t and primitive of the bundle unspecified. REQUIRES:
  // glass (the enumerator of Of).
  std::vector<Crossing> crossings(RayBundle& rays) const;

  // Returns a direction's component as given to Embree. Embree replaces one below 1e-18 by +1e-18 but keeps its sign;
  // such a ray, and its neighbours in a packet, then miss every box. At 1 km, a component below 1e-16 moves a point by
  // less than 1e-13 m.
  static constexpr float kLeastComponent = 1e-16f;
  static float safe(float component) { return std::abs(component) < kLeastComponent ? 0.0f : component; }

  // Fills `hit` of rays from one point, in any order. Faster than cast().
  void any_hits(const Float3& origin, float start, std::span<Probe> probes) const;

  // Data for a changed scene: the tree's numbers in it, and a tree of its new triangles.
  struct Change {
    std::shared_ptr<const SceneData> scene;
    std::vector<KeptRun> numbers;
    std::unique_ptr<const SceneTree> added;  // null: nothing is new
  };
  // Empty if so much differs from the tree's scene that a new tree would be better. REQUIRES: Of::opaque.
  std::optional<Change> prepare(std::shared_ptr<const SceneData> scene, const SceneDifference& difference) const;
  // Casts in the changed scene from then on. Removed triangles stay in the tree and stop no ray. Hits equal those of a
  // new tree, as they do not depend on the tree. REQUIRES: the planes take the scene, too.
  void take(Change change) noexcept;

 private:
  void cast(RayBundle& rays, std::vector<Crossing>* all) const;

  std::shared_ptr<const SceneData> scene_;
  std::shared_ptr<const SceneData> of_tree_;  // scene of the tree, maybe an earlier one
  std::shared_ptr<const Planes> planes_;
  embree::Device device_;
  SceneTree tree_;
  std::vector<KeptRun> numbers_;            // of the tree in scene_, if that is another than of_tree_
  std::unique_ptr<const SceneTree> added_;  // triangles that of_tree_ lacks; null: none
  bool changed_ = false;                    // triangles have the numbers of number_by_runs()
};

}  // namespace vantage
