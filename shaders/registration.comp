// SPDX-License-Identifier: Apache-2.0
// Reduces station masks to the sums for the registration error, as src/trace/registration_sums.cpp does: with the same
// roundings in the same order up to integers, whose sum does not depend on the order.
//
// A workgroup processes register_voxels voxels of one network at a time. First its threads compute the weight of each
// station at each voxel; then each thread sums one pair of stations over them, in its own registers.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/references.glsl"
#include "lib/exact.glsl"
#include "lib/sigma.glsl"

layout(buffer_reference) buffer RegistrationPatches;
#include "shared/registration_types.h"
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer RegistrationPatches {
  RegistrationPatch at[];
};

layout(local_size_x = register_pairs) in;
layout(push_constant, scalar) uniform Push { RegisterPush push; };

const uint stations_at_most = 64u;

shared uint masks[2u * register_voxels];
shared float weights[register_voxels * stations_at_most];  // 1/s²; below 0 if the plane is seen from behind
shared float scales[2u * register_voxels];  // units / Σ w of each side
shared int products[register_voxels * pair_sums];
shared int surface[register_voxels * 4u];  // weight and place
shared float means[2u * register_voxels * instrument_errors];  // means over stations of a plane's movement by errors
shared uint any_seen;

// Returns 1/s² of docs/method.md; 0 if the plane is seen too obliquely, or with too few points.
float weight_of(RegistrationPatch plane, vec3 head) {
  precise float x = head.x - plane.point.x;
  precise float y = head.y - plane.point.y;
  precise float z = head.z - plane.point.z;
  precise float xx = x * x;
  precise float yy = y * y;
  precise float zz = z * z;
  precise float level = xx + yy;
  precise float sum = level + zz;
  precise float square = max(sum, 1e-6);
  precise float inverse = exact_inverse_sqrt(square);
  precise float nx = plane.normal.x * x;
  precise float ny = plane.normal.y * y;
  precise float nz = plane.normal.z * z;
  precise float nxy = nx + ny;
  precise float along_normal = nxy + nz;
  precise float facing = along_normal * inverse;
  precise float cosine = abs(facing);
  if (cosine < least_cosine) return 0.0;
  precise float inverse_square = inverse * inverse;
  precise float steep = level * inverse_square;
  precise float flatness = max(steep, least_sin_zenith_squared);
  precise float seen = plane.rays * cosine;
  precise float density = seen * inverse_square;
  precise float expected = density * exact_inverse_sqrt(flatness);
  if (expected < plane.least) return 0.0;
  precise float variance = plane.variance;
  if (uint64_t(push.sigma) != 0ul) {
    precise float points = max(expected, 1.0);
    precise float range = square * inverse;
    precise float reflected = plane.diffuse * cosine;
    const float sigma = sigma_in(push.sigma, push.noise_min_range, push.noise_inverse_span, range, reflected);
    precise float along = sigma * cosine;
    precise float squared = along * along;
    precise float of_mean = squared * exact_reciprocal(points);
    variance = variance + of_mean;
  }
  precise float weight = exact_reciprocal(variance);
  return facing < 0.0 ? -weight : weight;
}

// Returns the distance along the normal by which an error moves a plane, in units of the largest deviation.
float deviation_of(RegistrationPatch plane, vec3 head, uint place, uint error) {
  precise float x = head.x - plane.point.x;
  precise float y = head.y - plane.point.y;
  precise float z = head.z - plane.point.z;
  precise float xx = x * x;
  precise float yy = y * y;
  precise float zz = z * z;
  precise float level = xx + yy;
  precise float sum = level + zz;
  precise float square = max(sum, 1e-6);
  precise float nx = plane.normal.x * x;
  precise float ny = plane.normal.y * y;
  precise float nz = plane.normal.z * z;
  precise float nxy = nx + ny;
  precise float along = nxy + nz;
  precise float moved;
  if (error == start_draws * angle_errors + 1u) {
    moved = along * push.scale;
  } else if (error == start_draws * angle_errors) {
    precise float facing = along * exact_inverse_sqrt(square);
    moved = facing * push.offset;
  } else {
    precise float least_level = square * least_sin_zenith_squared;
    precise float inverse_level = exact_inverse_sqrt(max(level, least_level));
    const vec3 start = push.starts.at[error / angle_errors * push.heads_stride + place];
    const uint kind = error % angle_errors;
    precise float begun_y = start.x * y;
    precise float begun_x = start.y * x;
    precise float side = begun_y - begun_x;
    const float angle = side < 0.0 ? -push.angle : push.angle;
    if (kind == 0u) {
      precise float lifted = z * along;
      precise float sunk = square * plane.normal.z;
      precise float difference = lifted - sunk;
      precise float upwards = difference * inverse_level;
      moved = upwards * angle;
    } else {
      precise float across_x = plane.normal.y * x;
      precise float across_y = plane.normal.x * y;
      precise float across = across_x - across_y;
      precise float sideways = across * inverse_level;
      precise float range = square * exact_inverse_sqrt(square);
      precise float by = (kind == 1u ? range : z) * sideways;
      moved = by * angle;
    }
  }
  return min(max(moved, -1.0), 1.0);
}

