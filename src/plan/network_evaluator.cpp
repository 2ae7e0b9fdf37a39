// SPDX-License-Identifier: Apache-2.0
#include "plan/network_evaluator.hpp"

#include <algorithm>

namespace vantage {
namespace {

// The exact bytes of what decides a result. A skipped station keeps its place: places key the noise, and their number
// divides the overlap.
std::string key_of(const Network& network) {
  std::string key;
  for (const Station& station : network) {
    key.push_back(station.active ? '+' : '-');
    if (!station.active) continue;
    for (const double c : {station.position.x, station.position.y, station.position.z})
      key.append(reinterpret_cast<const char*>(&c), sizeof c);
  }
  return key;
}

constexpr std::size_t kMostKnown = 65'536;  // 24 MB at 15 stations

}  // namespace

std::optional<std::vector<NetworkValue>> CachingEvaluator::evaluate(std::span<const Network> networks,
                                                                    const Progress& progress) {
  std::vector<std::string> keys;
  std::vector<Network> fresh;
  std::unordered_map<std::string, std::size_t> fresh_index;
  if (known_.size() > kMostKnown) known_.clear();
  for (const Network& network : networks) {
    keys.push_back(key_of(network));
    const bool blind = std::none_of(network.begin(), network.end(), [](const Station& s) { return s.active; });
    if (blind)
      known_.try_emplace(keys.back(),
                         NetworkValue{.coverage = 0, .overlap = 0, .parts = std::max<std::size_t>(network.size(), 1)});
    if (!known_.contains(keys.back()) && fresh_index.try_emplace(keys.back(), fresh.size()).second)
      fresh.push_back(network);
  }
  if (!fresh.empty()) {
    const auto values = evaluator_.evaluate(fresh, progress);
    if (!values) return std::nullopt;
    simulated_ += fresh.size();
    for (const auto& [key, index] : fresh_index) known_.emplace(key, (*values)[index]);
  }
  std::vector<NetworkValue> result;
  for (const std::string& key : keys) result.push_back(known_.at(key));
  return result;
}

}  // namespace vantage
