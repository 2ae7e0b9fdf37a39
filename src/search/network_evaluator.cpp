// SPDX-License-Identifier: Apache-2.0
#include "search/network_evaluator.hpp"

namespace vantage {
namespace {

// The exact bytes of everything that an objective may use. A skipped station keeps its place: places key the noise, and
// their number divides the overlap.
std::string key_of(const PlacedNetwork& network) {
  std::string key;
  for (const PlacedStation& station : network) {
    key.push_back(static_cast<char>(station.status));
    for (const double c : {station.position.x, station.position.y, station.position.z, station.uv.u, station.uv.v})
      key.append(reinterpret_cast<const char*>(&c), sizeof c);
  }
  return key;
}

constexpr std::size_t kMostKnown = 65'536;  // 44 MB at 15 stations

}  // namespace

std::optional<std::vector<std::vector<double>>> CachingEvaluator::evaluate(std::span<const PlacedNetwork> networks,
                                                                           const VoxelWindow& sample,
                                                                           const Progress& progress) {
  std::vector<std::string> keys;
  std::vector<PlacedNetwork> fresh;
  std::unordered_map<std::string, std::size_t> fresh_index;
  if (known_.size() > kMostKnown || sample != sample_) known_.clear();
  sample_ = sample;
  for (const PlacedNetwork& network : networks) {
    keys.push_back(key_of(network));
    if (!known_.contains(keys.back()) && fresh_index.try_emplace(keys.back(), fresh.size()).second)
      fresh.push_back(network);
  }
  if (!fresh.empty()) {
    const auto values = evaluator_.evaluate(fresh, sample, progress);
    if (!values) return std::nullopt;
    simulated_ += fresh.size();
    for (const auto& [key, index] : fresh_index) known_.emplace(key, (*values)[index]);
  }
  std::vector<std::vector<double>> result;
  for (const std::string& key : keys) result.push_back(known_.at(key));
  return result;
}

}  // namespace vantage
