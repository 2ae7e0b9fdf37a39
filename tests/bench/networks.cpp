// SPDX-License-Identifier: Apache-2.0
#include "networks.hpp"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/philox.hpp"
#include "core/read_file.hpp"
#include "vantage/error.hpp"

namespace vantage::bench {
namespace {

constexpr double kClearance = 0.5;  // metres, of a scanner's head

std::size_t below(RandomStream& random, std::size_t end) {
  return std::min(end - 1, static_cast<std::size_t>(random.uniform() * static_cast<double>(end)));
}

}  // namespace

std::vector<Network> networks_on_search_area(const Scene& scene, std::size_t count, std::size_t stations,
                                             double height_m, std::uint64_t seed) {
  const SearchArea area = SearchArea::build(scene);
  const ClashChecker checker(scene);
  const Uv low = area.uv_min(), high = area.uv_max();
  RandomStream random(seed);
  std::vector<Network> networks(count);
  for (Network& network : networks)
    for (std::size_t attempt = 0; network.size() < stations; ++attempt) {
      if (attempt > 10'000 * stations)
        throw Error(Errc::invalid_argument, "the search area has no room for a station; give --stations");
      const double u = low.u + random.uniform() * (high.u - low.u), v = low.v + random.uniform() * (high.v - low.v);
      const auto ground = area.locate({u, v});
      if (ground && !checker.clashes(*ground)) network.push_back({*ground + Vec3{0, 0, height_m}});
    }
  return networks;
}

std::vector<Network> networks_like(const Network& stations, const ClashChecker& checker, std::size_t count,
                                   double spread_m, std::uint64_t seed) {
  RandomStream random(seed);
  std::vector<Network> networks(1, stations);
  while (networks.size() < count) {
    Network network = stations;
    for (std::size_t k = network.size(); k > 1; --k) std::swap(network[k - 1], network[below(random, k)]);
    const std::size_t fewest = (stations.size() + 1) / 2;
    network.resize(fewest + below(random, stations.size() - fewest + 1));
    for (Station& station : network)
      // In a crowded place a station stays where it is.
      for (int attempt = 0; attempt < 64; ++attempt) {
        const Vec3 moved =
            station.position + Vec3{(random.uniform() * 2 - 1) * spread_m, (random.uniform() * 2 - 1) * spread_m, 0};
        if (checker.distance(moved, kClearance) < kClearance) continue;
        station.position = moved;
        break;
      }
    networks.push_back(std::move(network));
  }
  return networks;
}

std::vector<Network> networks_of_front(const std::filesystem::path& file, std::size_t least_stations) {
  std::vector<Network> networks;
  try {
    const auto plan = nlohmann::json::parse(read_file(file));
    for (const auto& entry : plan.at("front")) {
      Network network;
      for (const auto& station : entry.at("stations")) {
        const auto at = station.at("position").get<std::array<double, 3>>();
        network.push_back({.position = {at[0], at[1], at[2]}});
      }
      if (network.size() >= least_stations) networks.push_back(std::move(network));
    }
  } catch (const nlohmann::json::exception& error) {
    throw Error(Errc::malformed_file, file.string() + ": is not a plan's front.json: " + error.what());
  }
  if (networks.empty())
    throw Error(Errc::malformed_file,
                file.string() + ": has no network of " + std::to_string(least_stations) + " stations or more");
  return networks;
}

}  // namespace vantage::bench
