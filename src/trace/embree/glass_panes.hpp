// SPDX-License-Identifier: Apache-2.0
// Panes of glass between a head and its hits, in double precision (docs/method.md).
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "scene/scene_data.hpp"
#include "trace/embree/hits.hpp"
#include "trace/embree/planes.hpp"
#include "trace/embree/ray_caster.hpp"

namespace vantage {

// A beam on its way: the share of its strength that passes there and back, or the pane that returns it.
struct Passed {
  double share;
  std::uint32_t pane;  // RayBundle::no_hit: none
  float t;             // of the pane
};

// Share of the strength that passes a pane there and back at this cosine of incidence, by Fresnel's formulas for the
// refractive index 1.5, reflections within the pane included.
double passed_of_pane(double cosine);

// Glass of a scene. Safe to use from any thread.
class GlassPanes {
 public:
  GlassPanes(std::shared_ptr<const SceneData> scene, std::shared_ptr<const Planes> planes);

  // Follows each ray from its start to its `end`. Overwrites the ends. Returns false, and fills nothing, if no ray
  // meets glass. REQUIRES: as many elements as rays.
  bool follow(RayBundle& rays, std::span<Passed> passed) const;
  // The same for hits.
  bool follow(const Float3& origin, const Hits& hits, std::span<Passed> passed) const;
  // Share of the echo's strength from distance t that passes; 0 also if a pane returns the beam.
  double share(const Float3& origin, const Float3& d, float t) const;

 private:
  std::shared_ptr<const SceneData> scene_;
  std::shared_ptr<const Planes> planes_;
  RayCaster caster_;
  std::uint32_t first_;         // triangle of glass
  std::vector<bool> of_solid_;  // of the triangles from there on
};

}  // namespace vantage
