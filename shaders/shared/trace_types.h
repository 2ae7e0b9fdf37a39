// SPDX-License-Identifier: Apache-2.0
// What the tracing kernels are told: one block of parameters for a scene, and a push-constant block for each kernel.
// Shaders reach every array by its address. Scalar layout; addresses come first, so that C++ and GLSL pad alike.
#ifndef VANTAGE_SHARED_TRACE_TYPES_H
#define VANTAGE_SHARED_TRACE_TYPES_H
#include "host.h"
#include "noise_types.h"
#include "voxel_types.h"

#ifdef __cplusplus
#define VANTAGE_ADDRESS(type) std::uint64_t
#else
#define VANTAGE_ADDRESS(type) type
#endif

VANTAGE_SHARED_BEGIN

VANTAGE_CONST uint surveyed_bit = 0x80000000u;  // of a scene triangle's number: its mesh is surveyed
VANTAGE_CONST uint no_primitive = 0xFFFFFFFFu;
VANTAGE_CONST uint no_rank = 0xFFFFFFFFu;

VANTAGE_CONST uint group_size = 128;       // threads of a workgroup, but where a kernel says otherwise
VANTAGE_CONST uint groups_in_row = 32768;  // of a dispatch with many groups; the rest goes to y

// A workgroup traces a block of neighbouring rays, a tile is a square of blocks.
VANTAGE_CONST uint block_columns = 16;
VANTAGE_CONST uint block_rows = 8;
VANTAGE_CONST uint tile_side = 32;
VANTAGE_CONST uint blocks_per_tile = (tile_side / block_columns) * (tile_side / block_rows);
VANTAGE_CONST uint tile_groups_y = 32768;  // tiles along y of an indirect dispatch; the rest goes to z

VANTAGE_CONST uint traversal_arrays = 3;

VANTAGE_CONST uint turned_constant = 4;  // constant_id of `turned` in lib/turn.glsl

// What a point must be to count; 0: no limit. A mesh has one of these, those that ask for the same share it.
struct PointLimits {
  float least_cosine_square;       // of the angle between ray and normal
  float largest_footprint_square;  // of the major axis of the beam on the surface, in metres squared
  float largest_sigma;             // of the range, in metres
};
// A bit for each limit that a point misses.
VANTAGE_CONST uint misses_incidence = 1;
VANTAGE_CONST uint misses_footprint = 2;
VANTAGE_CONST uint misses_noise = 4;

struct TraceParameters {
  VANTAGE_ADDRESS(Floats) sin_zenith;
  VANTAGE_ADDRESS(Floats) cos_zenith;
  VANTAGE_ADDRESS(Floats) sin_azimuth;
  VANTAGE_ADDRESS(Floats) cos_azimuth;
  VANTAGE_ADDRESS(BrickQuarters) bricks;  // VoxelBrick, 16 bytes at a time
  VANTAGE_ADDRESS(Slots) slots;
  uint64_t traversal[traversal_arrays];  // addresses of what the engine's own trace() reads; it knows what they are
  // For normals, reflectivity, noise and limits only; 0 where the run needs none.
  VANTAGE_ADDRESS(Vec3s) positions;
  VANTAGE_ADDRESS(Vec3s) normals;     // 0: geometric normals
  VANTAGE_ADDRESS(Uints) triangles;   // three vertex numbers each
  VANTAGE_ADDRESS(Uints) neighbours;  // three of each, as triangle_neighbours() has them; for watertight engines
  VANTAGE_ADDRESS(Floats) diffuse;    // per scene triangle
  VANTAGE_ADDRESS(Floats) sigma;
  VANTAGE_ADDRESS(Floats) reaches;  // of noise, as noise_reaches() has them; 0: no noise moves points
  VANTAGE_ADDRESS(Vec4s) normal_table;
  VANTAGE_ADDRESS(Uints) limits_of;  // per scene triangle: which of `limits`
  VANTAGE_ADDRESS(Limits) limits;
  uint rows;
  uint columns;
  float min_range;
  float max_range;
  vec3 voxel_min;
  float voxel_inverse_size;
  uint voxel_cells;  // along each side of the grid
  uint slot_mask;
  uint brick_count;
  float brick_size;  // metres
  vec3 bounds_min;   // of all triangles
  float noise_reach;
  vec3 bounds_max;
  float noise_min_range;
  float noise_inverse_span;
  uint seed_low;
  uint seed_high;
  float zenith_step;  // radians
  float azimuth_step;
  float first_zenith;
  float first_azimuth;
  uint has_normals;
  float exit_diameter;  // of the beam, in metres
  float divergence;     // full angle, in radians
};

