// SPDX-License-Identifier: Apache-2.0
// Stations that several networks have in common: which they are, and the points of those that are wanted again.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "trace/embree/station_points.hpp"

namespace vantage {

class SharedStations {
 public:
  // No more than `most_bytes` of points are kept.
  SharedStations(std::span<const StationRays> scanners, std::span<const std::vector<TraceStation>> networks,
                 std::size_t most_bytes);

  std::size_t different() const { return uses_.size(); }
  // In which networks are to be gone through: next comes the one that has most stations in common with the last.
  std::span<const std::size_t> order() const { return order_; }
  // To be asked for every station of every network, in that order.
  struct Use {
    std::size_t id;
    bool again;                   // a later network has it, too
    const StationPoints* points;  // where they are kept; until the next call
  };
  Use next(std::size_t network, std::size_t station);
  // Makes room by those that are wanted last.
  void keep(std::size_t id, StationPoints points);

 private:
  static constexpr std::size_t never = std::numeric_limits<std::size_t>::max();

  void put_in_order();
  void drop(std::size_t id);
  // When the next network comes that has the station, or never.
  std::size_t wanted(std::size_t id) const { return left_[id] < uses_[id].size() ? uses_[id][left_[id]] : never; }

  std::vector<std::vector<std::size_t>> ids_;  // of a network's stations
  std::vector<std::size_t> order_;
  std::vector<std::vector<std::size_t>> uses_;  // of each station, places in the order, ascending
  std::vector<std::size_t> left_;               // the first of those that is still to come
  std::vector<std::optional<StationPoints>> kept_;
  std::size_t last_ = never;  // asked for
  std::size_t bytes_ = 0, most_bytes_;
};

}  // namespace vantage
