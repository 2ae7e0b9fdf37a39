// SPDX-License-Identifier: Apache-2.0
// Input of the tracing kernels: one parameter block per scene, and a push-constant block per kernel. Shaders access
// every array by its address. Scalar layout; addresses come first, so that C++ and GLSL pad alike.
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

VANTAGE_CONST uint surveyed_bit = 0x80000000u;  // bit of a scene triangle's number: its mesh is surveyed
VANTAGE_CONST uint no_primitive = 0xFFFFFFFFu;
VANTAGE_CONST uint no_voxel_index = 0xFFFFFFFFu;

VANTAGE_CONST uint group_size = 128;       // threads of a workgroup, unless a kernel says otherwise
VANTAGE_CONST uint groups_in_row = 32768;  // of a dispatch with many groups; the rest goes to y

// A workgroup traces a block of neighbouring rays; a tile is a square of blocks.
VANTAGE_CONST uint block_columns = 16;
VANTAGE_CONST uint block_rows = 8;
VANTAGE_CONST uint tile_side = 32;
VANTAGE_CONST uint blocks_per_tile = (tile_side / block_columns) * (tile_side / block_rows);
VANTAGE_CONST uint tile_groups_y = 32768;  // tiles along y of an indirect dispatch; the rest goes to z

VANTAGE_CONST uint traversal_arrays = 3;

VANTAGE_CONST uint turned_constant = 4;  // constant_id of `turned` in lib/turn.glsl
VANTAGE_CONST uint glass_constant = 5;   // of `with_glass` in lib/glass.glsl
VANTAGE_CONST uint shared_constant = 6;  // of `with_shared` in lib/scene_triangle.glsl
VANTAGE_CONST uint listed_constant = 7;  // of `listed` in lib/list.glsl

// Glass (docs/method.md). A pane reflects the beam at up to 1° from its normal: the square of that cosine. A beam with
// a smaller share left is lost. Faces nearer together than the sum of two gaps, one of them a share of the distance,
// count as one, as do triangles on both sides of an edge. A pane this near to the surface behind it does not count.
VANTAGE_CONST float pane_return_square = 0.9996954f;
VANTAGE_CONST float least_passed = 1e-6f;
VANTAGE_CONST float face_gap_share = 3.8146973e-6f;  // 2^-18
VANTAGE_CONST float face_gap_m = 1e-4f;

// Limits that a point must meet to count; 0: no limit. Each mesh has one entry; equal ones are shared.
struct PointLimits {
  float least_cosine_square;       // angle between ray and normal
  float largest_footprint_square;  // major axis of the beam on the surface, in metres squared
  float largest_sigma;             // range, in metres
  float largest_reach_square;      // distance of the weakest echo at normal incidence, in metres squared
};
// One bit for each limit that a point misses.
VANTAGE_CONST uint misses_incidence = 1;
VANTAGE_CONST uint misses_footprint = 2;
VANTAGE_CONST uint misses_noise = 4;
VANTAGE_CONST uint misses_echo = 8;

// Scenes whose nodes share meshes (scene/scene_data.hpp). A run of triangles that are stored elsewhere than their
// numbers say.
VANTAGE_CONST uint no_place = 0xFFFFFFFFu;
VANTAGE_CONST uint run_block_bits = 10;
struct TriangleRun {
  uint first_triangle;
  uint to_stored;  // added to a triangle's number, modulo 2^32, gives its stored number
  uint place;      // index into `places`; no_place: stored in place
};
struct MeshTransform {
  vec3 x, y, z, origin;               // columns of local_from_mesh
  vec3 normal_x, normal_y, normal_z;  // of the map of normals, up to a positive length
  float doubt;  // largest shift of the mesh by rounding, for a ray: a share of `size` and the distance of its origin
  float size;   // metres
  uint mirrored;
};

