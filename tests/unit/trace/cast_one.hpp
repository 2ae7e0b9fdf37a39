// SPDX-License-Identifier: Apache-2.0
// A caster over a scene, and the hit of a single ray.
#pragma once

#include <memory>

#include "trace/embree/ray_caster.hpp"

namespace vantage::test {

inline RayCaster caster_over(const std::shared_ptr<const SceneData>& scene) {
  return {scene, std::make_shared<Planes>(scene)};
}

// The triangle hit, or kNoHit, and its distance.
inline std::uint32_t nearest_hit(const RayCaster& caster, const Float3& origin, const Float3& d, float start, float end,
                                 float& t) {
  RayBundle ray = one_ray(origin, d, start, end);
  caster.cast(ray);
  t = ray.t[0];
  return ray.primitive[0];
}

inline bool is_stopped(const RayCaster& caster, const Float3& origin, const Float3& d, float start, float end) {
  Probe probe{d, end};
  caster.any_hits(origin, start, {&probe, 1});
  return probe.hit != RayBundle::kNoHit;
}

}  // namespace vantage::test
