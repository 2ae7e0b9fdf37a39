// SPDX-License-Identifier: Apache-2.0
// Stations to choose among, and what each captures and shares: kept ones first, then candidates, to which more can be
// added where it pays.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "plan/fewest_on_rows.hpp"
#include "plan/placement_oracle.hpp"
#include "vantage/candidates.hpp"

namespace vantage {

class CandidateTable {
 public:
  // Borrows the simulators. `surroundings`: null where links do not matter.
  CandidateTable(Simulator& simulator, Simulator* surroundings, std::uint64_t sample_voxels,
                 std::uint64_t surroundings_voxels, double nearest_m);

  // Traces stations alone, and of candidates whose rows are known only their links. False where it was stopped; then
  // those that were traced whole are in the table.
  bool add(std::span<const PlacedStation> stations, const Progress& progress);
  bool add(std::span<const PlacedStation> stations, const CaptureRows& known, const Progress& progress);

  const std::vector<PlacedStation>& stations() const { return stations_; }
  const CaptureRows& rows() const { return rows_; }
  // Made anew after each addition.
  const PairTable& pairs() const { return pairs_; }

 private:
  Simulator* simulator_;
  Simulator* surroundings_;
  std::uint64_t sample_voxels_, surroundings_voxels_;
  double nearest_m_;
  std::vector<PlacedStation> stations_;
  CaptureRows rows_, around_;
  PairTable pairs_;
};

// Allowed positions around each of `stations`, `each` of them within `radius_m`, evenly spread over the disc.
std::vector<PlacedStation> positions_around(const PlacementOracle& site, std::span<const PlacedStation> stations,
                                            std::size_t each, double radius_m);

}  // namespace vantage
