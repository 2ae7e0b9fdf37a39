// SPDX-License-Identifier: Apache-2.0
// What trace() returns, whatever the engine.
#ifndef VANTAGE_TRACE_HIT
#define VANTAGE_TRACE_HIT
#include "lib/parameters.glsl"

// Hit trace(origin, direction, t_min, t_max, enough): the nearest hit in [t_min, t_max]. An engine may return any hit nearer than
// `enough` where the caller only wants to know that there is one.
const float want_nearest = -1.0;

struct Hit {
  float t;
  uint id;           // scene triangle with the surveyed bit; no_primitive: nothing was hit
  vec2 barycentric;  // weights of the second and third vertex
};

#endif
