// SPDX-License-Identifier: Apache-2.0
// Which stations a command works on: typed, read from a table, or taken from a plan's front.
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
  // From 1 to `most` stations, in the order given, typed ones first. Throws Error: io, malformed_file,
  // invalid_argument.
  std::vector<StationText> read(std::size_t most) const;
};

struct SiteStation {
  PlacedStation placed;
  bool has_uv = false;    // false: the head was given and no search area lies under it
  std::string name = {};  // as its owner calls it; empty where nothing is said
};

// Heads stay where they are given; (u, v) go to the ground below and up by the scanner's height. Both are checked for
// clashes, heads also for what they stand on. Scanners of their own join those of the site.
std::vector<SiteStation> place(Site& site, const std::vector<StationText>& stations);

Network to_network(const std::vector<SiteStation>& stations);
std::vector<PlacedStation> placed_of(const std::vector<SiteStation>& stations);
// As in all tables and pictures.
std::vector<std::string> names_of(const std::vector<SiteStation>& stations);
// {name, position, ground, uv, status}; null where there is none. And {heading, tilt, scanner, step} of a station that
// is not set up as usual. `scanners`: the site's.
nlohmann::json to_json(const SiteStation& station, const std::string& name, std::span<const Scanner> scanners);
// The same read again. Throws nlohmann::json::exception for what is of another type.
StationText station_of_json(const nlohmann::json& json);
// One warning a station that is not where a scanner could be.
void warn_of_unusable(const std::vector<SiteStation>& stations);

}  // namespace vantage::cli
