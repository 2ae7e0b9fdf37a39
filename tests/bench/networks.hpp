// SPDX-License-Identifier: Apache-2.0
// Networks to measure on: many that differ in number and place, so that none is a lucky set of stations.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "vantage/measure.hpp"
#include "vantage/placement.hpp"
#include "vantage/scene.hpp"
#include "vantage/simulator.hpp"

namespace vantage::bench {

// Returns networks of so many stations anywhere on the search area, clear of every mesh. Throws Error invalid_argument
// if there is no room for one.
std::vector<Network> networks_on_search_area(const Scene& scene, std::size_t count, std::size_t stations,
                                             double height_m, std::uint64_t seed);

// Returns the stations themselves, then networks of at least half of them, drawn. Each station is moved sideways by up
// to spread_m, but kept clear of every mesh.
std::vector<Network> networks_like(const Network& stations, const ClashChecker& checker, std::size_t count,
                                   double spread_m, std::uint64_t seed);

// Returns networks of a plan's front.json with at least so many stations, each at its place, upright. Throws Error io,
// malformed_file.
std::vector<Network> networks_of_front(const std::filesystem::path& file, std::size_t least_stations);

}  // namespace vantage::bench
