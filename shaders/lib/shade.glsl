// SPDX-License-Identifier: Apache-2.0
// Appearance of a hit to the scanner: normal, Lambertian reflectivity, and the noise that follows (Algorithm 1).
#ifndef VANTAGE_LIB_SHADE
#define VANTAGE_LIB_SHADE
#include "lib/exact.glsl"
#include "lib/parameters.glsl"
#include "lib/philox.glsl"
#include "lib/scene_triangle.glsl"
#include "lib/sigma.glsl"

vec3 unit_or(vec3 v, vec3 otherwise) {
  const float square = exact_dot(v, v);
  if (!(square > 1e-30)) return otherwise;
  precise vec3 n = v * exact_inverse_sqrt(square);
  return n;
}

// Returns the unit normal of the triangle's plane.
vec3 flat_normal(StoredTriangle stored) {
  const Edges edges = edges_of(stored, vertices_of(stored));
  const vec3 e = edges.second, f = edges.third;
  // Scales first, so that tiny triangles do not underflow.
  precise float largest = max(max(max(abs(e.x), abs(e.y)), abs(e.z)), max(max(abs(f.x), abs(f.y)), abs(f.z)));
  precise vec3 es = e * exact_reciprocal(largest);
  precise vec3 fs = f * exact_reciprocal(largest);
  return unit_or(exact_cross(es, fs), vec3(0, 0, 1));
}

// Returns the normal at a vertex in place; 0 if the file has none.
vec3 normal_at(StoredTriangle stored, uint vertex) {
  const vec3 n = parameters.normals.at[vertex];
  if (!with_shared || stored.place == no_place) return n;
  const MeshTransform place = parameters.places.at[stored.place];
  return unit_or(turned_from_mesh(place.normal_x, place.normal_y, place.normal_z, n), vec3(0));
}

// Returns the interpolated vertex normal, or the plane's if the file has none, turned towards the scanner.
vec3 oriented_normal(StoredTriangle stored, vec2 barycentric, vec3 direction) {
  vec3 n = vec3(0);
  if (parameters.has_normals != 0u) {
    const uvec3 vertices = vertices_of(stored);
    const vec3 i = normal_at(stored, vertices.x), j = normal_at(stored, vertices.y),
               k = normal_at(stored, vertices.z);
    precise float rest = 1.0 - barycentric.x;
    precise float w = rest - barycentric.y;
    precise vec3 a = w * i;
    precise vec3 b = barycentric.x * j;
    precise vec3 c = barycentric.y * k;
    precise vec3 ab = a + b;
    precise vec3 abc = ab + c;
    n = unit_or(abc, vec3(0));
  }
  if (n == vec3(0)) n = flat_normal(stored);
  return exact_dot(n, direction) > 0.0 ? -n : n;
}

// Returns R (I · (−N)), section 3.2.
float reflectivity_of(StoredTriangle stored, vec3 normal, vec3 direction) {
  precise float r = parameters.diffuse.at[stored.surface] * -exact_dot(normal, direction);
  return clamp(r, 0.0, 1.0);
}

float normal_from_bits(uint u) {
  const uint m = u & 0x7FFFFFFFu;
  uint row = normal_octaves * normal_segments;
  precise float f = 0.0;
  if (m != 0u) {
    const uint e = uint(findMSB(m));
    const uint x = m << (31u - e);
    row = e * normal_segments + ((x >> 27) & 15u);
    f = float((x >> 3) & 0xFFFFFFu) * (1.0 / 16777216.0);
  }
  const vec4 c = parameters.normal_table.at[row];
  precise float a = c.w * f;
  precise float b = a + c.z;
  precise float d = b * f;
  precise float g = d + c.y;
  precise float h = g * f;
  precise float z = h + c.x;
  return (u & 0x80000000u) != 0u ? -z : z;
}

float sigma_at(float t, float reflectivity) {
  return sigma_in(parameters.sigma, parameters.noise_min_range, parameters.noise_inverse_span, t, reflectivity);
}

uint random_bits(uint64_t ray, uint place, uint stream) {
  return philox4x32(uvec2(parameters.seed_low, parameters.seed_high),
                    uvec4(uint(ray), uint(ray >> 32), place, stream)).x;
}

// Returns the range with noise, which depends only on seed, station, ray and hit.
float noisy_range(float t, float reflectivity, uint64_t ray, uint place) {
  precise float displacement = sigma_at(t, reflectivity) * normal_from_bits(random_bits(ray, place, noise_stream));
  precise float moved = t + displacement;
  return max(moved, 0.0);  // no scanner measures less
}

#endif
