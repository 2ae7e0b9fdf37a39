// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <spawn.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <optional>

#include "cli/command.hpp"
#include "cli/missed.hpp"
#include "cli/options.hpp"
#include "cli/report.hpp"
#include "cli/run_report.hpp"
#include "cli/site.hpp"
#include "cli/stations.hpp"
#include "core/json_text.hpp"
#include "core/read_json.hpp"
#include "edit/scan_watcher.hpp"
#include "edit/server.hpp"

extern char** environ;

namespace vantage::cli {
namespace {

struct EditCommandOptions {
  SiteArguments site;
  StationOptions stations;
  EditOptions edit;
  std::optional<SampleSize> sample;
  std::optional<std::string> scans, output;
  std::optional<double> link;
  bool no_browser = false;

  void add(CLI::App& command) {
    site.add(command);
    stations.add(command);
    add_text(command, "--scans", "DIR",
             "Folder into which scans of the day come, as E57 or PTX: each makes its station a taken one", scans)
        ->group("Stations");
    add_value(command, "--sample", "N|P%", "Number or share of voxels for every evaluation; 40000 otherwise",
              [this](const std::string& text, const std::string& what) { sample = parse_sample(text, what); })
        ->group("Evaluation");
    add_number(command, "--link", "SHARE",
               fmt::format("Least scan overlap of a link, 0 to 1; {} otherwise", default_link), link,
               {.low = 0, .high = 1})
        ->group("Results");
    add_text(command, "-o,--output", "DIR", "Folder for the results; the scene's name and -edit otherwise", output)
        ->group("Results");
    command.add_flag("--no-browser", no_browser, "Print the address and open no browser")->group("Results");
  }
};

// State saved at every change, so that nothing is lost, however the program ends.
struct Keeper {
  std::filesystem::path file;
  std::string scene;

  void keep(const std::vector<EditStation>& stations, std::span<const Scanner> scanners) const {
    nlohmann::json rows = nlohmann::json::array();
    for (const EditStation& station : stations) {
      rows.push_back(to_json({.placed = station.placed, .has_uv = true}, station.name, scanners));
      rows.back()["locked"] = station.locked;
    }
    write_text(file, json_text(nlohmann::json{{"scene", scene}, {"stations", rows}, {"version", version()}}, 2) + "\n");
  }

  // Empty if the scene differs.
  std::vector<EditStation> restored(Site& site) const {
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored)) return {};
    std::vector<EditStation> stations;
    try {
      const auto json = read_json(file.string());
      if (json.at("scene") != scene) {
        spdlog::warn("{} belongs to another scene and is ignored", file.string());
        return {};
      }
      for (const auto& row : json.at("stations")) {
        const StationText text = station_of_json(row);
        if (!text.position) throw Error(Errc::malformed_file, file.string() + ": a station has no position");
        stations.push_back(
            {.placed = place(site, {text}).front().placed, .locked = row.at("locked"), .name = text.name});
      }
    } catch (const nlohmann::json::exception& error) {
      throw Error(Errc::malformed_file, file.string() + ": is no file of the editor: " + error.what());
    }
    spdlog::info("going on with the {} stations of {}", stations.size(), file.string());
    return stations;
  }
};

