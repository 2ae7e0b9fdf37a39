// SPDX-License-Identifier: Apache-2.0
// Nearest hits of bundles of rays that leave one point, by Embree.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "core/embree.hpp"
#include "scene/scene_data.hpp"

namespace vantage {

// Up to `capacity` rays with a common origin. Neighbours should have neighbouring directions.
struct RayBundle {
  static constexpr std::uint32_t capacity = 256;
  static constexpr std::uint32_t no_hit = 0xFFFFFFFFu;

  Float3 origin;
  float start = 0;  // rays start at this multiple of their direction
  std::uint32_t size = 0;
  alignas(64) float x[capacity], y[capacity], z[capacity];  // directions
  alignas(64) float end[capacity];

  alignas(64) float t[capacity];                  // out: Embree's distance of the hit
  alignas(64) std::uint32_t primitive[capacity];  // out: scene triangle, or no_hit
};

// Whether something stands in the way of a ray before `end`.
struct Probe {
  Float3 d;
  float end = 0;
  std::uint32_t hit = RayBundle::no_hit;  // out: some triangle that the ray hits on the way
};

// The triangles of a scene in Embree's tree. Safe to use from any thread.
class RayCaster {
 public:
  // Keeps a share of `scene`. Throws Error: out_of_memory, device_failure.
  explicit RayCaster(std::shared_ptr<const SceneData> scene);

  // Fills t and primitive. The hit is the least (t, primitive) over all triangles, whatever the rays beside it and
  // however far beyond the hit the ray's end lies: Embree's own choice between coincident triangles depends on the
  // order in which it visits them, so its tree is searched a little past the nearest hit, and the choice is ours.
  void cast(RayBundle& rays) const;

  // Fills `hit` of rays from one point, in any order. Faster.
  void any_hits(const Float3& origin, float start, std::span<Probe> probes) const;

 private:
  std::shared_ptr<const SceneData> scene_;
  embree::Device device_;
  embree::Scene tree_;
};

}  // namespace vantage
