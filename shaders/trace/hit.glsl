// SPDX-License-Identifier: Apache-2.0
// Result of trace(), for every engine.
#ifndef VANTAGE_TRACE_HIT
#define VANTAGE_TRACE_HIT
#include "lib/parameters.glsl"

// Hit trace(origin, direction, t_min, t_max, enough, starts): the nearest hit in [t_min, t_max], defined by the
// engine's own trace.glsl. An engine may return any hit nearer than `enough`, for callers that only test for occlusion.
const float want_nearest = -1.0;

// Output of the engine's pass over tiles at the address `list`, one entry per tile, and the ray's tile. Engines without
// such a pass read neither.
struct Starts {
  uint64_t list;
  uint tile;
};
const Starts from_the_root = Starts(0ul, 0u);

struct Hit {
  float t;
  uint id;  // scene triangle with the surveyed bit; no_primitive: no hit
  vec2 barycentric;  // weights of the second and third vertex
};

#endif