// Adds to a 64-bit sum, low word first.
void add_wide(uint at, int64_t value) {
  if (value == 0l) return;
  add64(push.sums, at, uint(value & 0xFFFFFFFFl));
  const uint high = uint(value >> 32 & 0xFFFFFFFFl);
  if (high != 0u) atomicAdd(push.sums.at[at + 1u], high);
}

bool sees(uint voxel, uint station) { return (masks[2u * voxel + station / 32u] >> (station & 31u) & 1u) != 0u; }

void main() {
  const uint thread = gl_LocalInvocationIndex;
  const uint network = push.first_network + gl_WorkGroupID.z;
  const uint n = push.station_counts.at[network];
  const uint pairs = n * (n - 1u) / 2u;
  const uint first_pair = gl_WorkGroupID.y * register_pairs;
  const bool instrument = push.angle > 0.0 || push.offset > 0.0 || push.scale > 0.0;
  const uint errors = instrument ? instrument_errors * n : 0u;
  if (first_pair >= max(pairs, errors) && gl_WorkGroupID.y > 0u) return;
  const uint pairs_here = first_pair < pairs ? min(pairs - first_pair, register_pairs) : 0u;
  // With fewer pairs than threads, several threads share a pair's voxels.
  const uint pair = pairs_here > 0u ? first_pair + thread % pairs_here : 0u;
  const uint pair_slices = pairs_here > 0u ? register_pairs / pairs_here : 0u;
  const uint pair_slice = pairs_here > 0u ? thread / pairs_here : 0u;
  uint i = 0u, rest = pair;
  while (i + 2u < n && rest >= n - 1u - i) {
    rest -= n - 1u - i;
    ++i;
  }
  const uint j = i + 1u + rest;
  const uint station = thread % n, station_slices = register_pairs / n, station_slice = thread / n;
  // Stations times errors are shared in the same way.
  const uint errors_here = first_pair < errors ? min(errors - first_pair, register_pairs) : 0u;
  const uint error_slices = errors_here > 0u ? register_pairs / errors_here : 0u;
  const uint error_slice = errors_here > 0u ? thread / errors_here : 0u;
  const uint erring = errors_here > 0u ? (first_pair + thread % errors_here) / instrument_errors : 0u;
  const uint error = errors_here > 0u ? (first_pair + thread % errors_here) % instrument_errors : 0u;
  int64_t deviations[6] = {0l, 0l, 0l, 0l, 0l, 0l};
  int64_t sums[pair_sums], moments[station_sums];
  for (uint k = 0u; k < pair_sums; ++k) sums[k] = 0l;
  for (uint k = 0u; k < station_sums; ++k) moments[k] = 0l;

  const uint base = gl_WorkGroupID.z * push.voxel_count * push.mask_words;
  for (uint round = 0u; round < register_rounds; ++round) {
    const uint first = (gl_WorkGroupID.x * register_rounds + round) * register_voxels;
    if (first >= push.voxel_count) break;  // uniform over all threads
    barrier();
    if (thread == 0u) any_seen = 0u;
    barrier();
    if (thread < register_voxels) {
      const uint voxel = first + thread;
      const bool inside = voxel < push.voxel_count;
      const uint low = inside ? push.masks.at[base + voxel] : 0u;
      const uint high = inside && push.mask_words > 1u ? push.masks.at[base + push.voxel_count + voxel] : 0u;
      masks[2u * thread] = low;
      masks[2u * thread + 1u] = high;
      const uint seen = bitCount(low) + bitCount(high);
      if (seen > 0u) {
        atomicOr(any_seen, 1u);
        const RegistrationPatch plane = push.patches.at[voxel];
        precise float part = plane.extent * exact_reciprocal(float(seen));
        precise float rounded = part + 0.5;
        surface[4u * thread] = int(rounded);
        for (uint k = 0u; k < 3u; ++k) surface[4u * thread + 1u + k] = plane.place[k];
        uint m = thread * pair_sums;
        for (uint a = 0u; a < 6u; ++a)
          for (uint b = a; b < 6u; ++b) products[m++] = plane.jacobian[a] * plane.jacobian[b];
      }
    }
    barrier();
    if (any_seen == 0u) continue;  // uniform, too
    for (uint task = thread; task < register_voxels * n; task += register_pairs) {
      const uint v = task / n, s = task % n;
      float weight = 0.0;
      if (sees(v, s)) {
        const RegistrationPatch plane = push.patches.at[first + v];
        if (plane.variance > 0.0) weight = weight_of(plane, push.heads.at[network * push.heads_stride + s]);
      }
      weights[v * n + s] = weight;
    }
    barrier();
    if (thread < register_voxels) {
      precise float front = 0.0;
      precise float behind = 0.0;
      if ((masks[2u * thread] | masks[2u * thread + 1u]) != 0u)
        for (uint s = 0u; s < n; ++s) {
          const float weight = weights[thread * n + s];
          if (weight > 0.0) front = front + weight;
          if (weight < 0.0) behind = behind - weight;
        }
      precise float front_scale = front > 0.0 ? push.units * exact_reciprocal(front) : 0.0;
      precise float behind_scale = behind > 0.0 ? push.units * exact_reciprocal(behind) : 0.0;
      scales[2u * thread] = front_scale;
      scales[2u * thread + 1u] = behind_scale;
    }
    if (errors_here > 0u)  // uniform
      for (uint task = thread; task < register_voxels * instrument_errors; task += register_pairs) {
        const uint v = task / instrument_errors, e = task % instrument_errors;
        precise float front = 0.0;
        precise float behind = 0.0;
        precise float front_total = 0.0;
        precise float behind_total = 0.0;
        uvec2 many = uvec2(0u);
        vec2 last = vec2(0.0);
        if ((masks[2u * v] | masks[2u * v + 1u]) != 0u) {
          const RegistrationPatch plane = push.patches.at[first + v];
          for (uint s = 0u; s < n; ++s) {
            const float weight = weights[v * n + s];
            if (weight == 0.0) continue;
            const float moved = deviation_of(plane, push.heads.at[network * push.heads_stride + s], s, e);
            precise float weighted = abs(weight) * moved;
            if (weight > 0.0) {
              front = front + weighted;
              front_total = front_total + weight;
              ++many.x, last.x = moved;
            } else {
              behind = behind + weighted;
              behind_total = behind_total - weight;
              ++many.y, last.y = moved;
            }
          }
        }
        precise float front_mean = front * exact_reciprocal(front_total);
        precise float behind_mean = behind * exact_reciprocal(behind_total);
        // A single station is tied to none; its difference is exactly 0.
        means[2u * task] = many.x > 1u ? front_mean : last.x;
        means[2u * task + 1u] = many.y > 1u ? behind_mean : last.y;
      }
    barrier();
    if (error_slice < error_slices)
      for (uint v = error_slice; v < register_voxels; v += error_slices) {
        if (!sees(v, erring)) continue;
        const float weight = weights[v * n + erring];
        if (weight == 0.0) continue;
        const RegistrationPatch plane = push.patches.at[first + v];
        const float moved = deviation_of(plane, push.heads.at[network * push.heads_stride + erring], erring, error);
        precise float apart = moved - means[2u * (v * instrument_errors + error) + (weight < 0.0 ? 1u : 0u)];
        precise float scaled = abs(weight) * push.units;
        precise float share = scaled * apart;
        precise float quanta = share * deviation_quanta;
        precise float rounded = quanta + 0.5;
        const int64_t whole = int64_t(int(floor(rounded)));
        for (uint c = 0u; c < 6u; ++c) deviations[c] += whole * int64_t(plane.jacobian[c]);
      }
    if (pair_slice < pair_slices)
      for (uint v = pair_slice; v < register_voxels; v += pair_slices) {
        if (!sees(v, i) || !sees(v, j)) continue;
        const float a = weights[v * n + i], b = weights[v * n + j];
        if (!(a > 0.0 && b > 0.0) && !(a < 0.0 && b < 0.0)) continue;
        precise float scaled = abs(a) * scales[2u * v + (a < 0.0 ? 1u : 0u)];
        precise float both = scaled * abs(b);
        precise float rounded = both + 0.5;
        const int64_t shared_weight = int64_t(int(rounded));
        for (uint k = 0u; k < pair_sums; ++k) sums[k] += shared_weight * int64_t(products[v * pair_sums + k]);
      }
    if (gl_WorkGroupID.y == 0u && station_slice < station_slices)
      for (uint v = station_slice; v < register_voxels; v += station_slices) {
        if (!sees(v, station)) continue;
        const int64_t weight = int64_t(surface[4u * v]);
        const int x = surface[4u * v + 1u], y = surface[4u * v + 2u], z = surface[4u * v + 3u];
        moments[0] += weight;
        moments[1] += weight * int64_t(x);
        moments[2] += weight * int64_t(y);
        moments[3] += weight * int64_t(z);
        moments[4] += weight * int64_t(x * x);
        moments[5] += weight * int64_t(x * y);
        moments[6] += weight * int64_t(x * z);
        moments[7] += weight * int64_t(y * y);
        moments[8] += weight * int64_t(y * z);
        moments[9] += weight * int64_t(z * z);
      }
  }

  const uint of_network = 2u * network * push.sums_stride;
  if (pair_slice < pair_slices)
    for (uint k = 0u; k < pair_sums; ++k) add_wide(of_network + 2u * (pair * pair_sums + k), sums[k]);
  if (gl_WorkGroupID.y == 0u && station_slice < station_slices)
    for (uint k = 0u; k < station_sums; ++k)
      add_wide(of_network + 2u * (pairs * pair_sums + station * station_sums + k), moments[k]);
  if (error_slice < error_slices)
    for (uint c = 0u; c < 6u; ++c)
      add_wide(of_network + 2u * (pairs * pair_sums + n * station_sums + erring * instrument_sums +
                                  c * instrument_errors + error), deviations[c]);
}