// Opens a browser without showing the address to other programs, which can list the arguments of processes. The browser
// gets a page, readable by this user only, that leads there; it is removed with this object.
class Browser {
 public:
  Browser(const std::filesystem::path& folder, const std::string& address) {
    if (!std::getenv("DISPLAY") && !std::getenv("WAYLAND_DISPLAY")) return;
    page_ = std::filesystem::absolute(folder / "open-editor.html");
    std::error_code ignored;
    std::filesystem::remove(page_, ignored);
    const int file = ::open(page_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600);
    const std::string html =
        "<!doctype html>\n<meta name=\"referrer\" content=\"no-referrer\">\n"
        "<meta http-equiv=\"refresh\" content=\"0; url=" +
        address + "\">\n<title>vantage</title>\n";
    const bool written = file >= 0 && ::write(file, html.data(), html.size()) == std::ssize(html);
    if (file >= 0) ::close(file);
    std::string command = "xdg-open", argument = page_.string();
    char* const arguments[] = {command.data(), argument.data(), nullptr};
    pid_t child = 0;
    if (!written || posix_spawnp(&child, "xdg-open", nullptr, nullptr, arguments, environ) != 0)
      spdlog::warn("xdg-open cannot open a browser; open the address yourself");
  }
  ~Browser() {
    std::error_code ignored;
    if (!page_.empty()) std::filesystem::remove(page_, ignored);
  }
  Browser(const Browser&) = delete;
  Browser& operator=(const Browser&) = delete;

 private:
  std::filesystem::path page_;
};

int edit(CLI::App& command, EditCommandOptions& options, Program& program) {
  Site site = open_site(command, options.site);
  std::error_code failure;
  if (options.scans && !std::filesystem::is_directory(*options.scans, failure))
    throw Error(Errc::io, *options.scans + ": there is no such folder of scans; make it, and copy scans into it");
  const std::filesystem::path folder = options.output ? *options.output : site.name() + "-edit";
  make_folder(folder);
  const Keeper keeper{folder / "edit.json", fmt::format("{:016x}", site.scene().fingerprint())};
  std::vector<EditStation> stations;
  if (options.stations.typed.empty() && !options.stations.file) {
    stations = keeper.restored(site);
  } else {
    for (const SiteStation& station : place(site, options.stations.read(max_stations))) {
      if (station.placed.status == StationStatus::hole)
        throw Error(Errc::invalid_argument, fmt::format("--station: no ground under u,v = {:g},{:g}",
                                                        station.placed.uv.u, station.placed.uv.v));
      stations.push_back({.placed = station.placed, .name = station.name});
    }
  }
  Simulator& simulator = build_simulator(site, program);
  tell_engine(simulator);
  tell_grid(simulator);
  if (options.link) options.edit.link = *options.link;
  if (options.sample) options.edit.voxels = options.sample->of(simulator.voxel_count());
  const auto save = [&](const Evaluation& exact, const Progress& progress) -> std::string {
    write_stations_csv(folder / "stations.csv", exact.stations, simulator.scanners(), exact.names);
    const std::string where = "saved in " + std::filesystem::absolute(folder).string() + ": stations.csv";
    const auto judged = judge_missed(site, exact.field, program);
    if (progress.stopped()) return where + "; stopped before the reports";
    std::string told = where;
    for (const std::filesystem::path& file :
         write_reports(std::vector<std::filesystem::path>{folder / "report.html", folder / "report.pdf"}, exact, site,
                       {.missed = judged ? &*judged : nullptr}, program, progress.stop))
      told += ", " + file.filename().string();
    spdlog::info("{}", told);
    return told;
  };
  EditSession session(
      site, stations, options.edit,
      [&](const std::vector<EditStation>& now) { keeper.keep(now, simulator.scanners()); }, save);
  std::optional<ScanWatcher> watcher;
  if (options.scans) watcher.emplace(session, site, *options.scans, options.edit.tolerance_m);
  std::optional<Browser> browser;
  serve_editor(
      session, site.name(),
      [&](const std::string& address) {
        program.console.print(address + "\n");
        spdlog::info("the editor is at this address until Ctrl-C; {} always has the present stations",
                     keeper.file.string());
        if (!options.no_browser) browser.emplace(folder, address);
      },
      program.stop);
  return exit_ok;
}

}  // namespace

void add_edit(CLI::App& app, Program& program) {
  add_command<EditCommandOptions>(app, program, "edit", "Move stations by hand, in a browser on this machine", edit,
                                  {"vantage edit site.glb --stations hall/front.json"});
}

}  // namespace vantage::cli
