// SPDX-License-Identifier: Apache-2.0
// From station masks to the sums that the registration error is made of (docs/method.md, "Registration error").
//
// A voxel that several stations see from one side of its plane holds them together along the plane's normal. What a
// pair gets from it is quantised to whole numbers before it is summed, so that no order of summing matters; and it is
// the vectors J that are quantised, not their products, so that what a surface leaves free stays exactly free.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "trace/tracer.hpp"
#include "voxel/voxel_surfaces.hpp"

namespace vantage {

// One voxel's plane as the sums need it.
struct Patch {
  Float3 point, normal;  // local frame; unit length
  float rays = 0;        // area / (Δh·Δv) of the first scanner: rays of a free view, but for distance and obliquity
  float least = 0;       // so many of them, or the station has too few points to tell a plane from
  float variance = 0;    // m² of the modelling error, ρ²L²/A; 0: no plane to hold anything together by
  float diffuse = 0;
  float extent = 0;                        // surface of the voxel as a share of a face, times 2^15
  std::array<std::int16_t, 6> jacobian{};  // [(p − c)/R × n, n] · patch_unit
  std::array<std::int16_t, 3> place{};     // (p − c)/R · patch_unit
};

inline constexpr int patch_unit = 32767;
// The largest weight, of a station at a full voxel, is so many units of what is summed.
inline constexpr float patch_weight_units = 65536;

// The planes of the voxels of a sample, or of all of them.
struct Patches {
  std::vector<Patch> patches;
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
  std::shared_ptr<const NoiseModel> noise = {};  // null or disabled: ranges are exact
  float density = 1;                             // of its rays, to those of the scanner that the patches were made for
};

// Sums over all patches, then those of each of `groups` interleaved groups. masks: of the stations that saw each
// patch's voxel, by place. `scanners`: one for each that a station names. Exact, so it depends on neither order nor
// threads. REQUIRES: masks.size() == patches.size(), and no bit that is not a station's.
std::vector<RegistrationSums> sum_patches(const Patches& patches, std::span<const PatchScanner> scanners,
                                          std::span<const TraceStation> stations, std::uint32_t station_count,
                                          std::span<const std::uint64_t> masks, std::uint32_t groups);

}  // namespace vantage
