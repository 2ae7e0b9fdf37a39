// SPDX-License-Identifier: Apache-2.0
/// Why parts of a site are not captured: what no allowed position can help, and what a plan left out.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "vantage/candidates.hpp"
#include "vantage/placement.hpp"
#include "vantage/progress.hpp"
#include "vantage/settings.hpp"
#include "vantage/simulator.hpp"
#include "vantage/types.hpp"

namespace vantage {

/// What became of a surveyed voxel, the first of these that holds. Lines run from candidates' heads to the middle of
/// the voxel's surface; one is free where nothing stands between the head and the voxel.
enum class WhyMissed : std::uint8_t {
  captured,    ///< It has the goal density.
  hidden,      ///< No line is free, whatever its length.
  far,         ///< Free lines are all longer than the scanner's range, or shorter than its nearest.
  flat,        ///< Free lines within range all meet the surface at more than `MissedOptions::flat`.
  sparse,      ///< Even with a station on every candidate there would be fewer points than the goal density.
  not_chosen,  ///< Other stations would have captured it.
};
inline constexpr std::size_t why_missed_count = 6;
std::string to_string(WhyMissed);

struct MissedOptions {
  /// How many of the candidates lines are drawn from, the first ones: these are spread evenly.
  std::size_t candidates = 256;
  Angle flat = Angle::degrees(80);  ///< Incidence, from the normal, beyond which a surface counts as seen too flatly.
};

Settings settings(const MissedOptions& options);

/// Why each voxel of `ranks` is not captured, where a network left `points` in them. `sparse` goes by the points that
/// the pattern is expected to leave, area · cos(incidence) / (range² · Δazimuth · Δzenith · sin zenith) for each
/// candidate with a free line in range. A cancelled call returns nothing. Throws Error invalid_argument where the spans
/// differ in length, a rank is too large or there are no candidates.
std::vector<WhyMissed> why_missed(const Simulator& simulator, const ClashChecker& clash,
                                  std::span<const PlacedStation> candidates, std::span<const std::uint32_t> ranks,
                                  std::span<const std::uint32_t> points, const MissedOptions& options = {},
                                  const Progress& progress = {});

/// A node's voxels by what became of them. A voxel belongs to the mesh that has most surface in it.
struct MissedShare {
  std::string node;  ///< `MeshInfo::name`; "" of the whole site.
  std::uint64_t voxels = 0;
  std::array<std::uint64_t, why_missed_count> count{};  ///< By `WhyMissed`.
  double share(WhyMissed why) const {
    return voxels > 0 ? static_cast<double>(count[static_cast<std::size_t>(why)]) / static_cast<double>(voxels) : 0;
  }
};
/// The whole site first, then nodes with a voxel in the order of their first meshes; nodes of one name are one.
std::vector<MissedShare> missed_by_node(const Simulator& simulator, std::span<const std::uint32_t> ranks,
                                        std::span<const WhyMissed> why);

/// What became of surveyed voxels under a network: all of them, or of a large site a sample.
struct MissedVoxels {
  std::vector<std::uint32_t> ranks = {};   ///< Ascending.
  std::vector<std::uint32_t> points = {};  ///< That the network left in each.
  std::vector<WhyMissed> why = {};
  std::vector<MissedShare> shares = {};  ///< `missed_by_node()` of them.
  std::size_t candidates = 0;            ///< Positions that lines were drawn from.
};
/// Judges 50 000 voxels of the network whose voxel field is `field`, or as many as there are: enough for shares to a
/// tenth of a percent. Empty if it was stopped, or if nothing is surveyed. Throws as `why_missed`.
MissedVoxels missed_voxels(const Simulator& simulator, const SearchArea& area, const ClashChecker& clash,
                           const VoxelField& field, const MissedOptions& options = {}, const Progress& progress = {});

}  // namespace vantage
