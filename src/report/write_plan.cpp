// SPDX-License-Identifier: Apache-2.0
#include "vantage/write_plan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <string_view>
#include <system_error>

#include "candidates/why_missed.hpp"
#include "core/atomic_file.hpp"
#include "core/deadline.hpp"
#include "core/parallel.hpp"
#include "core/seconds_since.hpp"
#include "core/text.hpp"
#include "formats/station_files.hpp"
#include "formats/tables.hpp"
#include "map/pictures.hpp"
#include "map/shown_links.hpp"
#include "report/report.hpp"
#include "vantage/error.hpp"
#include "vantage/export.hpp"
#include "vantage/summary.hpp"

namespace vantage {
namespace {

std::string title_of(const PlanEntry& entry) {
  std::string title = std::to_string(entry.stations.size()) + (entry.stations.size() == 1 ? " station" : " stations");
  // If the time was over, a plan may know neither value.
  const double coverage = entry.value("coverage");
  if (const auto capture = entry.values.find("capture"); capture != entry.values.end()) {
    std::string shares;
    if (!std::isnan(capture->second.value)) shares = fixed(100 * capture->second.value, 1) + " % of what is attainable";
    if (!std::isnan(coverage)) shares += (shares.empty() ? "" : ", ") + fixed(100 * coverage, 1) + " % of the site";
    return title + ": " + (shares.empty() ? "the time was over before anything was measured" : "captured " + shares);
  }
  return title + ": coverage " + fixed(entry.value("coverage"), 3) + ", overlap " + fixed(entry.value("overlap"), 3);
}

// After the end of the time, parts of the work that take no longer than this are still finished.
constexpr double kMoment_s = 2;

// Voxels that time the judging, and largest number of judged voxels as a multiple of them.
constexpr std::uint64_t kTimedVoxels = 2500;
constexpr double kJudgedPerTimed = 20;
// Time of all drawings and reports relative to the maps, and of its map and clouds relative to counting the answer.
constexpr double kDrawings = 6, kCounts = 2;

// Parts of the work, in their order, and about which share of it is done before each.
struct Part {
  const char* name;
  double before, after;
};
constexpr Part kMap{"map", 0, 0.2}, kDraw{"draw", 0.2, 0.5}, kMissed{"missed", 0.5, 0.7}, kReport{"report", 0.7, 1};

// Removes files of an earlier plan that this one may not write again.
void remove_earlier_plan(const std::filesystem::path& folder) {
  remove_earlier(folder, {"overlap.csv", "coverage.ply", "registration.ply", "registration.png", "registration.svg",
                          "history.png", "history.svg",  "targets.csv",      "stations.geojson", "stations.kml",
                          "plan.svg",    "missed.csv",   "missed.ply",       "missed.png",       "missed.bcf",
                          "rooms.csv",   "sessions.csv", "elements.csv",     "waypoints.csv",    "waypoints.json",
                          "report.html", "report.pdf"});
  std::vector<std::string> levels;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored))
    if (const std::string name = entry.path().filename().string(); name.starts_with("plan-level-"))
      levels.push_back(name);
  for (const std::string& name : levels) remove_earlier(folder, {name.c_str()});
}

class FolderWriter {
 public:
  FolderWriter(const std::filesystem::path& folder, const PlanResult& result, Site& site, const FolderOptions& options,
               const FolderWatch& watch)
      : folder_(folder),
        result_(result),
        site_(site),
        options_(options),
        watch_(watch),
        time_(options.max_seconds ? std::max(*options.max_seconds, 1e-9) : 0, watch.stop),
        entry_(result.front[answer(result)]),
        names_(station_names(entry_.stations, entry_.names)),
        links_(links_to_draw(entry_)) {}

  WrittenFolder write() {
    // Mostly the evaluation that counted the answer kept its points.
    const VoxelField counted = entry_.field.count.empty() ? count() : VoxelField();
    const VoxelField& field = entry_.field.count.empty() ? counted : entry_.field;
    remove_earlier_plan(folder_);
    const VoxelField* const known = field.count.empty() ? nullptr : &field;
    // The slowest writers report progress, on the calling thread.
    const Deadline drawn_by(seconds(), watch_.stop);
    progress(kDraw, 0, 1, drawn_by)(0);
    parallel::beside([&] { parallel::beside([&] { draw(known, drawn_by.stop()); }, [&] { write_tables(); }); },
                     [&] {
                       if (!known) return;
                       judge(*known);
                       // Looks at the surfaces that judging has just made.
                       elements_ = element_shares(site_.simulator(), entry_, *known);
                       write_elements_csv(folder_ / "elements.csv", elements_);
                       if (written_.missed)
                         write_missed_bcf(folder_ / "missed.bcf", elements_, written_.missed->shares, site_);
                       else if (std::ranges::any_of(elements_, [](const auto& one) { return !one.global_id.empty(); }))
                         leave_out("missed.bcf");
                     });
    if (options_.reports && why_no_report().empty()) report(known);
    std::ranges::sort(written_.left_out);
    return std::move(written_);
  }

