// SPDX-License-Identifier: Apache-2.0
// Networks to measure on: not one lucky set of stations, but many that differ in number and place.
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

// Networks of so many stations anywhere on the search area, clear of every mesh. Throws Error invalid_argument where
// there is no room for one.
std::vector<Network> networks_on_search_area(const Scene& scene, std::size_t count, std::size_t stations,
                                             double height_m, std::uint64_t seed);

// The stations themselves, then networks of at least half of them, drawn, each moved sideways by up to spread_m but
// kept clear of every mesh.
std::vector<Network> networks_like(const Network& stations, const ClashChecker& checker, std::size_t count,
                                   double spread_m, std::uint64_t seed);

// Those of a plan's front.json, of at least so many stations, each where it stands upright. Throws Error io,
// malformed_file.
std::vector<Network> networks_of_front(const std::filesystem::path& file, std::size_t least_stations);

}  // namespace vantage::bench
