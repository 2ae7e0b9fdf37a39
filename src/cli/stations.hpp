// SPDX-License-Identifier: Apache-2.0
// Stations of a command: typed, read from a table, or taken from a plan's front.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cli/parse.hpp"
#include "cli/site.hpp"

namespace vantage::cli {

struct StationOptions {
  std::vector<StationText> typed;
  std::optional<std::string> file;
  std::optional<std::uint64_t> entry;

  void add(CLI::App& command);
  // Returns 1 to `most` stations, typed ones first, in their order. Throws Error: io, malformed_file, invalid_argument.
  std::vector<StationText> read(std::size_t most) const;
};

struct SiteStation {
  PlacedStation placed;
  bool has_uv = false;    // false: the head was given and no search area lies below it
  std::string name = {};  // the user's name; empty if there is none
};

// Heads keep their position; (u, v) go to the ground below and up by the scanner's height. Both are checked for
// clashes, heads also for their footing. Scanners of single stations join those of the site.
std::vector<SiteStation> place(Site& site, const std::vector<StationText>& stations);

Network to_network(const std::vector<SiteStation>& stations);
std::vector<PlacedStation> placed_of(const std::vector<SiteStation>& stations);
// The same names as in all tables and pictures.
std::vector<std::string> names_of(const std::vector<SiteStation>& stations);
// `station_json()`; null for missing values. For a station with an unusual setup also {heading,
// tilt, scanner, step} and what else its scanner has of its own. `scanners`: the site's.
nlohmann::json to_json(const SiteStation& station, const std::string& name, std::span<const Scanner> scanners);
// The inverse. Throws nlohmann::json::exception for another type.
StationText station_of_json(const nlohmann::json& json);
// A warning for each unusable station.
void warn_of_unusable(Site& site, const std::vector<SiteStation>& stations);
// `explain` of a new station's status, what follows if it is unusable, and where it may stand instead.
std::string fault_text(Site& site, const PlacedStation& placed, const std::string& consequence = "it is left out");

}  // namespace vantage::cli