 private:
  Progress progress(const Part& part, double from, double to, const Deadline& due) const {
    return {.report =
                [this, &part, from, to](double done) {
                  const double share = from + done * (to - from);
                  if (watch_.report)
                    watch_.report({part.name, share, part.before + share * (part.after - part.before)});
                },
            .stop = due.stop()};
  }
  // Time, in seconds, for a part that begins now.
  double seconds() const { return std::max(time_.seconds_left(), kMoment_s); }
  void leave_out(const std::string& name) {
    const std::lock_guard lock(adding_);
    written_.left_out.push_back(name);
  }

  // Every voxel's count under the answer; empty if there is no time for it.
  VoxelField count() {
    VoxelField field;
    const Deadline due(seconds(), watch_.stop);
    const bool hopeless = entry_.exact && entry_.counts.trace_seconds > due.seconds_left();
    if (!hopeless &&
        !site_.simulator()
             .evaluate(to_network(entry_.stations), {.overlap = true, .field = &field}, progress(kMap, 0, 1, due))
             .cancelled)
      return field;
    for (const char* name : {"coverage.ply", "elements.csv", "missed.csv", "missed.ply", "missed.png"}) leave_out(name);
    if (entry_.registration)
      for (const char* name : {"registration.ply", "registration.png", "registration.svg"}) leave_out(name);
    if (!site_.scene().rooms().empty()) leave_out("rooms.csv");
    return {};
  }

  void write_tables() {
    write_front_csv(folder_ / "front.csv", result_);
    write_text(folder_ / "front.json", front_json(result_, site_.simulator()));
    write_history_csv(folder_ / "history.csv", result_);
    write_fronts_csv(folder_ / "fronts.csv", result_);
    write_stations_csv(folder_ / "stations.csv", entry_.stations, site_.scanners(), entry_.names);
    if (entry_.visit && !entry_.visit->order.empty())
      for (const char* name : {"waypoints.csv", "waypoints.json"})
        write_waypoints(folder_ / name, entry_, site_.scanners(), site_.crs());
    if (entry_.visit && !entry_.visit->sessions.empty()) write_sessions_csv(folder_ / "sessions.csv", entry_);
    if (entry_.exact) write_overlap_csv(folder_ / "overlap.csv", entry_.overlap_matrix);
    if (!entry_.targets.empty()) write_targets_csv(folder_ / "targets.csv", entry_.targets, names_);
    write_station_files(folder_, {entry_.stations, names_, entry_.targets}, links_, site_);
  }

  // Clouds and pictures are made side by side.
  void draw(const VoxelField* field, const std::stop_token& late) {
    tbb::task_group files;
    files.run([&] {
      plan_ = plan_pages(late);  // the report shows them, too
      save_plan(late);
    });
    if (field)
      files.run([&] { write_coverage_ply(folder_ / "coverage.ply", site_.simulator(), *field, options_.ply); });
    if (field && entry_.registration) {
      files.run([&] {
        write_registration_ply(folder_ / "registration.ply", site_.simulator(), *field, *entry_.registration,
                               options_.ply);
      });
      for (const char* extension : {".png", ".svg"})
        files.run([&, extension] {
          draw_registration(folder_ / (std::string("registration") + extension), site_, *field, *entry_.registration,
                            entry_.stations, "Registration error on the surface (predicted)");
        });
    }
    // Both files of such a picture are made by one thread, since they share it.
    files.run([&] {
      save("front", *front_picture(result_));
      save("hypervolume", *hypervolume_picture(result_));
      if (result_.problem.objectives.size() > 1) save("history", *history_picture(result_));
    });
    parallel::wait(files);
  }

