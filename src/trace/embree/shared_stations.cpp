// SPDX-License-Identifier: Apache-2.0
#include "trace/embree/shared_stations.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <map>
#include <utility>

#include "core/first_numbers.hpp"

namespace vantage {
namespace {

// Keys are equal if all rays of two stations give the same points. The place keys the noise; zeros mean no turn.
using Key = std::array<std::uint32_t, 14>;

Key key_of(const TraceStation& station, bool noisy) {
  Key key{};
  std::size_t n = 0;
  const auto put = [&](const Float3& v) {
    for (const float f : {v.x, v.y, v.z}) key[n++] = std::bit_cast<std::uint32_t>(f);
  };
  put(station.origin);
  if (station.turn) {
    put(station.turn->x), put(station.turn->y), put(station.turn->z);
  }
  key[12] = station.scanner;
  key[13] = noisy ? station.place : 0;
  return key;
}

}  // namespace

StationIds station_ids(std::span<const StationRays> scanners, std::span<const std::vector<TraceStation>> networks) {
  std::map<Key, std::size_t> known;
  StationIds ids;
  for (const std::vector<TraceStation>& network : networks) {
    std::vector<std::size_t>& own = ids.of.emplace_back();
    for (const TraceStation& station : network) {
      const Key key = key_of(station, scanners[station.scanner].noise().enabled());
      own.push_back(known.try_emplace(key, known.size()).first->second);
    }
  }
  ids.different = known.size();
  return ids;
}

SharedStations::SharedStations(std::span<const StationRays> scanners,
                               std::span<const std::vector<TraceStation>> networks, std::size_t most_bytes)
    : most_bytes_(most_bytes) {
  StationIds ids = station_ids(scanners, networks);
  ids_ = std::move(ids.of);
  uses_.resize(ids.different);
  put_in_order();
  for (std::size_t k = 0; k < order_.size(); ++k)
    for (const std::size_t id : ids_[order_[k]]) uses_[id].push_back(k);
  left_.assign(uses_.size(), 0);
  kept_.resize(uses_.size());
}

void SharedStations::put_in_order() {
  std::vector<std::size_t> waiting = first_numbers(ids_.size());
  std::vector<bool> in_last(uses_.size());
  const auto in_common = [&](std::size_t network) {
    return std::ranges::count_if(ids_[network], [&](std::size_t id) { return in_last[id]; });
  };
  while (!waiting.empty()) {
    const auto next = std::ranges::max_element(waiting, {}, in_common);
    order_.push_back(*next);
    waiting.erase(next);
    in_last.assign(uses_.size(), false);
    for (const std::size_t id : ids_[order_.back()]) in_last[id] = true;
  }
}

SharedStations::Use SharedStations::next(std::size_t network, std::size_t station) {
  if (last_ != kNever && wanted(last_) == kNever) drop(last_);
  const std::size_t id = last_ = ids_[network][station];
  ++left_[id];
  return {.id = id, .again = wanted(id) != kNever, .points = kept_[id] ? &*kept_[id] : nullptr};
}

void SharedStations::keep(std::size_t id, StationPoints points) {
  bytes_ += points.bytes();
  kept_[id] = std::move(points);
  while (bytes_ > most_bytes_) {
    std::size_t latest = id;
    for (std::size_t k = 0; k < kept_.size(); ++k)
      if (kept_[k] && wanted(k) > wanted(latest)) latest = k;
    drop(latest);
    if (latest == id) return;
  }
}

void SharedStations::drop(std::size_t id) {
  if (!kept_[id]) return;
  bytes_ -= kept_[id]->bytes();
  kept_[id].reset();
}

}  // namespace vantage
