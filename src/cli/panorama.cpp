// SPDX-License-Identifier: Apache-2.0
#include <spdlog/spdlog.h>

#include <filesystem>
#include <map>

#include "cli/command.hpp"
#include "cli/options.hpp"
#include "cli/run_report.hpp"
#include "cli/site.hpp"
#include "cli/stations.hpp"

namespace vantage::cli {
namespace {

struct PanoramaCommandOptions {
  SiteArguments site;
  StationOptions stations;
  std::optional<std::string> output;
  std::vector<PanoramaView> views;
  PanoramaOptions picture;
  bool json = false;

  void add(CLI::App& command) {
    site.add(command);
    stations.add(command);
    add_text(command, "-o,--output", "DIR", "Folder for the pictures, station_K_VIEW.png", output);
    add_value(command, "--views", "LIST", "Any of colour,range,normal,reflectivity,mesh; all otherwise",
              [this](const std::string& text, const std::string&) {
                for (const auto part : split(text, ',')) views.push_back(panorama_view_from_string(std::string(part)));
              });
    add_value(command, "--width", "PIXELS", "Width of the pictures, even; the height is half of it; 2048 otherwise",
              [this](const std::string& text, const std::string& what) {
                picture.width = static_cast<std::uint32_t>(parse_count(text, what, 2, 65536));
              });
    add_value(command, "--supersample", "N", "Rays per pixel and direction, 1 to 8; 2 otherwise",
              [this](const std::string& text, const std::string& what) {
                picture.supersample = static_cast<std::uint32_t>(parse_count(text, what, 1, 8));
              });
    command.add_flag("--json", json, "Print one JSON object");
  }
};

int panorama(CLI::App& command, PanoramaCommandOptions& options, Program& program) {
  const Stopwatch watch;
  options.site.given.weigh_ground = false;  // nothing here measures coverage
  Site site = open_site(command, options.site);
  const auto stations = place(site, options.stations.read(max_stations));
  const auto names = names_of(stations);
  if (!options.output)
    throw Error(Errc::invalid_argument, "panorama: no folder for the pictures; give one with -o DIR");
  if (options.views.empty()) options.views.assign(panorama_views().begin(), panorama_views().end());
  for (const auto& station : stations)
    if (station.placed.status == StationStatus::hole)
      throw Error(Errc::invalid_argument,
                  fmt::format("no ground under u,v = {:g},{:g}: a panorama needs a place to stand", station.placed.uv.u,
                              station.placed.uv.v));
  const std::filesystem::path folder = *options.output;
  make_folder(folder);

  std::map<std::uint32_t, PanoramaRenderer> renderers;  // a scanner each, by its place
  const auto renderer_of = [&](std::uint32_t place) -> PanoramaRenderer& {
    const Scanner& scanner = site.scanners()[place];
    options.picture.heading = scanner.heading;
    options.picture.min_range_m = scanner.min_range_m;
    options.picture.max_range_m = scanner.max_range_m;
    return renderers.try_emplace(place, site.scene(), options.picture, site.simulator_config()).first->second;
  };
  ProgressLine line(program.console, "drawing panoramas");
  nlohmann::json rows = nlohmann::json::array();
  std::string text;
  for (std::size_t k = 0; k < stations.size(); ++k) {
    const Progress progress{
        .report =
            [&](double done) { line.update((static_cast<double>(k) + done) / static_cast<double>(stations.size())); },
        .stop = program.stop};
    const PlacedStation& placed = stations[k].placed;
    const auto images =
        renderer_of(placed.setup.scanner).render(placed.position, options.views, progress, placed.setup);
    if (images.empty()) {
      spdlog::error("stopped at station {}; the pictures of those before it are in {}", k + 1, folder.string());
      return exit_failed;
    }
    auto row = to_json(stations[k], names[k], site.scanners());
    for (const auto& image : images) {
      const std::string name = fmt::format("station_{}_{}.png", k + 1, to_string(image.view));
      write_png(folder / name, image.image);
      row["pictures"].push_back({{"view", to_string(image.view)},
                                 {"file", (folder / name).string()},
                                 {"scale", {image.scale_low, image.scale_high}}});
      text += (folder / name).string() + "\n";
    }
    rows.push_back(std::move(row));
  }
  if (options.json)
    program.console.print(nlohmann::json{{"stations", std::move(rows)},
                                         {"width", options.picture.width},
                                         {"seconds", seconds_json(watch, 0)},
                                         {"version", version()}});
  else
    program.console.print(text);
  return exit_ok;
}

}  // namespace

void add_panorama(CLI::App& app, Program& program) {
  add_command<PanoramaCommandOptions>(
      app, program, "panorama", "Draw the views of stations as equirectangular pictures", panorama,
      {"vantage panorama site.glb --stations hall/stations.csv --views colour -o hall"});
}

}  // namespace vantage::cli
