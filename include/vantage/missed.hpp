// SPDX-License-Identifier: Apache-2.0
/// Reasons why parts of a site are not captured: those beyond any allowed position, and those that a plan left out.
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

/// Status of a surveyed voxel, the first of these that holds. Lines run from candidates' heads to the middle of the
/// voxel's surface; a line is free if nothing that stops rays stands between the
/// head and the voxel.
enum class WhyMissed : std::uint8_t {
  captured,    ///< It has the goal density.
  hidden,      ///< No line is free, whatever its length.
  far,         ///< Free lines are all longer than the scanner's range, or shorter than its nearest.
  flat,        ///< Free lines within range all meet the surface at more than `MissedOptions::flat`.
  dark,        ///< Free lines within range that are not too flat all bring echoes too weak for the scanner.
  sparse,      ///< A station on every candidate together would leave fewer points than the goal density.
  not_chosen,  ///< Other stations would have captured it.
};
inline constexpr std::size_t why_missed_count = 7;
std::string to_string(WhyMissed);

struct MissedOptions {
  /// Number of candidates from which lines are drawn: the first ones, which are spread evenly.
  std::size_t candidates = 256;
  Angle flat = Angle::degrees(80);  ///< Largest incidence, from the normal, of a surface that is not seen too flatly.
};

Settings settings(const MissedOptions& options);

/// Returns why each voxel of `ranks` is not captured by a network that left `points` in them. `sparse` uses the points
/// expected of the pattern: area · cos(incidence) / (range² · Δazimuth · Δzenith · sin zenith) for each candidate with
/// a free line in range. A cancelled call returns nothing. Throws Error invalid_argument if the spans differ in length,
/// a voxel index is too large or there are no candidates.
std::vector<WhyMissed> why_missed(const Simulator& simulator, const ClashChecker& clash,
                                  std::span<const PlacedStation> candidates, std::span<const std::uint32_t> ranks,
                                  std::span<const std::uint32_t> points, const MissedOptions& options = {},
                                  const Progress& progress = {});

/// Number of a node's voxels with each status. A voxel belongs to the mesh with most surface in it.
struct MissedShare {
  std::string node;  ///< `MeshInfo::name`; "" is the whole site.
  std::uint64_t voxels = 0;
  std::array<std::uint64_t, why_missed_count> count{};  ///< Indexed by `WhyMissed`.
  double share(WhyMissed why) const {
    return voxels > 0 ? static_cast<double>(count[static_cast<std::size_t>(why)]) / static_cast<double>(voxels) : 0;
  }
};
/// Returns the whole site first, then nodes with a voxel, in the order of their first meshes. Nodes of one name are
/// one.
std::vector<MissedShare> missed_by_node(const Simulator& simulator, std::span<const std::uint32_t> ranks,
                                        std::span<const WhyMissed> why);

/// Status of surveyed voxels under a network: of all voxels, or of a sample on a large site.
struct MissedVoxels {
  std::vector<std::uint32_t> ranks = {};   ///< Voxel indices, ascending.
  std::vector<std::uint32_t> points = {};  ///< Points of the network in each.
  std::vector<WhyMissed> why = {};
  std::vector<MissedShare> shares = {};  ///< Their `missed_by_node()`.
  std::size_t candidates = 0;            ///< Number of positions from which lines were drawn.
};
/// Judges at most 50 000 voxels of the network with voxel field `field`, enough for shares to a tenth of a percent.
/// Empty if it was stopped, or if nothing is surveyed. Throws as `why_missed`.
MissedVoxels missed_voxels(const Simulator& simulator, const SearchArea& area, const ClashChecker& clash,
                           const VoxelField& field, const MissedOptions& options = {}, const Progress& progress = {});

}  // namespace vantage
