// SPDX-License-Identifier: Apache-2.0
#include "edit/session.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "report/packed.hpp"
#include "report/report_json.hpp"
#include "vantage/error.hpp"
#include "vantage/planner.hpp"

namespace vantage {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

constexpr std::size_t kMostUndo = 200;
constexpr std::uint64_t kCellVoxels = 200'000;  // from which cells are made

std::vector<std::uint8_t> bytes_of(const std::vector<float>& values) {
  const auto* first = reinterpret_cast<const std::uint8_t*>(values.data());
  return {first, first + values.size() * sizeof(float)};
}

double number_of(const json& value, const char* what) {
  if (!value.is_number()) throw Error(Errc::invalid_argument, std::string(what) + ": not a number");
  const double number = value.get<double>();
  if (!std::isfinite(number)) throw Error(Errc::invalid_argument, std::string(what) + ": not a finite number");
  return number;
}

bool flag_of(const json& request, const char* key) {
  const auto at = request.find(key);
  return at != request.end() && at->is_boolean() && at->get<bool>();
}

}  // namespace

EditSession::EditSession(Site& site, const std::vector<EditStation>& stations, const EditOptions& options, Keep keep,
                         Save save)
    : site_(site),
      simulator_(site.simulator()),
      surroundings_(site.surroundings()),
      options_(options),
      keep_(std::move(keep)),
      save_(std::move(save)),
      cells_(coverage_cells(simulator_, std::max(kCellVoxels, options.voxels), options.cells)),
      stations_(stations),
      surveyed_(simulator_, options.voxels),
      around_(surroundings_, options.link_voxels) {
  // Made now, since the site's parts are read from several threads later.
  site_.area(), site_.clash();
  for (EditStation& station : stations_) station.id = next_id_++;
  measure();
}

EditSession::~EditSession() { stop_job_.request_stop(); }

ordered_json EditSession::site() const {
  std::vector<PlacedStation> stations;
  {
    const std::scoped_lock lock(mutex_);
    stations = placed();
  }
  ordered_json json = site_json(site_, stations, cells_);
  const SearchMesh& ground = site_.area().mesh();
  std::vector<float> positions;
  for (const Vec3& p : ground.positions) {
    const Vec3 local = p - simulator_.origin();
    for (const double v : {local.x, local.y, local.z}) positions.push_back(static_cast<float>(v));
  }
  std::vector<std::uint32_t> indices;
  for (const auto& t : ground.triangles) indices.insert(indices.end(), t.begin(), t.end());
  json["ground"] = {{"corners", indices.size()},
                    {"positions", packed(bytes_of(positions))},
                    {"indices", packed(byte_planes<std::uint32_t>(indices))}};
  json["height_m"] = simulator_.scanner().height_m;
  return json;
}

ordered_json EditSession::state() const {
  const std::scoped_lock lock(mutex_);
  ordered_json ids = ordered_json::array(), locked = ids;
  for (const EditStation& station : stations_) {
    ids.push_back(station.id);
    locked.push_back(station.locked);
  }
  ordered_json network = network_json(evaluation_);
  network["dominated"] = false;
  ordered_json json = {{"version", version_.load()},
                       {"network", std::move(network)},
                       {"ids", std::move(ids)},
                       {"locked", std::move(locked)},
                       {"coverage", packed(colours_.coverage)},
                       {"only", packed(colours_.only)},
                       {"sample", evaluation_.exact ? std::uint64_t{0} : surveyed_.sample().size()},
                       {"exact", evaluation_.exact},
                       {"undo", !undo_.empty()},
                       {"redo", !redo_.empty()},
                       {"message", message_},
                       {"busy", nullptr}};
  if (!busy_.empty()) json["busy"] = {{"what", busy_}, {"done", done_}};
  return json;
}

