// SPDX-License-Identifier: Apache-2.0
#include "ranks_model.hpp"

#include <algorithm>
#include <functional>
#include <queue>
#include <utility>

#include "core/philox.hpp"
#include "trace/spread/work_queue.hpp"

namespace vantage::bench {
namespace {

// Serves one after the other.
struct Counter {
  double free_at = 0;
  double serve(double from, double seconds) { return free_at = std::max(free_at, from) + seconds; }
};

}  // namespace

double seconds_a_population(const RanksModel& model, std::size_t ranks, std::size_t population, std::uint64_t seed) {
  RandomStream random(seed);
  std::vector<double> seconds(population);
  for (double& s : seconds)
    s = model.network_s[std::min(
        model.network_s.size() - 1,
        static_cast<std::size_t>(random.uniform() * static_cast<double>(model.network_s.size())))];
  WorkQueue queue(population);
  Counter out, in, host;  // the two ways of rank 0's line, and its processor
  double end = 0;
  struct Event {
    double at;
    std::size_t rank, networks;  // networks: whose answer comes in; 0: the rank is idle
    bool operator>(const Event& other) const { return std::pair(at, rank) > std::pair(other.at, other.rank); }
  };
  std::priority_queue<Event, std::vector<Event>, std::greater<>> events;
  for (std::size_t rank = 0; rank < ranks; ++rank)
    events.push({ranks == 1 ? 0 : host.serve(0, model.member_s), rank, 0});
  const double share = 1 / static_cast<double>(ranks);
  while (!events.empty()) {
    const Event event = events.top();
    events.pop();
    double now = event.at;
    if (event.networks > 0) {
      const auto networks = static_cast<double>(event.networks);
      now = in.serve(now, networks * model.answer_bytes / model.bytes_a_second);
      now = host.serve(now, networks * model.messages_s / 2);
    }
    end = std::max(end, now);
    if (queue.empty()) continue;
    const Chunk chunk = ranks == 1 ? queue.take(1, true) : queue.take(share, true);
    double work = model.piece_s;
    for (std::size_t k = chunk.first; k < chunk.end; ++k) work += seconds[k];
    if (event.rank == 0) {
      events.push({now + work, 0, 0});
      continue;
    }
    const auto networks = static_cast<double>(chunk.size());
    now = host.serve(now, networks * model.messages_s / 2);
    now = out.serve(now, networks * model.ask_bytes / model.bytes_a_second);
    events.push({now + model.round_trip_s + work, event.rank, chunk.size()});
  }
  return end + static_cast<double>(population) * model.search_s;
}

}  // namespace vantage::bench
