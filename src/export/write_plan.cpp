// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cmath>
#include <mutex>
#include <system_error>

#include "core/atomic_file.hpp"
#include "core/parallel.hpp"
#include "core/text.hpp"
#include "export/pictures.hpp"
#include "export/station_files.hpp"
#include "export/tables.hpp"
#include "vantage/error.hpp"
#include "vantage/export.hpp"
#include "vantage/summary.hpp"

namespace vantage {
namespace {

std::string title_of(const PlanEntry& entry) {
  std::string title = std::to_string(entry.stations.size()) + (entry.stations.size() == 1 ? " station" : " stations");
  // A plan whose time was over may know neither.
  const double coverage = entry.value("coverage");
  if (const auto capture = entry.values.find("capture"); capture != entry.values.end()) {
    std::string shares;
    if (!std::isnan(coverage)) shares = fixed(100 * coverage, 1) + " % of the site captured";
    if (!std::isnan(capture->second.value))
      shares +=
          (shares.empty() ? "captured " : ", ") + fixed(100 * capture->second.value, 1) + " % of what is attainable";
    return title + ": " + (shares.empty() ? "the time was over before anything was measured" : shares);
  }
  return title + ": coverage " + fixed(entry.value("coverage"), 3) + ", overlap " + fixed(entry.value("overlap"), 3);
}

void remove_earlier_plan(const std::filesystem::path& folder) {
  remove_earlier(folder, {"overlap.csv", "coverage.ply", "registration.ply", "registration.png", "registration.svg",
                          "history.png", "history.svg", "targets.csv", "stations.geojson", "stations.kml", "plan.svg"});
  std::vector<std::string> levels;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored))
    if (const std::string name = entry.path().filename().string(); name.starts_with("plan-level-"))
      levels.push_back(name);
  for (const std::string& name : levels) remove_earlier(folder, {name.c_str()});
}

}  // namespace

std::vector<std::string> write_plan(const std::filesystem::path& folder, const PlanResult& result, Site& site,
                                    const VoxelField* field, const std::stop_token& late) {
  if (result.front.empty())
    throw Error(Errc::invalid_argument,
                "there is nothing to write: the search ended before its first networks were evaluated");
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed) throw Error(Errc::io, "cannot make the folder " + folder.string() + ": " + failed.message());
  const Simulator& simulator = site.simulator();
  const PlanEntry& entry = result.front[answer(result)];

  remove_earlier_plan(folder);
  write_front_csv(folder / "front.csv", result);
  write_text(folder / "front.json", front_json(result, simulator));
  write_history_csv(folder / "history.csv", result);
  write_fronts_csv(folder / "fronts.csv", result);
  write_stations_csv(folder / "stations.csv", entry.stations, simulator.scanners());
  if (entry.exact) write_overlap_csv(folder / "overlap.csv", entry.overlap_matrix);

  const auto save = [&](const std::string& name, const Canvas& picture) {
    for (const char* extension : {".png", ".svg"}) picture.save(folder / (name + extension));
  };
  std::vector<std::string> left_out;
  std::mutex adding;
  const auto leave_out = [&](const std::string& name) {
    const std::lock_guard lock(adding);
    left_out.push_back(name);
  };
  std::span<const StationError> errors;
  if (entry.registration) errors = entry.registration->stations;
  const auto names = station_names(entry.stations, entry.names);
  const StationLinks links = entry.links().value_or(StationLinks{.least = entry.link_overlap});
  const PlanView view{.scene = simulator.scene(),
                      .area = site.area(),
                      .stations = entry.stations,
                      .names = names,
                      .links = links,
                      .title = title_of(entry),
                      .errors = errors,
                      .targets = entry.targets};
  // Clouds and pictures are made side by side. Both files of a picture are made by one thread, since they share it.
  tbb::task_group files;
  files.run([&] {
    const std::vector<PlanPage> pages = plan_view_pictures(view, late);
    parallel::for_all(std::size_t{0}, pages.size(), [&](std::size_t k) {
      for (const std::string& name : {"plan" + pages[k].suffix + ".png", "plan" + pages[k].suffix + ".svg"})
        if (pages[k].canvas && (name == "plan.png" || !late.stop_requested()))
          pages[k].canvas->save(folder / name);
        else
          leave_out(name);
    });
  });
  if (field) files.run([&] { write_coverage_ply(folder / "coverage.ply", simulator, *field); });
  if (field && entry.registration) {
    files.run([&] { write_registration_ply(folder / "registration.ply", simulator, *field, *entry.registration); });
    for (const char* extension : {".png", ".svg"})
      files.run([&, extension] {
        draw_registration(folder / (std::string("registration") + extension), site, *field, *entry.registration,
                          entry.stations, "Registration error on the surface (predicted)");
      });
  }
  files.run([&] {
    save("front", *front_picture(result));
    save("hypervolume", *hypervolume_picture(result));
    if (result.problem.objectives.size() > 1) save("history", *history_picture(result));
  });
  parallel::wait(files);
  if (!entry.targets.empty()) write_targets_csv(folder / "targets.csv", entry.targets, names);
  write_station_files(folder, {entry.stations, names, entry.targets}, links, site);
  std::ranges::sort(left_out);
  return left_out;
}

}  // namespace vantage