  std::vector<PlanPage> plan_pages(const std::stop_token& late) const {
    std::span<const StationError> errors;
    if (entry_.registration) errors = entry_.registration->stations;
    return plan_view_pictures({.scene = site_.scene(),
                               .area = site_.area(),
                               .stations = entry_.stations,
                               .names = names_,
                               .links = links_,
                               .title = title_of(entry_),
                               .errors = errors,
                               .targets = entry_.targets},
                              late);
  }

  void save_plan(const std::stop_token& late) {
    parallel::for_all(std::size_t{0}, plan_.size(), [&](std::size_t k) {
      for (const std::string& name : {"plan" + plan_[k].suffix + ".png", "plan" + plan_[k].suffix + ".svg"})
        if (plan_[k].canvas && (name == "plan.png" || !late.stop_requested()))
          plan_[k].canvas->save(folder_ / name);
        else
          leave_out(name);
    });
  }

  void save(const std::string& name, const Canvas& picture) const {
    for (const char* extension : {".png", ".svg"}) picture.save(folder_ / (name + extension));
  }

  // Tells why surface is missed.
  void judge(const VoxelField& field) {
    const Deadline due(seconds(), watch_.stop);
    MissedVoxels missed = missed_voxels(site_, field, {}, progress(kMissed, 0, 1, due));
    const std::span<const Room> rooms = site_.scene().rooms();
    if (missed.shares.empty()) {
      if (!due.stop().stop_requested()) return;  // nothing is surveyed
      for (const char* name : {"missed.csv", "missed.ply", "missed.png"}) leave_out(name);
      if (!rooms.empty()) leave_out("rooms.csv");
      return;
    }
    write_missed_csv(folder_ / "missed.csv", missed.shares);
    write_missed_ply(folder_ / "missed.ply", site_.simulator(), missed, options_.ply);
    draw_missed(folder_ / "missed.png", site_, missed, entry_.stations, "Why surfaces are not captured");
    if (!missed.rooms.empty())
      write_rooms_csv(folder_ / "rooms.csv", rooms, missed.rooms, entry_.stations, entry_.names);
    written_.missed = std::move(missed);
  }

  void report(const VoxelField* field) {
    ReportOptions shown = options_.report;
    shown.field = field;
    shown.missed = written_.missed ? &*written_.missed : nullptr;
    shown.elements = elements_;
    const Deadline due(seconds(), watch_.stop);
    for (const std::string& name : write_reports(folder_, result_, site_, shown, plan_, progress(kReport, 0, 1, due)))
      leave_out(name);
  }

  const std::filesystem::path& folder_;
  const PlanResult& result_;
  Site& site_;
  const FolderOptions& options_;
  const FolderWatch& watch_;
  Deadline time_;
  const PlanEntry& entry_;
  std::vector<std::string> names_;
  StationLinks links_;
  std::vector<PlanPage> plan_;
  std::vector<ElementShare> elements_;
  std::mutex adding_;
  WrittenFolder written_;
};

}  // namespace

WrittenFolder write_plan(const std::filesystem::path& folder, const PlanResult& result, Site& site,
                         const FolderOptions& options, const FolderWatch& watch) {
  if (result.front.empty())
    throw Error(Errc::invalid_argument,
                "there is nothing to write: the search ended before its first networks were evaluated");
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed) throw Error(Errc::io, "cannot make the folder " + folder.string() + ": " + failed.message());
  return FolderWriter(folder, result, site, options, watch).write();
}

std::function<double(std::size_t, double)> seconds_to_write(Site& site) {
  const Simulator& simulator = site.simulator();
  const auto begun = std::chrono::steady_clock::now();
  plan_view_pictures({.scene = site.scene(), .area = site.area(), .stations = {}, .names = {}, .title = ""});
  const double drawn = seconds_since(begun);
  // A network that captures nothing is the slowest to judge.
  const std::vector<PlacedStation> candidates = candidate_positions(site, MissedOptions().candidates);
  const std::vector<std::uint32_t> some = simulator.sampled_voxels(std::min(kTimedVoxels, simulator.voxel_count()));
  const std::vector<std::uint32_t> none(some.size(), 0);
  const auto judging = std::chrono::steady_clock::now();
  if (!candidates.empty()) why_missed(site, candidates, some, none);
  const double judged = seconds_since(judging);
  const double still = kDrawings * drawn + kJudgedPerTimed * judged;
  return [still](std::size_t stations, double seconds_a_station) {
    return still + kCounts * static_cast<double>(stations) * seconds_a_station;
  };
}

}  // namespace vantage
