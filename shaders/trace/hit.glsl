// SPDX-License-Identifier: Apache-2.0
// What trace() returns, whatever the engine.
#ifndef VANTAGE_TRACE_HIT
#define VANTAGE_TRACE_HIT
#include "lib/parameters.glsl"

// Hit trace(origin, direction, t_min, t_max, enough, starts): the nearest hit in [t_min, t_max], to be defined by the
// engine's own trace.glsl. An engine may return any hit nearer than `enough` where the caller only wants to know that
// there is one.
const float want_nearest = -1.0;

// What the engine's pass over tiles left at the address `list`, an entry a tile, and the ray's tile among them. Engines
// that have no such pass look at neither.
struct Starts {
  uint64_t list;
  uint tile;
};
const Starts from_the_root = Starts(0ul, 0u);

struct Hit {
  float t;
  uint id;           // scene triangle with the surveyed bit; no_primitive: nothing was hit
  vec2 barycentric;  // weights of the second and third vertex
};

#endif
