// SPDX-License-Identifier: Apache-2.0
// What each station of a network left in the voxels of a sample, kept while it stands where it is.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "report/coverage_cells.hpp"
#include "trace/sample_counts.hpp"
#include "vantage/simulator.hpp"

namespace vantage {

// Points add up, so after a change those stations alone are traced that have moved. Each keeps its place among the
// others while it is, as its noise goes by that: all numbers are those of `Simulator::evaluate_sampled`, to the last
// bit.
class TracedStations {
 public:
  // Of so many voxels, or as many as there are. Borrows the simulator.
  TracedStations(Simulator& simulator, std::uint64_t voxels);

  // `ids`: a name of each station's own, for as long as it is there.
  void follow(const Network& network, std::span<const std::uint32_t> ids);

  const std::vector<std::uint32_t>& sample() const { return sample_; }  // voxel indices, ascending
  const NetworkCounts& counts() const { return counts_; }               // with groups and pairs
  const std::vector<std::uint32_t>& points() const { return points_; }  // of all stations, one each of the sample
  const std::vector<Seer>& seen_by() const { return seen_by_; }         // likewise

 private:
  struct Traced {
    std::size_t place;
    std::uint32_t id;
    Vec3 head;
    StationSetup setup;
    std::vector<std::uint32_t> points;
  };
  void trace(const Network& network, std::span<const std::uint32_t> ids);
  void add_up(std::size_t stations);

  Simulator& simulator_;
  std::vector<std::uint32_t> sample_;
  VoxelDemands demands_;        // of the sample
  std::vector<Traced> traced_;  // active ones
  NetworkCounts counts_;
  std::vector<std::uint32_t> points_;
  std::vector<Seer> seen_by_;
};

}  // namespace vantage
