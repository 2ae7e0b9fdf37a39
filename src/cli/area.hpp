// SPDX-License-Identifier: Apache-2.0
// The options that say where a scanner may stand.
#pragma once

#include <CLI/CLI.hpp>
#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "vantage/vantage.hpp"

namespace vantage::cli {

// As given; empty where nothing was said.
struct AreaOptions {
  std::optional<std::array<double, 3>> security;
  std::optional<double> slope, headroom, min_area, climb;
  std::optional<std::array<double, 2>> passage, levels;
  std::optional<std::array<double, 3>> enter;
  std::vector<std::string> within, without;

  // `roles` gets the patterns of doors and of surfaces to stand on.
  void add(CLI::App& command, SceneOptions& roles);
  // Lengths that are not given are the built-in ones times `scale`. Throws Error: io, malformed_file.
  WalkableOptions walkable(double scale) const;
  SecurityVolume volume(double scale) const;
  // The files of regions, so that they can be given again.
  void add_files_to(nlohmann::json& options) const;
};

// A region in survey coordinates: the Polygons and MultiPolygons of a GeoJSON file (.json, .geojson), or the corners of
// one polygon, x,y a line, of any other. Throws Error: io, malformed_file.
PlanRegion read_region(const std::string& file);

// Where the search area comes from, and a line on what was left out of it.
void tell_area(const SearchArea& area, const Scene& scene);

}  // namespace vantage::cli
