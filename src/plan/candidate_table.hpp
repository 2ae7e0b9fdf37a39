// SPDX-License-Identifier: Apache-2.0
// Stations to choose from, with their coverage and overlaps: existing ones first, then candidates. More can be added.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "plan/placement_oracle.hpp"
#include "vantage/candidates.hpp"

namespace vantage {

// Traces stations one by one and returns their columns on a sample. A stopped call returns the columns of the first
// ones.
using TraceColumns = std::function<CoverageMatrix(std::span<const PlacedStation>, const Progress&)>;
// Makes one on a sample of `sample_voxels` of a simulator, which it borrows.
TraceColumns columns_of(Simulator& simulator, std::uint64_t sample_voxels);

class CandidateTable {
 public:
  // `surroundings`: over all surfaces; empty if links do not matter. Stations nearer than `nearest_m` exclude each
  // other.
  CandidateTable(TraceColumns surveyed, TraceColumns surroundings, double nearest_m);

  // Traces stations; those with known columns only over the surroundings. False if stopped: the table then has the
  // stations that were traced in full.
  bool add(std::span<const PlacedStation> stations, const Progress& progress);
  bool add(std::span<const PlacedStation> stations, const CoverageMatrix& known, const Progress& progress);

  const std::vector<PlacedStation>& stations() const { return stations_; }
  const CoverageMatrix& matrix() const { return matrix_; }
  // Remade by each addition.
  const StationGraph& graph() const { return graph_; }

 private:
  TraceColumns surveyed_, surroundings_;
  double nearest_m_;
  std::vector<PlacedStation> stations_;
  CoverageMatrix matrix_, around_;
  StationGraph graph_;
};

// Allowed positions around each of `stations`, `each` of them within `radius_m`, spread evenly over the disc.
std::vector<PlacedStation> positions_around(const PlacementOracle& site, std::span<const PlacedStation> stations,
                                            std::size_t each, double radius_m);

}  // namespace vantage
