// SPDX-License-Identifier: Apache-2.0
// Data for the sums behind the registration error (docs/method.md, "Registration error").
#ifndef VANTAGE_SHARED_REGISTRATION_TYPES_H
#define VANTAGE_SHARED_REGISTRATION_TYPES_H
#include "trace_types.h"

VANTAGE_SHARED_BEGIN

// Plane of one voxel.
struct RegistrationPatch {
  vec3 point;  // local frame
  vec3 normal;
  float rays;      // area / (Δh·Δv): rays of a free view, before distance and obliquity
  float least;     // fewest of them for a station to recognise a plane
  float variance;  // m² of the modelling error, ρ²L²/A; 0: no plane to register by
  float diffuse;
  float extent;     // surface of the voxel as a share of a face, times 2^15
  int jacobian[6];  // [(p − c)/R × n, n] · kPatchUnit
  int place[3];     // (p − c)/R · kPatchUnit
};
VANTAGE_CONST uint pair_sums = 21;     // the upper triangle, row by row, of J Jᵀ
VANTAGE_CONST uint station_sums = 10;  // moments 1, x, y, z, xx, xy, xz, yy, yz, zz
// Errors of an instrument: vertical index, collimation and trunnion axis, which change sign with the face of the
// mirror, for each of several draws of the directions in which scans begin; then offset and scale of ranges.
VANTAGE_CONST uint start_draws = 4;
VANTAGE_CONST uint angle_errors = 3;
VANTAGE_CONST uint instrument_errors = 14;
VANTAGE_CONST uint instrument_sums = 84;         // of J times each
VANTAGE_CONST float deviation_quanta = 8192.0f;  // of the unit in which moved planes are rounded
VANTAGE_CONST float least_cosine = 0.01f;        // below it, the visible side is uncertain
// Above and below the head, rays are no denser than at 3°.
VANTAGE_CONST float least_sin_zenith_squared = 0.0025f;

VANTAGE_CONST uint register_voxels = 64;  // per workgroup at a time
VANTAGE_CONST uint register_rounds = 64;
VANTAGE_CONST uint register_pairs = 128;  // per workgroup
// Sums of many networks: 64 bits each, [network][sum], pairs first.
struct RegisterPush {
  VANTAGE_ADDRESS(RegistrationPatches) patches;
  VANTAGE_ADDRESS(Uints) masks;   // [network][word][voxel]
  VANTAGE_ADDRESS(Vec3s) heads;   // [network][heads_stride], by place
  VANTAGE_ADDRESS(Vec3s) starts;  // [draw][heads_stride], by place: directions in which scans begin
  VANTAGE_ADDRESS(Uints) station_counts;
  VANTAGE_ADDRESS(Uints) sums;
  VANTAGE_ADDRESS(Floats) sigma;  // 0: ranges are exact
  uint voxel_count;
  uint mask_words;  // 1 or 2
  uint heads_stride;
  uint sums_stride;    // sums per network
  uint first_network;  // first network of the masks
  float units;         // units in which weights are rounded
  float noise_min_range;
  float noise_inverse_span;
  // Errors of the scanner, in units of the largest deviation of a plane. All 0: not summed.
  float angle;
  float offset;
  float scale;
};

VANTAGE_SHARED_END
#endif
