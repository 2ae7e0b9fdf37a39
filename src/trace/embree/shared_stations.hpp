// SPDX-License-Identifier: Apache-2.0
// Finds stations common to several networks, and keeps the points of those needed again.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "trace/embree/station_points.hpp"

namespace vantage {

// Numbers of the stations of each network. Stations have the same number if all their rays give the same points.
struct StationIds {
  std::vector<std::vector<std::size_t>> of;  // [network][station]
  std::size_t different = 0;
};
StationIds station_ids(std::span<const StationRays> scanners, std::span<const std::vector<TraceStation>> networks);

class SharedStations {
 public:
  // Keeps at most `most_bytes` of points.
  SharedStations(std::span<const StationRays> scanners, std::span<const std::vector<TraceStation>> networks,
                 std::size_t most_bytes);

  std::size_t different() const { return uses_.size(); }
  // Returns an order of the networks in which each shares as many stations as possible with the one before.
  std::span<const std::size_t> order() const { return order_; }
  // Result for a station; asked for every station of every network, in that order.
  struct Use {
    std::size_t id;
    bool again;                   // a later network has it, too
    const StationPoints* points;  // its points, if kept; valid until the next call
  };
  Use next(std::size_t network, std::size_t station);
  // Makes room by dropping the stations needed last.
  void keep(std::size_t id, StationPoints points);

 private:
  static constexpr std::size_t kNever = std::numeric_limits<std::size_t>::max();

  void put_in_order();
  void drop(std::size_t id);
  // Returns the position of the next network that has the station, or kNever.
  std::size_t wanted(std::size_t id) const { return left_[id] < uses_[id].size() ? uses_[id][left_[id]] : kNever; }

  std::vector<std::vector<std::size_t>> ids_;  // stations of each network
  std::vector<std::size_t> order_;
  std::vector<std::vector<std::size_t>> uses_;  // per station, positions in the order, ascending
  std::vector<std::size_t> left_;               // per station, the first position still to come
  std::vector<std::optional<StationPoints>> kept_;
  std::size_t last_ = kNever;  // station returned last
  std::size_t bytes_ = 0, most_bytes_;
};

}  // namespace vantage
