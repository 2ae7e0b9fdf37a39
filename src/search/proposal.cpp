// SPDX-License-Identifier: Apache-2.0
#include "search/proposal.hpp"

#include <algorithm>
#include <utility>

#include "core/first_numbers.hpp"
#include "core/parallel.hpp"

namespace vantage {
namespace {

// Coordinates of the stations in holes and clashes.
std::vector<std::size_t> misplaced(const PlacedNetwork& network, const DecisionSpace& space, std::uint64_t& stations) {
  std::vector<std::size_t> coordinates;
  for (std::size_t i = space.existing(); i < network.size(); ++i) {
    if (network[i].status == StationStatus::ok) continue;
    const auto own = space.coordinates(i);
    coordinates.insert(coordinates.end(), own.begin(), own.end());
    ++stations;
  }
  return coordinates;
}

}  // namespace

Proposal propose(Optimiser& optimiser, const DecisionSpace& space, std::size_t redraws, std::span<const double> first) {
  std::span<const double> asked = optimiser.ask();
  if (!first.empty()) {
    optimiser.replace(0, first);
    asked = optimiser.ask();
  }
  const std::size_t n = space.dimension(), count = asked.size() / n;
  Proposal batch{.xs = {asked.begin(), asked.end()}, .networks = std::vector<PlacedNetwork>(count)};
  std::vector<std::size_t> open = first_numbers(count);
  for (std::size_t round = 0;; ++round) {
    parallel::for_all(std::size_t{0}, open.size(), [&](std::size_t i) {
      batch.networks[open[i]] = space.decode(std::span<const double>(batch.xs).subspan(open[i] * n, n));
    });
    if (round == 0)
      for (const PlacedNetwork& network : batch.networks) batch.drawn += network.size() - space.existing();
    if (round == redraws) break;
    std::vector<std::size_t> again;
    for (const std::size_t k : open) {
      std::uint64_t stations = 0;
      const std::vector<std::size_t> coordinates = misplaced(batch.networks[k], space, stations);
      batch.drawn += stations, batch.redrawn += stations;
      if (coordinates.empty()) continue;
      const std::span<const double> x = optimiser.resample(k, coordinates);
      std::copy(x.begin(), x.end(), batch.xs.begin() + static_cast<std::ptrdiff_t>(k * n));
      again.push_back(k);
    }
    if (again.empty()) break;
    open = std::move(again);
  }
  return batch;
}

}  // namespace vantage