// What is summed for each station, 64 bits each: points, those that count, and where points have limits those in a
// surveyed voxel that miss some, and that miss each.
VANTAGE_CONST uint counter_points = 0;
VANTAGE_CONST uint counter_counted = 1;
VANTAGE_CONST uint counter_dropped = 2;
VANTAGE_CONST uint counter_misses = 3;  // incidence, footprint, noise
VANTAGE_CONST uint station_counters = 6;

// Counts of one station.
struct CountPush {
  VANTAGE_ADDRESS(Uints) counts;
  VANTAGE_ADDRESS(Uints) masks;     // the 32-bit word that holds the station's bit, of every voxel
  VANTAGE_ADDRESS(Uints) counters;  // [station][counter]
  VANTAGE_ADDRESS(Floats) tile_far;
  VANTAGE_ADDRESS(Uints) tile_list;  // number of tiles, then the tiles
  uint64_t starts;                   // what the engine's pass left for each listed tile; 0: it has none
  vec3 origin;
  uint place;
  uint first_row;
  uint row_count;
  vec3 turn[3];  // rows of the rotation from the scanner's frame; read where the station is turned
  uint padding;
};

// Which tiles of directions see a surveyed brick, and how far the last one reaches.
struct TilePush {
  VANTAGE_ADDRESS(Uints) tile_far;  // bits of a non-negative float, which order as the float does; 0: nothing to see
  VANTAGE_ADDRESS(Uints) tile_list;
  VANTAGE_ADDRESS(Uints) dispatch;  // three words: an indirect dispatch
  VANTAGE_ADDRESS(Uints) rays;      // rays of the listed tiles are added here, 64 bits
  uint64_t starts;                  // room for what the engine's own pass leaves for each listed tile
  vec3 origin;
  uint first_row;
  uint row_count;
  vec3 turn[3];
};

struct ScanPush {
  VANTAGE_ADDRESS(Floats) range;  // an output that is not wanted has address 0
  VANTAGE_ADDRESS(Vec3s) position;
  VANTAGE_ADDRESS(Vec3s) normal;
  VANTAGE_ADDRESS(Floats) reflectivity;
  VANTAGE_ADDRESS(Uints) primitive;
  VANTAGE_ADDRESS(Vec2s) barycentric;
  VANTAGE_ADDRESS(Uints) voxel;
  vec3 origin;
  uint place;
  uint first_row;
  uint row_count;
  vec3 turn[3];
  uint padding;
};

// Keeps counts from wrapping: no count exceeds count_limit after it, and a dispatch adds less than the rest.
VANTAGE_CONST uint count_limit = 0x80000000u;
struct ClampPush {
  VANTAGE_ADDRESS(Uints) counts;
  uint voxel_count;
  uint padding;
};

// Reduction of counts and masks, of one network or many, in interleaved groups: voxel k is in group k % groups. Totals
// of group g of network n start at word (n · groups + g) · totals_stride: weight of the saturated voxels (64 bits);
// what the points of the others are worth, each times its voxel's weight (64 bits); three sums over successive voxels,
// from which the host makes Σ (r(k) − r(k−1))² of r = min(worth / goal, 1) without rounding; then seen[stations]; then
// shared[pairs]. With c = worth >> difference_shift where the voxel is not saturated: squares (64 bits) adds
// (c(k) − c(k−1))² where neither voxel is saturated and c² where one is; edge_points (64 bits) adds c where one is;
// edges counts those.
VANTAGE_CONST uint reduce_voxels = 256;  // voxels of a workgroup at a time
VANTAGE_CONST uint reduce_rounds = 16;   // at most 32
VANTAGE_CONST uint totals_saturated = 0;
VANTAGE_CONST uint totals_partial = 2;
VANTAGE_CONST uint totals_squares = 4;
VANTAGE_CONST uint totals_edge_points = 6;
VANTAGE_CONST uint totals_edges = 8;
VANTAGE_CONST uint totals_seen = 9;
struct ReducePush {
  VANTAGE_ADDRESS(Uints) counts;  // [network][voxel]
  VANTAGE_ADDRESS(Uints) masks;   // [network][word][voxel]
  VANTAGE_ADDRESS(Uints) totals;
  VANTAGE_ADDRESS(Uints) station_counts;  // per network
  VANTAGE_ADDRESS(Uints) weights;         // of voxels, a byte each; 0: all weigh 1
  VANTAGE_ADDRESS(Uints) worths;          // of a point in each voxel; 0: all are worth 1
  uint64_t goal;                          // what points are worth that saturate a voxel
  uint voxel_count;
  uint difference_shift;  // keeps the sum of squares within 64 bits
  uint mask_words;        // 0, 1 or 2
  uint groups;
  uint totals_stride;
  uint first_network;
  uint with_differences;
  uint padding;
};