void EditSession::change(const json& request) {
  const std::scoped_lock lock(mutex_);
  const auto named = request.is_object() ? request.find("do") : request.end();
  if (!request.is_object() || named == request.end() || !named->is_string())
    throw Error(Errc::invalid_argument, "a change must be an object with \"do\"");
  const std::string what = named->get<std::string>();
  if (what == "stop") {
    stop_job_.request_stop();
    return;
  }
  if (!busy_.empty()) throw Error(Errc::invalid_argument, "wait until this is done, or stop it: " + busy_);
  message_.clear();
  if (what == "exact")
    return start("tracing every ray", [this](const Progress& progress) { trace_exactly(progress, {}); });
  if (what == "improve") return start("improving the others", [this](const Progress& progress) { improve(progress); });
  if (what == "save") {
    keep_(stations_);
    return start("saving", [this](const Progress& progress) {
      trace_exactly(progress, [&](const Evaluation& exact) { save_(exact, progress); });
    });
  }
  bool dragging = false;
  if (what == "move") {
    if (flag_of(request, "end")) keep_(stations_);  // the drag so far, in case it ends off the ground
    PlacedStation ground = on_ground(request.value("to", json()));
    EditStation& station = with_id(request);
    if (station.locked) throw Error(Errc::invalid_argument, "this station is locked");
    dragging = request.contains("begin") && !flag_of(request, "begin");
    if (!dragging) remember();
    ground.setup = station.placed.setup;
    station.placed = ground;
  } else if (what == "add") {
    if (stations_.size() >= max_stations)
      throw Error(Errc::invalid_argument,
                  "there are " + std::to_string(max_stations) + " stations, the most there may be");
    const PlacedStation ground = on_ground(request.value("to", json()));
    remember();
    stations_.push_back({.id = next_id_++, .placed = ground});
  } else if (what == "remove") {
    EditStation& station = with_id(request);
    if (station.locked) throw Error(Errc::invalid_argument, "this station is locked");
    remember();
    stations_.erase(stations_.begin() + (&station - stations_.data()));
  } else if (what == "lock") {
    EditStation& station = with_id(request);
    remember();
    station.locked = flag_of(request, "locked");
  } else if (what == "undo") {
    step(undo_, redo_);
  } else if (what == "redo") {
    step(redo_, undo_);
  } else {
    throw Error(Errc::invalid_argument, "'" + what + "' is not possible here");
  }
  if (what != "lock") measure();
  ++version_;
  if (!dragging || flag_of(request, "end")) keep_(stations_);
}

EditStation& EditSession::with_id(const json& request) {
  const auto id = request.find("id");
  for (EditStation& station : stations_)
    if (id != request.end() && *id == station.id) return station;
  throw Error(Errc::invalid_argument, "there is no such station any more");
}

PlacedStation EditSession::on_ground(const json& to) const {
  if (!to.is_array() || to.size() != 3) throw Error(Errc::invalid_argument, "to: three numbers are wanted");
  const Vec3 at{number_of(to[0], "x"), number_of(to[1], "y"), number_of(to[2], "z")};
  const auto uv = site_.area().project(at);
  if (!uv) throw Error(Errc::invalid_argument, "there is no ground to stand on");
  const double pair[] = {uv->u, uv->v};
  return place_stations(site_, pair).front();
}

std::vector<PlacedStation> EditSession::placed() const {
  std::vector<PlacedStation> stations;
  for (const EditStation& station : stations_) stations.push_back(station.placed);
  return stations;
}

Network EditSession::network() const { return to_network(placed()); }

void EditSession::remember() {
  undo_.push_back(stations_);
  if (undo_.size() > kMostUndo) undo_.erase(undo_.begin());
  redo_.clear();
}

void EditSession::step(std::vector<Stations>& from, std::vector<Stations>& to) {
  if (from.empty()) throw Error(Errc::invalid_argument, "there is nothing to undo or redo");
  to.push_back(std::move(stations_));
  stations_ = std::move(from.back());
  from.pop_back();
}

void EditSession::measure() {
  std::vector<std::uint32_t> ids;
  for (const EditStation& station : stations_) ids.push_back(station.id);
  const Network all = network();
  surveyed_.follow(all, ids);
  around_.follow(all, ids);
  static const std::vector<Objective> measures{make_objective("coverage"), make_objective("overlap")};
  const auto stations = placed();
  evaluation_ = evaluation_of({.counts = surveyed_.counts(),
                               .stations = stations,
                               .goal_density = simulator_.goal_density(),
                               .voxels = simulator_.voxel_count(),
                               .overlap = overlap_matrix(surveyed_.counts())},
                              measures, std::nullopt);
  evaluation_.scan_overlap_matrix = scan_overlap_matrix(around_.counts());
  evaluation_.link = options_.link;
  evaluation_.exact = false;  // links come from a sample, even if coverage does not
  colours_ = cell_colours(cells_, surveyed_.sample(), surveyed_.points(), surveyed_.seen_by(), simulator_);
}

