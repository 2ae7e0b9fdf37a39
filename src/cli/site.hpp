// SPDX-License-Identifier: Apache-2.0
// What most commands share: a scene, a scanner, where it may stand and what to trace with.
#pragma once

#include <CLI/CLI.hpp>
#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cli/area.hpp"
#include "cli/parse.hpp"
#include "vantage/vantage.hpp"

namespace vantage::cli {

struct Program;

// The options as given; empty where nothing was said. add() registers them with a command; the object must outlive the
// parsing.
struct SiteOptions {
  std::string scene;
  SceneOptions roles;
  std::optional<std::string> scene_index;
  std::optional<double> diffuse;

  std::optional<std::string> scanner;
  std::optional<std::array<double, 2>> step;
  std::optional<double> heading, horizontal, vertical, zenith_start, height;
  std::optional<std::array<double, 2>> range;
  std::optional<std::string> noise;
  std::optional<std::array<double, 2>> beam;  // mrad, mm
  std::optional<double> rate;

  std::optional<double> user_size, spacing, incidence;
  bool spacing_by_detail = false;
  AreaOptions area;

  Engine engine = Engine::automatic;
  DeviceList devices;
  std::uint64_t seed = 1;
  bool validation = false;
  std::uint64_t memory = 0;  // bytes; 0: half of what is free

  std::optional<std::string> crs, config_file;

  void add(CLI::App& command);
};

// Everything resolved: explicit options, else the configuration file, else the scene's own defaults, else built-in
// figures. A preset that the user names is as explicit as the figures it stands for.
struct LoadedSite {
  Scene scene;
  Scanner scanner;
  std::vector<Scanner> scanners = {};  // what StationSetup::scanner counts: `scanner`, then those of single stations
  SimulatorConfig config;
  SecurityVolume security;
  WalkableOptions walkable;
  AreaOptions area_options = {};
  std::string noise;     // where its table came from: off, a scanner's name, or a file
  std::string crs = {};  // the survey frame's coordinate system, as given; empty: not known

  // The search area, made on first use. Throws Error invalid_argument where nothing is walkable.
  const SearchArea& area();
  // Whether there is one to be had.
  bool has_area();
  const ClashChecker& clash();
  // Its well-known text; empty where it is not known.
  std::string crs_text() const { return crs.empty() ? "" : coordinate_system(crs); }
  // Every value as an option, so that it can be given to --config again.
  nlohmann::json as_options() const;

  std::optional<SearchArea> area_ = std::nullopt;
  std::optional<ClashChecker> clash_ = std::nullopt;
};

// Applies the layers below the command line to all options of `command`, loads the scene and checks every value.
LoadedSite open_site(CLI::App& command, SiteOptions& options);

// A simulator of it, with a line for as long as its voxels take. Throws Stopped.
Simulator build_simulator(const LoadedSite& site, std::span<const Scanner> scanners, Program& program);

// Where nothing says what is surveyed: gives all but the ground so much weight that ground has a third of coverage at
// most, and says so. For commands that measure coverage.
void weigh_ground(LoadedSite& site);

// For a scene whose size is unlike a site's: the built-in lengths times this; of a large one only voxel size and
// spacing. 1 from 2 m to 200 m; otherwise the largest extent over 20 m, with two significant digits.
double length_scale(const Box& bounds);

}  // namespace vantage::cli
