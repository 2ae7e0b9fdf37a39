// SPDX-License-Identifier: Apache-2.0
// Stations to choose among, with what each covers and how they overlap: existing ones first, then candidates, to which
// more can be added.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "plan/placement_oracle.hpp"
#include "vantage/candidates.hpp"

namespace vantage {

class CandidateTable {
 public:
  // Borrows the simulators. `surroundings`: null where links do not matter. Stations nearer than `nearest_m` exclude
  // each other.
  CandidateTable(Simulator& simulator, Simulator* surroundings, std::uint64_t sample_voxels,
                 std::uint64_t surroundings_voxels, double nearest_m);

  // Traces stations; those whose coverage is known, over the surroundings alone. False where it was stopped: then the
  // table has the stations that were traced in full.
  bool add(std::span<const PlacedStation> stations, const Progress& progress);
  bool add(std::span<const PlacedStation> stations, const SampledCoverage& known, const Progress& progress);

  const std::vector<PlacedStation>& stations() const { return stations_; }
  const CoverageMatrix& matrix() const { return coverage_.matrix(); }
  // Made anew by each addition.
  const StationGraph& graph() const { return graph_; }

 private:
  Simulator* simulator_;
  Simulator* surroundings_;
  std::uint64_t sample_voxels_, surroundings_voxels_;
  double nearest_m_;
  std::vector<PlacedStation> stations_;
  SampledCoverage coverage_, around_;
  StationGraph graph_;
};

// Allowed positions around each of `stations`, `each` of them within `radius_m`, evenly spread over the disc.
std::vector<PlacedStation> positions_around(const PlacementOracle& site, std::span<const PlacedStation> stations,
                                            std::size_t each, double radius_m);

}  // namespace vantage
