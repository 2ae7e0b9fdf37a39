// SPDX-License-Identifier: Apache-2.0
// Stations to choose from, with their coverage and overlaps: existing ones first, then candidates. More can be added.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "core/graph.hpp"
#include "site/placement_oracle.hpp"
#include "vantage/candidates.hpp"

namespace vantage {

// Traces stations one by one and returns their columns on a sample. A stopped call returns the columns of the first
// ones.
using TraceColumns = std::function<CoverageMatrix(std::span<const PlacedStation>, const Progress&)>;
// Traces on a sample of the simulator's voxels. Borrows it. `goals`: one for each voxel, instead of the simulator's.
TraceColumns columns_of(Simulator& simulator, std::uint64_t sample_voxels, std::vector<double> goals = {});
// Traces on a sample of the surroundings: the voxels that each station sees, without their density.
TraceColumns seen_columns_of(Simulator& surroundings, std::uint64_t sample_voxels);

// Distances below which one of two stations replaces the other.
struct StationSpacing {
  double nearest_m = 0;  // at any visibility
  // Returns the least distance of a station with that column from others that it sees; empty: nearest_m alone.
  std::function<double(const PlacedStation&, std::span<const CoverageMatrix::Entry>)> least_m = {};
  std::function<bool(const Vec3&, const Vec3&)> sees = {};  // true if nothing stands between two heads
};
// A quarter of the median distance from a head to the elements that its station captures to a half at least. `centres`:
// one for each element.
inline constexpr double kSpacingShare = 0.25;
double spacing_by_view(const PlacedStation& station, std::span<const CoverageMatrix::Entry> column,
                       const CoverageMatrix& matrix, std::span<const Vec3> centres);

// Returns for each pair of stations 1 if its link ties storeys past the stair, else 0.
using PastStairs = std::function<std::vector<std::uint8_t>(std::span<const PlacedStation>,
                                                           std::span<const std::pair<std::size_t, std::size_t>>)>;

// Lower bound of a share that is `share` on a sample of `size`, by so many standard errors (Wilson: Probable Inference,
// the Law of Succession, and Statistical Inference, 1927). REQUIRES: size > 0.
double least_share(double share, double size, double errors);

class CandidateTable {
 public:
  // `surroundings`: columns over all surfaces; empty if links do not matter. Stations that stand too near exclude each
  // other. `unsampled`: share of the surroundings outside the sample.
  CandidateTable(TraceColumns surveyed, TraceColumns surroundings, StationSpacing spacing, double unsampled = 1);

  // Traces stations; those with known columns only over the surroundings. False if stopped: the table then has the
  // stations that were traced in full.
  bool add(std::span<const PlacedStation> stations, const Progress& progress);
  // `column`: the first station's.
  bool add(std::span<const PlacedStation> stations, const CoverageMatrix& known, const Progress& progress,
           std::size_t column = 0);

  const std::vector<PlacedStation>& stations() const { return stations_; }
  const CoverageMatrix& matrix() const { return matrix_; }
  // Replaces sampled overlaps by lower bounds, so many standard errors below, from now on. Pairs chosen as links among
  // thousands are those that the sample overestimates.
  void take_least_overlaps(double errors);
  // Takes in overlaps between chosen stations, by every ray or a larger sample. They stay known. REQUIRES: a matrix of
  // as many stations.
  void take_in(std::span<const std::size_t> chosen, const ScanOverlapMatrix& overlap);
  // True if a pair's overlap was taken in.
  bool is_known(std::size_t i, std::size_t j) const { return known_.contains(std::minmax(i, j)); }
  // From now on, ignores links of at least `link` that tie storeys past the stair, if others connect the stations of
  // both ends. The graph has no overlap for them.
  void keep_to_stairs(PastStairs past_stairs, double link);
  void count_all_links();  // as before
  // Standard error of a sampled overlap of `share`, for the station of a network that sees the fewest sampled voxels.
  double overlap_error(std::span<const std::size_t> network, double share) const;
  // Returns the station of the table that is nearest. REQUIRES: a table with stations.
  std::size_t nearest(const PlacedStation& station) const;
  // True if no two of these stations stand too near. Each counts as the nearest one of the table.
  bool spaced(std::span<const PlacedStation> stations) const;
  // Extended by each addition.
  const StationGraph& graph() const { return graph_; }

 private:
  using Pair = std::pair<std::size_t, std::size_t>;       // the lower one first
  void lower_overlaps(std::size_t first);                 // of pairs with candidate `first` or a later one
  std::vector<Pair> links_from(std::size_t first) const;  // of the same pairs
  void bring_back_ties();
  void leave_out_ties(std::vector<Pair> further);  // and those of `further` that are some

  TraceColumns surveyed_, surroundings_;
  StationSpacing spacing_;
  double unsampled_, errors_ = 0;
  StationGraph sampled_;         // as the sample shows it; empty while errors_ is 0
  std::set<Pair> known_;         // pairs that were taken in
  PastStairs past_stairs_;       // empty: all links count
  double link_ = 0;              // least share of one that does
  std::map<Pair, float> ties_;   // past stairs, with their shares
  std::vector<double> least_m_;  // by station
  std::vector<PlacedStation> stations_;
  CoverageMatrix matrix_, around_;
  StationGraph graph_;
};

// The parts of the candidates that links of at least `least` connect.
Components linked_parts(const StationGraph& graph, double least);

// Allowed positions around each of `stations`, `each` of them within `radius_m`, spread evenly over the disc; none at a
// drop, but around a station that is.
std::vector<PlacedStation> positions_around(const PlacementOracle& site, std::span<const PlacedStation> stations,
                                            std::size_t each, double radius_m);

// Ground points of the way on foot from one ground point to another; none if nothing connects them.
using WayBetween = std::function<std::vector<Vec3>(const Vec3&, const Vec3&)>;
inline constexpr double kAlong_m = 1;  // between candidates along a way
// Allowed positions along such a way: every `apart_m`, and by both sides of each place where nobody may stand, as in a
// doorway.
std::vector<PlacedStation> positions_along(const PlacementOracle& site, std::span<const Vec3> way, double apart_m);

}  // namespace vantage
