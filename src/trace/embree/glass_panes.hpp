// SPDX-License-Identifier: Apache-2.0
// Panes of glass between a head and its hits, in double precision (docs/method.md).
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "scene/scene_data.hpp"
#include "trace/embree/hits.hpp"
#include "trace/embree/pane_view.hpp"
#include "trace/embree/planes.hpp"
#include "trace/embree/ray_caster.hpp"

namespace vantage {

// A beam on its way: the share of its strength that passes there and back, or the pane that reflects it.
struct Passed {
  double share;
  std::uint32_t pane;  // RayBundle::kNoHit: none
  float t;             // of the pane
};

// Returns the share of strength that passes a pane there and back at this cosine of incidence, by Fresnel's formulas
// for the refractive index 1.5, reflections within the pane included.
double passed_of_pane(double cosine);

// Glass of a scene. Safe to use from any thread.
class GlassPanes {
 public:
  GlassPanes(std::shared_ptr<const SceneData> scene, std::shared_ptr<const Planes> planes);

  // Follows each ray from its start to its `end`, and overwrites the ends. Returns false, and fills nothing, if no ray
  // meets glass. REQUIRES: as many elements as rays.
  bool follow(RayBundle& rays, std::span<Passed> passed) const;
  // Does the same for hits. `view`: from `origin`, or null.
  bool follow(const Float3& origin, const Hits& hits, const PaneView* view, std::span<Passed> passed) const;
  // Returns null if the glass has too many faces.
  std::unique_ptr<const PaneView> view(const Float3& origin) const;
  // Returns the share of an echo's strength that passes from `end` to `start`; 0 also if a pane reflects the beam.
  double share(const Float3& origin, const Float3& d, float start, float end) const;

 private:
  // Takes a beam of this direction through a face. `next`: distance from which faces count again.
  void pass(Passed& passed, float& next, float t, std::uint32_t triangle, const Float3& d) const;
  // Works as follow(), from each ray's start to its end. `slot`: of each ray in `passed`.
  void follow_all(const std::vector<RayCaster::Crossing>& faces, const RayBundle& rays, const std::uint32_t* slot,
                  std::span<Passed> passed) const;

  std::shared_ptr<const SceneData> scene_;
  std::shared_ptr<const Planes> planes_;
  RayCaster caster_;
  std::uint32_t first_;         // first triangle of glass
  std::vector<bool> of_solid_;  // of the triangles from there on
};

}  // namespace vantage
