// SPDX-License-Identifier: Apache-2.0
// Counts of each station of a network in the voxels of a sample, kept while the station stays.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "report/coverage_cells.hpp"
#include "trace/sample_counts.hpp"
#include "vantage/simulator.hpp"

namespace vantage {

// Points add up, so a change traces only the stations that moved. Each keeps its place among the others while it
// exists, since the place keys its noise. All numbers equal those of `Simulator::evaluate_sampled`, to the last bit.
class TracedStations {
 public:
  // Samples `voxels` voxels, or all of them if there are fewer. Borrows the simulator.
  TracedStations(Simulator& simulator, std::uint64_t voxels);

  // Counts of a station's real scan, one for each voxel of the sample, in place of its rays from now on.
  void set_real(std::uint32_t id, std::vector<std::uint32_t> points);

  // Updates to a network. `ids`: a unique id of each station, constant while it exists.
  void follow(const Network& network, std::span<const std::uint32_t> ids);

  const std::vector<std::uint32_t>& sample() const { return sample_; }  // voxel indices, ascending
  const NetworkCounts& counts() const { return counts_; }               // with groups and pairs
  const std::vector<std::uint32_t>& points() const {
    return points_;
  }                                                              // of all stations, one for each voxel of the sample
  const std::vector<Seer>& seen_by() const { return seen_by_; }  // likewise
  // Points of each active station alone, in no order.
  std::vector<std::span<const std::uint32_t>> single_points() const;

 private:
  struct Traced {
    std::size_t place;
    std::uint32_t id;
    Vec3 head;
    StationSetup setup;
    std::vector<std::uint32_t> points;
  };
  void trace(const Network& network, std::span<const std::uint32_t> ids);
  void add_up(const Network& network);

  Simulator& simulator_;
  std::vector<std::uint32_t> sample_;
  VoxelDemands demands_;                                      // of the sample
  std::vector<Traced> traced_;                                // active ones
  std::map<std::uint32_t, std::vector<std::uint32_t>> real_;  // by id
  NetworkCounts counts_;
  std::vector<std::uint32_t> points_;
  std::vector<Seer> seen_by_;
};

}  // namespace vantage