struct TraceParameters {
  VANTAGE_ADDRESS(Floats) sin_zenith;
  VANTAGE_ADDRESS(Floats) cos_zenith;
  VANTAGE_ADDRESS(Floats) sin_azimuth;
  VANTAGE_ADDRESS(Floats) cos_azimuth;
  // A list has one row for each ray; these arrays find its rays, as DirectionList does.
  VANTAGE_ADDRESS(Uints) list_rays;       // by band of zenith, then by azimuth
  VANTAGE_ADDRESS(Floats) list_azimuths;  // of these, in a full turn from 0
  VANTAGE_ADDRESS(Uints) list_offsets;    // of each band in them, and an end
  VANTAGE_ADDRESS(BrickQuarters) bricks;  // VoxelBrick, 16 bytes at a time
  VANTAGE_ADDRESS(Slots) slots;
  uint64_t traversal[traversal_arrays];  // addresses of the inputs of the engine's own trace()
  // For normals, reflectivity, noise and limits only; 0 if unused.
  VANTAGE_ADDRESS(Vec3s) positions;
  VANTAGE_ADDRESS(Vec3s) normals;     // 0: geometric normals
  VANTAGE_ADDRESS(Uints) triangles;   // three vertex numbers each
  VANTAGE_ADDRESS(Uints) neighbours;  // three per triangle, by triangle_neighbours(); for watertight engines
  VANTAGE_ADDRESS(Floats) diffuse;    // per scene triangle, or per run if meshes are shared
  VANTAGE_ADDRESS(Floats) sigma;
  VANTAGE_ADDRESS(Floats) reaches;  // reach of noise, by noise_reaches(); 0: noise moves no points
  VANTAGE_ADDRESS(Vec4s) normal_table;
  VANTAGE_ADDRESS(Uints) limits_of;  // per scene triangle, or per run: index into `limits`
  VANTAGE_ADDRESS(Limits) limits;
  // Tree of the triangles of glass, BvhNode and BvhTriangle; the surveyed bit of an id marks a face of a solid. 0: no
  // glass weakens echoes.
  uint64_t glass_nodes;
  uint64_t glass_corners;
  // Only if meshes are shared.
  VANTAGE_ADDRESS(TriangleRuns) runs;  // ascending, and an end
  VANTAGE_ADDRESS(Uints) run_at;       // the run of every 2^run_block_bits-th triangle
  VANTAGE_ADDRESS(MeshTransforms) places;
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
  float zenith_step;  // radians; 0: rows are not all one step apart; of a list: between its bands
  float azimuth_step;
  float first_zenith;
  float first_azimuth;
  uint has_normals;
  float exit_diameter;  // of the beam, in metres
  float divergence;     // full angle, in radians
  uint lost_below;      // limit of dropout_stream (noise_types.h)
  uint list_bands;
};

// Sums per station, 64 bits each: all points; points that count; and, if points have limits, those in a surveyed voxel
// that miss any limit, then those that miss each limit.
VANTAGE_CONST uint counter_points = 0;
VANTAGE_CONST uint counter_counted = 1;
VANTAGE_CONST uint counter_dropped = 2;
VANTAGE_CONST uint counter_misses = 3;  // incidence, footprint, noise, echo
VANTAGE_CONST uint station_counters = 7;

// Counts of one station.
struct CountPush {
  VANTAGE_ADDRESS(Uints) counts;
  VANTAGE_ADDRESS(Uints) masks;     // the 32-bit word that holds the station's bit, of every voxel
  VANTAGE_ADDRESS(Uints) counters;  // [station][counter]
  VANTAGE_ADDRESS(Floats) tile_far;
  VANTAGE_ADDRESS(Uints) tile_list;  // number of tiles, then the tiles
  uint64_t starts;                   // output of the engine's pass for each listed tile; 0: no such pass
  vec3 origin;
  uint place;
  uint first_row;
  uint row_count;
  vec3 turn[3];  // rows of the rotation from the scanner's frame; read if the station is turned
  uint padding;
};