// Sampled evaluation. A slot is one station of one network; a pair is a slot and a sampled voxel.
struct SampleVoxel {
  uint x, y, z;  // voxel coordinates
  uint index;    // within the sample
};
struct SampleStation {
  vec3 origin;
  uint place;
  uint network;  // within the batch
  vec3 turn[3];
};
// A pair of slot and voxel of which one ray has been traced and others may still matter.
struct SamplePair {
  uint voxel;  // within the sample
  uint slot;
  uint probe;     // the traced ray; no_ray: none was worth it
  uint blocker;   // the triangle that stopped it before the voxel; not_blocked: none did
  int window[6];  // RayWindow, in its order
};
VANTAGE_CONST uint no_ray = 0xFFFFFFFFu;
VANTAGE_CONST uint not_blocked = 0xFFFFFFFFu;
struct SampleRay {
  uint pair;
  uint ray;
};
// Part of a pair's walk. Of a long walk the first part is traced before the others are listed, which may not be needed.
struct SampleItem {
  uint pair;
  uint part;
};
VANTAGE_CONST uint sample_part = 64;  // steps
// Control words of one chunk.
VANTAGE_CONST uint control_pairs = 0;     // open when probed: where there is no room, the chunk must be cut
VANTAGE_CONST uint control_probed = 1;    // rays traced for that
VANTAGE_CONST uint control_rays = 2;      // listed at first, or wanted; likewise
VANTAGE_CONST uint control_parts = 3;     // that come later; likewise
VANTAGE_CONST uint control_sights = 4;    // pairs with such parts
VANTAGE_CONST uint control_items = 5;     // parts that are looked at
VANTAGE_CONST uint control_rest = 6;      // rays listed of these; where there is no room, they must come again
VANTAGE_CONST uint control_dispatch = 7;  // three words
VANTAGE_CONST uint control_words = 10;

// The first of a chunk's kernels.
struct SampleProbePush {
  VANTAGE_ADDRESS(SampleVoxels) voxels;
  VANTAGE_ADDRESS(SampleStations) stations;
  VANTAGE_ADDRESS(SamplePairs) pairs;  // open ones are listed here
  VANTAGE_ADDRESS(Uints) control;
  VANTAGE_ADDRESS(Uints) counts;     // [network][voxel]
  VANTAGE_ADDRESS(Uints) masks;      // [network][word][voxel]
  VANTAGE_ADDRESS(Uints) slot_rays;  // 64 bits a slot
  uint voxel_count;                  // of the sample
  uint first_voxel;
  uint end_voxel;
  uint first_slot;
  uint end_slot;
  uint mask_words;
  uint stop_at;  // points at which a voxel needs no more; 0: never
  uint probed;   // 1: these pairs have been probed before, so that what is found has been counted
  uint pair_capacity;
};
// All others.
struct SamplePush {
  VANTAGE_ADDRESS(SampleVoxels) voxels;
  VANTAGE_ADDRESS(SampleStations) stations;
  VANTAGE_ADDRESS(SamplePairs) pairs;
  VANTAGE_ADDRESS(SampleRays) rays;
  VANTAGE_ADDRESS(Uints) sights;  // pairs whose walks have more parts; as many as items
  VANTAGE_ADDRESS(SampleItems) items;
  VANTAGE_ADDRESS(Uints) control;
  VANTAGE_ADDRESS(Uints) counts;     // [network][voxel]
  VANTAGE_ADDRESS(Uints) masks;      // [network][word][voxel]
  VANTAGE_ADDRESS(Uints) slot_rays;  // 64 bits a slot
  uint voxel_count;                  // of the sample
  uint first_part;                   // of walks, those of the chunk
  uint end_part;
  uint ray_capacity;
  uint item_capacity;
  uint mask_words;
  uint stop_at;       // points at which a voxel needs no more; 0: never
  uint list;          // control_rays or control_rest
  uint first_traced;  // 1: all that is listed at first has been traced before
  uint padding;
};

// Sizes a dispatch over what control word `over` counts.
struct SampleArgumentsPush {
  VANTAGE_ADDRESS(Uints) control;
  uint over;
  uint pair_capacity;
  uint ray_capacity;
  uint item_capacity;
};

VANTAGE_SHARED_END
#endif
