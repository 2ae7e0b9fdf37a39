// SPDX-License-Identifier: Apache-2.0
// From station masks to the sums that the registration error is made of (docs/method.md, "Registration error").
//
// A voxel that several stations see from one side of its plane holds them together along the plane's normal. What a
// pair gets from it is quantised to whole numbers before it is summed, so that no order of summing matters; and it is
// the vectors J that are quantised, not their products, so that what a surface leaves free stays exactly free.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "shared/registration_types.h"
#include "trace/tracer.hpp"
#include "voxel/voxel_surfaces.hpp"

namespace vantage {

inline constexpr int patch_unit = 32767;
// The largest weight, of a station at a full voxel, is so many units of what is summed.
inline constexpr float patch_weight_units = 65536;

// The planes of the voxels of a sample, or of all of them.
struct Patches {
  std::vector<RegistrationPatch> patches;
  Vec3 centre;         // c: of the grid's cube, local frame
  double radius = 1;   // R: half the cube's diagonal, metres
  double largest = 1;  // weight, 1/m², that is patch_weight_units
  RegistrationModel model;
};

// The cube that voxels of one size lie in.
struct PatchFrame {
  Vec3 centre;  // local frame
  double side_m = 1, voxel_m = 1;
};

// REQUIRES: model.rho_m > 0, model.patch_m > 0; surfaces within the cube.
Patches make_patches(std::span<const VoxelSurface> surfaces, const PatchFrame& frame, const RayPattern& pattern,
                     const RegistrationModel& model);
// Of voxels of a grid; ranks as for `voxel_surfaces`.
Patches make_patches(const SceneData& scene, const VoxelGrid& grid, std::span<const std::uint32_t> ranks,
                     const RayPattern& pattern, const RegistrationModel& model);

// A scanner as the sums need it.
struct PatchScanner {
  std::shared_ptr<const NoiseModel> noise;  // not enabled where ranges are exact
  float density = 1;                        // of its rays, to those of the scanner that the patches were made for
};

// What an engine is asked for beside the counts of a sample, with masks: `NetworkCounts::registration`.
struct RegistrationJob {
  std::shared_ptr<const Patches> patches;  // of the sample's voxels
  std::vector<PatchScanner> scanners;      // one for each that a station names
  bool groups = false;                     // those of the sample's groups too
};

// Sums over all patches, then those of each of `groups` interleaved groups. masks: of the stations that saw each
// patch's voxel, by place. `scanners`: one for each that a station names. Exact, so it depends on neither order nor
// threads. REQUIRES: masks.size() == patches.size(), and no bit that is not a station's.
std::vector<RegistrationSums> sum_patches(const Patches& patches, std::span<const PatchScanner> scanners,
                                          std::span<const TraceStation> stations, std::uint32_t station_count,
                                          std::span<const std::uint64_t> masks, std::uint32_t groups);

std::vector<RegistrationSums> sum_patches(const RegistrationJob& job, std::span<const TraceStation> stations,
                                          std::uint32_t station_count, std::span<const std::uint64_t> masks,
                                          std::uint32_t groups);
// Such sums into the counts of a network and, where there are any of them, of its groups.
void take_registration(NetworkCounts& counts, std::vector<RegistrationSums> sums);

// Voxels whose whole numbers fit in 64 bits together, signed: 2^15 of weight times 2^30 of two components of J.
inline constexpr std::size_t patches_in_64_bits = std::size_t{1} << 17;
// Of whole numbers that an engine has summed: `sums` of each pair, then of each station.
RegistrationSums registration_sums(const Patches& patches, std::span<const TraceStation> stations,
                                   std::uint32_t station_count, std::span<const std::int64_t> sums);

}  // namespace vantage