void EditSession::start(const std::string& what, std::function<void(const Progress&)> work) {
  busy_ = what, done_ = 0;
  ++version_;
  stop_job_ = std::stop_source();
  job_ = std::jthread([this, work = std::move(work), stop = stop_job_.get_token()] {
    const auto report = [this](double done) {
      const std::scoped_lock lock(mutex_);
      done_ = done;
      ++version_;
    };
    std::string failure;
    try {
      work({.report = report, .stop = stop});
    } catch (const std::exception& error) {
      failure = error.what();
    }
    const std::scoped_lock lock(mutex_);
    busy_.clear();
    if (!failure.empty()) message_ = failure;
    ++version_;
  });
}

void EditSession::trace_exactly(const Progress& progress, const std::function<void(const Evaluation&)>& then) {
  const auto stations = placed();  // stays unchanged while this is busy
  if (std::ranges::none_of(stations, active)) throw Error(Errc::invalid_argument, "there is no station to trace");
  Evaluation exact = evaluate_stations({.simulator = simulator_, .surroundings = &surroundings_}, stations,
                                       {.field = true, .link = options_.link}, progress);
  if (exact.counts.cancelled) return;
  std::vector<std::uint32_t> points;
  std::vector<Seer> seen_by;
  for (const std::uint32_t rank : cells_.ranks) {
    points.push_back(exact.field.count[rank]);
    seen_by.push_back(seer_of(exact.field, rank));
  }
  CellColours colours = cell_colours(cells_, cells_.ranks, points, seen_by, simulator_);
  {
    const std::scoped_lock lock(mutex_);
    evaluation_ = exact, evaluation_.field = {}, colours_ = std::move(colours);
  }
  if (!then) return;
  then(exact);
  const std::scoped_lock lock(mutex_);
  message_ = "saved";
}

// Searches briefly from the present stations for more coverage, with links no weaker than now or than required.
void EditSession::improve(const Progress& progress) {
  std::vector<Vec3> kept, start;
  std::vector<StationSetup> existing_setups;
  std::set<std::uint32_t> scanners;  // of the movable stations
  for (const EditStation& s : stations_) {
    (s.locked ? kept : start).push_back(s.placed.position);
    if (s.locked)
      existing_setups.push_back(s.placed.setup);
    else
      scanners.insert(s.placed.setup.scanner);
  }
  if (start.empty()) throw Error(Errc::invalid_argument, "all stations are locked");
  const auto parts_now = [&] { return connectivity(evaluation_.scan_overlap_matrix, options_.link).parts; };
  const std::size_t parts = parts_now();
  const double weakest = connectivity(evaluation_.scan_overlap_matrix, 0).weakest_overlap;
  const double before = evaluation_.value("coverage");
  const std::string names[] = {"coverage"};
  SurveyProblem problem = survey_problem(names, start.size(), start.size());
  problem.existing = kept;
  problem.existing_setups = existing_setups;
  if (scanners.size() == 1) problem.scanners = {*scanners.begin()};
  Requirement linked = make_requirement("link>=0", problem.settings());
  linked.limit = stations_.size() > 1 ? std::min(weakest, options_.link) : 0;
  problem.requirements = {std::move(linked)};
  const PlanConfig config{.iterations = 1'000'000,
                          .sigma0 = 0.05,
                          .sample_voxels = surveyed_.sample().size(),
                          .start = start,
                          .max_seconds = options_.improve_seconds};
  std::stop_source abort;  // results are measured here, on the sample
  const auto watch = [&](const PlanProgress& now) {
    if (now.phase == "confirm") abort.request_stop();
    if (progress.report && now.iterations > 0) progress.report(0);
  };
  const PlanResult result =
      plan(site_, problem, config, {.report = watch, .stop = progress.stop, .abort = abort.get_token()});
  const std::scoped_lock lock(mutex_);
  const PlanEntry* best = result.front.empty() ? nullptr : &result.front[answer(result)];
  const auto nothing_better = [&] {
    message_ = "nothing better was found in " + std::to_string(static_cast<int>(options_.improve_seconds)) + " s";
  };
  if (!best || best->violation > 0 || best->value("coverage") <= before) return nothing_better();
  const Stations now = stations_;
  std::size_t next = kept.size();  // existing ones come first
  for (EditStation& s : stations_) {
    if (s.locked) continue;
    PlacedStation placed = best->stations[next++];
    placed.setup = s.placed.setup;
    s.placed = placed;
  }
  measure();
  // The search had them upright and, if they have several scanners, with the first one.
  const bool better = evaluation_.value("coverage") > before && parts_now() <= parts;
  std::vector<EditStation> found = std::exchange(stations_, now);
  if (!better) {
    measure();
    return nothing_better();
  }
  remember();
  stations_ = std::move(found);
  keep_(stations_);
  message_ = "improved";
}

}  // namespace vantage
