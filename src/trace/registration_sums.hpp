// SPDX-License-Identifier: Apache-2.0
// Computes the sums for the registration error from station masks (docs/method.md, "Registration error").
//
// A voxel that several stations see from one side of its plane ties them together along the plane's normal. A pair's
// share is quantised to whole numbers before it is summed, so the order of summing does not matter. The vectors J are
// quantised rather than their products, so that directions which a surface leaves free stay exactly free.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include "shared/registration_types.h"
#include "trace/tracer.hpp"
#include "voxel/voxel_surfaces.hpp"

namespace vantage {

inline constexpr int kPatchUnit = 32767;
// Largest weight, of a station at a full voxel, in units of the sums.
inline constexpr float kPatchWeightUnits = 65536;

// Planes of a sample's voxels, or of all voxels.
struct Patches {
  std::vector<RegistrationPatch> patches;
  Vec3 centre;         // c: centre of the grid's cube, local frame
  double radius = 1;   // R: half the cube's diagonal, metres
  double largest = 1;  // weight, 1/m², that equals kPatchWeightUnits
  RegistrationModel model;
};

// Cube that contains voxels of one size.
struct PatchFrame {
  Vec3 centre;  // local frame
  double side_m = 1, voxel_m = 1;
};

// REQUIRES: model.rho_m > 0, model.patch_m > 0; surfaces within the cube.
Patches make_patches(std::span<const VoxelSurface> surfaces, const PatchFrame& frame, const RayPattern& pattern,
                     const RegistrationModel& model);
// Does so for voxels of the grid of `surfaces`; indices as for `SurfaceFinder::find`. Without patches if stopped early.
Patches make_patches(SurfaceFinder& surfaces, const VoxelGrid& grid, std::span<const std::uint32_t> voxel_indices,
                     const RayPattern& pattern, const RegistrationModel& model, const std::stop_token& stop = {});

// Scanner properties that the sums need.
struct PatchScanner {
  std::shared_ptr<const NoiseModel> noise;  // not enabled if ranges are exact
  float density = 1;                        // its ray density relative to the scanner for which the patches were made
  // Errors that all its scans share, one standard deviation each: radians, metres, share of the range.
  float angle = 0, offset_m = 0, scale = 0;
  float range_m = 0;  // its longest
};

// Returns the largest distance by which scanners' errors move planes, metres: the unit of such distances, which are
// rounded to a `deviation_quanta`-th. 0: no scanner states errors.
double deviation_unit(std::span<const PatchScanner> scanners);
// A scanner's errors in that unit; errors of angles are divided among the draws of directions. All 0 if it is 0.
struct DeviationErrors {
  float angle = 0, offset = 0, scale = 0;
};
DeviationErrors deviation_errors(const PatchScanner& scanner, double deviation);

// Returns the horizontal direction in which a scan begins: one face of the mirror sees the left of it, the other the
// right. A scanner that turns fully is set up in any direction, so the directions of upright scans are drawn; if they
// were equal, errors that change sign with the face would cancel between scans. A turned scanner has its own direction.
Float3 scan_start(std::uint32_t place, std::uint32_t draw);

// Request for `NetworkCounts::registration` beside the counts of a sample, with masks.
struct RegistrationJob {
  std::shared_ptr<const Patches> patches;  // planes of the sample's voxels
  std::vector<PatchScanner> scanners;      // one for each scanner that a station refers to
  bool groups = false;                     // also the sums of the sample's groups
};

// Sums over all patches, then those of each of `groups` interleaved groups. `masks`: stations that saw each patch's
// voxel, by place: word w of patch k is at w · patches.size() + k. `scanners`: one for each that a station refers to.
// Exact, so independent of order and threads. Groups of more than `mask_bits` stations have only the pairs of
// for_summed_pairs(): all pairs of hundreds of stations, twenty times, are gigabytes. REQUIRES: masks.size() ==
// patches.size() · mask_words(station_count), and no bit without a station.
std::vector<RegistrationSums> sum_patches(const Patches& patches, std::span<const PatchScanner> scanners,
                                          std::span<const TraceStation> stations, std::uint32_t station_count,
                                          std::span<const std::uint64_t> masks, std::uint32_t groups);

std::vector<RegistrationSums> sum_patches(const RegistrationJob& job, std::span<const TraceStation> stations,
                                          std::uint32_t station_count, std::span<const std::uint64_t> masks,
                                          std::uint32_t groups);
// Returns planes of `many` voxels of a grid from `first` on; null if stopped.
using PatchesFrom = std::function<std::shared_ptr<const Patches>(std::size_t first, std::size_t many)>;
// Computes the same sums over all voxels of a field, without groups, from planes of at most `part_voxels` voxels at a
// time, as planes of tens of millions of voxels take gigabytes. Empty if stopped. `counts`: of the field, with pairs.
std::optional<RegistrationSums> sum_patches(const PatchesFrom& patches_from, std::size_t part_voxels,
                                            std::span<const PatchScanner> scanners,
                                            std::span<const TraceStation> stations, const NetworkCounts& counts,
                                            const StationMasks& masks);
// Calls with(place in `pairs`) for each pair that has a sum other than 0.
void for_summed_pairs(const RegistrationSums& whole, const std::function<void(std::size_t)>& with);
// Moves sums into the counts of a network: the sums over all, then those of the groups, if any.
void take_registration(NetworkCounts& counts, std::vector<RegistrationSums> sums);

// Sets the numbers of voxels of sums over all patches, then over each of the interleaved groups.
std::vector<RegistrationSums> with_voxels(std::vector<RegistrationSums> sums, const Patches& patches);

// Number of voxels whose integer sums fit into 64 signed bits together: 2^15 of weight times 2^30 of two components of
// J.
inline constexpr std::size_t kPatchesIn64Bits = std::size_t{1} << 17;
// Converts integers summed by an engine: `sums` of each pair, of each station, and, unless `deviation` is 0, of the
// errors of each station's scanner.
RegistrationSums registration_sums(const Patches& patches, std::span<const TraceStation> stations,
                                   std::uint32_t station_count, std::span<const std::int64_t> sums, double deviation);

}  // namespace vantage
