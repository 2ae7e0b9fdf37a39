// SPDX-License-Identifier: Apache-2.0
/// Reasons why parts of a site are not captured: those beyond any allowed position, and those that a plan left out.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "vantage/candidates.hpp"
#include "vantage/placement.hpp"
#include "vantage/progress.hpp"
#include "vantage/simulator.hpp"
#include "vantage/site.hpp"
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
  sparse,      ///< No single candidate's station would leave as many points as the goal density.
  not_chosen,  ///< One other station would have captured it.
};
inline constexpr std::size_t why_missed_count = 7;  ///< Number of `WhyMissed` values.
/// "captured", "hidden", "out_of_range", "too_flat", "too_dark", "too_sparse", "not_chosen"
std::string to_string(WhyMissed);

/// Lines that the reasons are found by.
struct MissedOptions {
  /// Number of candidates from which lines are drawn: the first ones, which are spread evenly.
  std::size_t candidates = 256;
  Angle flat = Angle::degrees(80);  ///< Largest incidence, from the normal, of a surface that is not seen too flatly.
};

/// Status of one voxel, with shares of its goal density in [0, 1].
struct VoxelStatus {
  WhyMissed why = WhyMissed::captured;  ///< Its status.
  float captured = 0;                   ///< Share by the network.
  float attainable = 0;                 ///< Share by the best single candidate, or `captured` if that is more.
};

/// Shares of a node's goal points, which add up to 1: `captured` is the node's coverage, `not_chosen` what other
/// stations would add to it, and the other reasons share what is beyond every station. A voxel belongs to the mesh with
/// most surface in it, and counts by its weight, as in coverage.
struct MissedShare {
  std::string node;                               ///< `MeshInfo::name`; "" is the whole site.
  std::uint64_t voxels = 0;                       ///< Judged voxels of the node.
  std::array<double, why_missed_count> shares{};  ///< Indexed by `WhyMissed`.
  double share(WhyMissed why) const { return shares[static_cast<std::size_t>(why)]; }  ///< One of `shares`.
};

/// A room, with what a network captures of it and where one can stand in it.
struct RoomShare {
  MissedShare share = {};  ///< Shares of the voxels in the room or at its boundary; its node is the room's name.
  double ground_m2 = 0;    ///< Area of the search area in it.
  std::optional<LeftOutReason> left_out = {};  ///< Why one cannot stand on most of its floor, if any; `sealed` first.
};
/// Why a room has no station, in words.
std::string why_no_station(const RoomShare& room);
/// Active stations in each room, by where they stand.
std::vector<std::vector<std::size_t>> stations_in_rooms(std::span<const Room> rooms,
                                                        std::span<const PlacedStation> stations);

/// Status of surveyed voxels under a network: of all voxels, or of a sample on a large site.
struct MissedVoxels {
  std::vector<std::uint32_t> voxels = {};  ///< Voxel indices, ascending; the next two have an element for each.
  std::vector<std::uint32_t> points = {};  ///< Points of the network in each.
  std::vector<VoxelStatus> status = {};    ///< Status of each.
  /// The whole site first, then nodes with a voxel, in the order of their first meshes. Nodes of one name are one. The
  /// whole site's captured share is its coverage, from all voxels; the sample splits the rest.
  std::vector<MissedShare> shares = {};
  std::vector<RoomShare> rooms = {};  ///< One for each of the scene's rooms, from the same sample.
  std::size_t candidates = 0;         ///< Number of positions from which lines were drawn.
};
/// Judges at most 50 000 voxels of the network with voxel field `field`, enough for shares to a tenth of a percent.
/// `sparse` uses the points expected of the pattern: area · cos(incidence) / (range² · Δazimuth · Δzenith · sin zenith)
/// for each candidate with a free line in range. Empty if it was stopped, or if nothing is surveyed. Throws Error
/// invalid_argument if no position is allowed.
MissedVoxels missed_voxels(Site& site, const VoxelField& field, const MissedOptions& options = {},
                           const Progress& progress = {});

}  // namespace vantage
