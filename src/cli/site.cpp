// SPDX-License-Identifier: Apache-2.0
#include "cli/site.hpp"

#include <spdlog/spdlog.h>

#include "cli/command.hpp"
#include "cli/console.hpp"
#include "cli/options.hpp"
#include "core/read_json.hpp"

namespace vantage::cli {

void SiteArguments::add(CLI::App& command) {
  command
      .add_option_function<std::vector<std::string>>(
          "scene", [this](const std::vector<std::string>& files) { take_files(files, scene, given.scene); },
          "The site: glTF, IFC, OBJ, STL, PLY, FBX, COLLADA, 3DS, X3D or DXF; or points: E57, LAS, PLY, XYZ, PTS, PTX "
          "or "
          "PCD; or a folder or several files of scans, IFC models or floor plans")
      ->type_name("SCENE");
  add_settings(command, site_settings(), given);
  add_text(command, "--config", "FILE", "JSON file of options, keyed by their long names; what is typed goes before it",
           config_file)
      ->group("Run");
}

void take_files(const std::vector<std::string>& files, std::string& first, SceneOptions& scene) {
  first = files.front();
  scene.beside.insert(scene.beside.begin(), files.begin() + 1, files.end());
}

Site open_site(CLI::App& command, SiteArguments& arguments) {
  if (arguments.config_file) apply_layer(command, read_json(*arguments.config_file), *arguments.config_file);
  if (arguments.scene.empty())
    throw Error(Errc::invalid_argument, command.get_name() + ": which scene? Give a model, as site.glb or site.ifc");
  arguments.given.log = [](const std::string& line) { spdlog::info("{}", line); };
  arguments.given.warn = [](const std::string& line) { spdlog::warn("{}", line); };
  Site site = by_option(command, [&] { return Site::open(arguments.scene, arguments.given); });
  // A scene may bring stations to try, for commands that take some.
  const CLI::Option* station_file = command.get_option_no_throw("--stations");
  const bool own_stations = station_file && station_file->count() > 0;
  apply_layer(command, nlohmann::json::parse(site.scene().defaults_json()), arguments.scene,
              [&](const std::string& key) { return key == "station" && !own_stations; });
  static_cast<void>(crs_text(site));  // an error now, not behind an hour's work
  return site;
}

std::string crs_text(const Site& site) { return site.crs().empty() ? "" : coordinate_system(site.crs()); }

Simulator& build_simulator(Site& site, Program& program) {
  ProgressLine line(program.console, "making voxels");
  // Ranks stop together, between pieces of the search.
  const std::stop_token stop = program.ranks ? std::stop_token() : program.stop;
  if (!site.build({.report = [&](double done) { line.update(done); }, .stop = stop})) throw Stopped{};
  return site.simulator();
}

}  // namespace vantage::cli