// Finds the tiles of directions that see a surveyed brick, and the distance of each tile's farthest one.
struct TilePush {
  VANTAGE_ADDRESS(Uints) tile_far;  // bits of a non-negative float, which are ordered as the float; 0: nothing to
                                    // see
  VANTAGE_ADDRESS(Uints) tile_list;
  VANTAGE_ADDRESS(Uints) dispatch;  // three words: an indirect dispatch
  VANTAGE_ADDRESS(Uints) rays;      // receives the rays of the listed tiles, 64 bits
  uint64_t starts;                  // room for the output of the engine's own pass for each listed tile
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

// Keeps counts from wrapping: afterwards no count exceeds count_limit, and a dispatch adds less than the remaining
// range.
VANTAGE_CONST uint count_limit = 0x80000000u;
struct ClampPush {
  VANTAGE_ADDRESS(Uints) counts;
  uint voxel_count;
  uint padding;
};

// Reduction of counts and masks, of one network or many, in interleaved groups: voxel k is in group k % groups. Totals
// of group g of network n start at word (n · groups + g) · totals_stride:
// - weight of the saturated voxels (64 bits);
// - points of the others, each times its voxel's weight and point weight (64 bits);
// - three sums over successive voxels, from which the host computes Σ (r(k) − r(k−1))² without rounding,
//   with r = min(weighted points / goal, 1);
// - seen[stations], then shared[pairs].
// The three sums use c = weighted points >> difference_shift for a voxel that is not saturated. squares (64 bits) adds
// (c(k) − c(k−1))² if neither voxel is saturated and c² if one is; edge_points (64 bits) adds c if one is; edges
// counts such pairs.
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
  VANTAGE_ADDRESS(Uints) weights;         // of voxels, one byte each; 0: all weigh 1
  VANTAGE_ADDRESS(Uints) point_weights;   // point weight in each voxel; 0: all are 1
  uint64_t goal;                          // sum of point weights that saturates a voxel
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
// A pair of slot and voxel that is still open after its first ray.
struct SamplePair {
  uint voxel;  // within the sample
  uint slot;
  uint probe;     // the traced ray; no_ray: none was worth tracing
  uint occluder;  // the triangle that stopped it before the voxel; or not_occluded
  int window[6];  // RayWindow, in its order
};
VANTAGE_CONST uint no_ray = 0xFFFFFFFFu;
VANTAGE_CONST uint not_occluded = 0xFFFFFFFFu;
struct SampleRay {
  uint pair;
  uint ray;
};
// Part of a pair's walk. The first part of a long walk is traced before the other parts are listed, as they may not be
// needed.
struct SampleItem {
  uint pair;
  uint part;
};
VANTAGE_CONST uint sample_part = 64;  // steps
// Control words of one chunk.
VANTAGE_CONST uint control_pairs = 0;     // open after the probe; if there is no room, the chunk must be cut
VANTAGE_CONST uint control_probed = 1;    // rays traced by the probe
VANTAGE_CONST uint control_rays = 2;      // listed at first, or wanted; cut if there is no room
VANTAGE_CONST uint control_parts = 3;     // to be listed later; cut if there is no room
VANTAGE_CONST uint control_sights = 4;    // pairs with such parts
VANTAGE_CONST uint control_items = 5;     // parts in work
VANTAGE_CONST uint control_rest = 6;      // rays listed for them; if there is no room, they must be repeated
VANTAGE_CONST uint control_dispatch = 7;  // three words
VANTAGE_CONST uint control_words = 10;

// Input of the first of a chunk's kernels.
struct SampleProbePush {
  VANTAGE_ADDRESS(SampleVoxels) voxels;
  VANTAGE_ADDRESS(SampleStations) stations;
  VANTAGE_ADDRESS(SamplePairs) pairs;  // receives the open pairs
  VANTAGE_ADDRESS(Uints) control;
  VANTAGE_ADDRESS(Uints) counts;     // [network][voxel]
  VANTAGE_ADDRESS(Uints) masks;      // [network][word][voxel]
  VANTAGE_ADDRESS(Uints) slot_rays;  // 64 bits per slot
  uint voxel_count;                  // of the sample
  uint first_voxel;
  uint end_voxel;
  uint first_slot;
  uint end_slot;
  uint mask_words;
  uint stop_at;  // points at which a voxel needs no more; 0: never
  uint probed;   // 1: these pairs were probed before, so their results are already counted
  uint pair_capacity;
};
// Input of the other kernels of a chunk.
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
  VANTAGE_ADDRESS(Uints) slot_rays;  // 64 bits per slot
  uint voxel_count;                  // of the sample
  uint first_part;                   // part of walks covered by the chunk
  uint end_part;
  uint ray_capacity;
  uint item_capacity;
  uint mask_words;
  uint stop_at;       // points at which a voxel needs no more; 0: never
  uint list;          // control_rays or control_rest
  uint first_traced;  // 1: everything listed at first was traced before
  uint padding;
};

// Sizes a dispatch from control word `over`.
struct SampleArgumentsPush {
  VANTAGE_ADDRESS(Uints) control;
  uint over;
  uint pair_capacity;
  uint ray_capacity;
  uint item_capacity;
};

VANTAGE_SHARED_END
#endif
