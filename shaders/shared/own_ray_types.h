// SPDX-License-Identifier: Apache-2.0
// A caller's own rays, and a device's answers to them.
#ifndef VANTAGE_SHARED_OWN_RAY_TYPES_H
#define VANTAGE_SHARED_OWN_RAY_TYPES_H
#include "host.h"
#include "trace_types.h"

VANTAGE_SHARED_BEGIN

// A ray in the local frame, rounded from double: 16 bytes at a time. It begins within the scene's box or just outside.
struct OwnRay {
  vec3 origin;
  float from;      // hits count beyond this distance: 0 or more; -infinity: from anywhere
  vec3 direction;  // unit
  float range;     // up to this distance, or a value below 0: one of these
};
VANTAGE_CONST float own_ray_misses = -1.0f;
VANTAGE_CONST float own_ray_open = -2.0f;  // the device must not decide it

// The question about rays, a specialization constant.
VANTAGE_CONST uint own_rays_nearest = 0;       // the triangle; no_primitive: none
VANTAGE_CONST uint own_rays_blocked = 1;       // 1 or 0
VANTAGE_CONST uint own_rays_count = 2;         // the number of triangles
VANTAGE_CONST uint open_answer = 0xFFFFFFFEu;  // float arithmetic is not certain

struct OwnRaysPush {
  VANTAGE_ADDRESS(Vec4s) rays;     // OwnRay
  VANTAGE_ADDRESS(Uints) answers;  // one each
  uint count;
  uint end;  // rays pass triangles from here on
};

VANTAGE_SHARED_END
#endif
