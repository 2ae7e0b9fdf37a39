// SPDX-License-Identifier: Apache-2.0
#include "edit/session.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "core/graph.hpp"
#include "core/text.hpp"
#include "evaluate/evaluator.hpp"
#include "placement/nearest_place.hpp"
#include "report/packed.hpp"
#include "report/report_json.hpp"
#include "taken/real_counts.hpp"
#include "vantage/candidates.hpp"
#include "vantage/error.hpp"
#include "vantage/planner.hpp"
#include "vantage/registration.hpp"

namespace vantage {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

constexpr std::size_t kMostUndo = 200;
constexpr std::uint64_t kCellVoxels = 200'000;  // from which cells are made
// Most stations of which the round and the registration error follow every change; of more, every ray tells them.
constexpr std::size_t kQuickStations = 100;

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

// The user's name of a station, without spaces around it; empty: none.
std::string checked_name(const std::string& given) {
  constexpr std::size_t kMost = 60;
  const auto from = given.find_first_not_of(' '), to = given.find_last_not_of(' ');
  std::string name = from == std::string::npos ? "" : given.substr(from, to - from + 1);
  if (name.size() > kMost || std::ranges::any_of(name, [](unsigned char c) { return c < 32 || c == 127; }))
    throw Error(Errc::invalid_argument, "a name has at most " + std::to_string(kMost) + " bytes on one line");
  return name;
}

bool flag_of(const json& request, const char* key) {
  const auto at = request.find(key);
  return at != request.end() && at->is_boolean() && at->get<bool>();
}

// Adds the standard error to each sampled link, and the number of voxels of the smaller scan that the link is a share
// of.
void add_errors(ordered_json& links, const NetworkCounts& around) {
  for (ordered_json& link : links) {
    const std::uint64_t of =
        std::min(around.seen.at(link.at("a").get<std::size_t>()), around.seen.at(link.at("b").get<std::size_t>()));
    const double share = link.at("value");
    link["voxels"] = of;
    link["error"] = of > 0 ? std::sqrt(std::max(share * (1 - share), 0.0) / static_cast<double>(of)) : 0.0;
  }
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
      on_site_(site.on_site(options.on_site)),
      stations_(stations),
      surveyed_(simulator_, options.voxels),
      around_(surroundings_, options.link_voxels) {
  // Made now, since the site's parts are read from several threads later.
  site_.area(), site_.clash();
  for (EditStation& station : stations_) station.id = next_id_++;
  measure();
  if (options_.attainable_voxels > 0 && simulator_.voxel_count() > 0)
    start("looking at what can be captured", [this](const Progress& progress) { look(progress); });
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
  if (!evaluation_.exact && network.contains("links")) add_errors(network["links"], around_.counts());
  ordered_json json = {{"version", version_.load()},
                       {"network", std::move(network)},
                       {"ids", std::move(ids)},
                       {"locked", std::move(locked)},
                       {"coverage", packed(colours_.coverage)},
                       {"only", packed(colours_.only)},
                       {"hidden", hidden_.empty() ? ordered_json() : ordered_json(packed(hidden_))},
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
  static const std::map<std::string, Command> commands{{"move", &EditSession::move_station},
                                                       {"add", &EditSession::add_station},
                                                       {"remove", &EditSession::remove_station},
                                                       {"lock", &EditSession::lock_station},
                                                       {"rename", &EditSession::rename_station},
                                                       {"undo", &EditSession::undo},
                                                       {"redo", &EditSession::redo},
                                                       {"exact", &EditSession::start_exact},
                                                       {"improve", &EditSession::start_improving},
                                                       {"save", &EditSession::start_saving}};
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
  const auto command = commands.find(what);
  if (command == commands.end()) throw Error(Errc::invalid_argument, "'" + what + "' is not possible here");
  const std::optional<Changed> changed = (this->*command->second)(request);
  if (!changed) return;
  if (changed->needs == Changed::names) evaluation_.names = names();
  if (changed->needs == Changed::figures) measure(changed->quick);
  ++version_;
  if (changed->keep) keep_(stations_);
}

std::optional<EditSession::Changed> EditSession::start_exact(const json&) {
  start("tracing every ray", [this](const Progress& progress) { trace_exactly(progress, {}); });
  return std::nullopt;
}

std::optional<EditSession::Changed> EditSession::start_improving(const json&) {
  start("improving unlocked stations", [this](const Progress& progress) { improve(progress); });
  return std::nullopt;
}

std::optional<EditSession::Changed> EditSession::start_saving(const json&) {
  keep_(stations_);
  start("saving", [this](const Progress& progress) {
    trace_exactly(progress, [&](const Evaluation& exact) { return save_(exact, progress); });
  });
  return std::nullopt;
}

std::optional<EditSession::Changed> EditSession::move_station(const json& request) {
  const bool end = flag_of(request, "end");
  if (end) keep_(stations_);  // the drag so far, in case it ends off the ground
  EditStation& station = with_id(request);
  if (station.locked) throw Error(Errc::invalid_argument, "this station is locked");
  const std::string name = names()[static_cast<std::size_t>(&station - stations_.data())];
  const bool goes_on = request.contains("end") && !end;
  auto ground = put(request.value("to", json()), name, goes_on);
  if (!ground) throw Error(Errc::invalid_argument, "there is no ground to stand on");
  const bool dragging = request.contains("begin") && !flag_of(request, "begin");
  if (!dragging) remember();
  ground->setup = station.placed.setup;
  station.placed = *ground;
  return Changed{.quick = goes_on, .keep = !dragging || end};
}

std::optional<EditSession::Changed> EditSession::add_station(const json& request) {
  if (stations_.size() >= max_stations)
    throw Error(Errc::invalid_argument,
                "there are " + std::to_string(max_stations) + " stations, the most there may be");
  const auto ground = put(request.value("to", json()), "the new station", false);
  if (!ground) throw Error(Errc::invalid_argument, "there is no ground to stand on");
  if (ground->status != StationStatus::ok) {
    message_.clear();
    throw Error(Errc::invalid_argument,
                "no station may stand here: no place within " + number(nearest_place_reach_m) + " m is free");
  }
  remember();
  stations_.push_back({.id = next_id_++, .placed = *ground});
  return Changed{};
}

std::optional<EditSession::Changed> EditSession::remove_station(const json& request) {
  EditStation& station = with_id(request);
  if (station.locked) throw Error(Errc::invalid_argument, "this station is locked");
  remember();
  stations_.erase(stations_.begin() + (&station - stations_.data()));
  return Changed{};
}

std::optional<EditSession::Changed> EditSession::lock_station(const json& request) {
  EditStation& station = with_id(request);
  if (station.placed.existing) throw Error(Errc::invalid_argument, "a scan was taken here: it stays locked");
  remember();
  station.locked = flag_of(request, "locked");
  return Changed{.needs = Changed::nothing};
}

std::optional<EditSession::Changed> EditSession::rename_station(const json& request) {
  const auto name = request.find("name");
  if (name == request.end() || !name->is_string()) throw Error(Errc::invalid_argument, "name: a text is wanted");
  EditStation& station = with_id(request);
  std::string text = checked_name(*name);
  remember();
  station.name = std::move(text);
  return Changed{.needs = Changed::names};
}

std::optional<EditSession::Changed> EditSession::undo(const json&) {
  step(undo_, redo_);
  return Changed{};
}

std::optional<EditSession::Changed> EditSession::redo(const json&) {
  step(redo_, undo_);
  return Changed{};
}

bool EditSession::take(std::span<const TakenScan> scans) {
  const std::scoped_lock lock(mutex_);
  if (!busy_.empty()) return false;
  message_.clear();
  // Numbers count planned and existing stations apart; a station keeps what the crew calls it.
  const std::vector<std::string> now = names();
  for (std::size_t k = 0; k < stations_.size(); ++k) stations_[k].name = now[k];
  for (const TakenScan& scan : scans) message_ += (message_.empty() ? "" : "; ") + take(scan);
  undo_.clear(), redo_.clear();  // what was taken cannot be undone
  measure();
  ++version_;
  keep_(stations_);
  return true;
}

// Returns a sentence on it.
std::string EditSession::take(const TakenScan& scan) {
  const auto distance = [&](const EditStation& station) {
    const Vec3 apart = station.placed.position - scan.head;
    return station.placed.existing ? std::numeric_limits<double>::infinity() : std::sqrt(dot(apart, apart));
  };
  auto at = std::ranges::min_element(stations_, {}, distance);
  if (at == stations_.end() || distance(*at) > options_.taken_within_m) {
    // A planned station keeps its name.
    std::string name = scan.name;
    if (std::ranges::find(stations_, name, &EditStation::name) != stations_.end()) name += ", taken";
    at = stations_.insert(stations_.end(), EditStation{.id = next_id_++, .placed = {}, .name = std::move(name)});
  }
  EditStation& station = *at;
  station.placed = site_.place_head(scan.head).station;
  station.placed.existing = true, station.locked = true;
  station.placed.setup = scan.setup, station.placed.setup.scanner = 0;
  surveyed_.set_real(station.id, RealCounts(simulator_, surveyed_.sample(), options_.tolerance_m).of(scan));
  // Existing stations come first, as everywhere.
  const auto first = std::ranges::find_if(stations_, [](const EditStation& s) { return !s.placed.existing; });
  const std::uint32_t id = station.id;
  if (first < at) std::rotate(first, at, at + 1);
  const auto now = std::ranges::find(stations_, id, &EditStation::id);
  const std::string name = names()[static_cast<std::size_t>(now - stations_.begin())];
  return name + " is taken, " + grouped(scan.points) + " points" +
         (scan.fit.fitted ? "; it was moved by " + fixed(100 * scan.fit.shift_m, 1) + " cm onto the model"
                          : "; it " + scan.fit.why);
}

void EditSession::tell(const std::string& message) {
  const std::scoped_lock lock(mutex_);
  message_ = message;
  ++version_;
}

EditStation& EditSession::with_id(const json& request) {
  const auto id = request.find("id");
  for (EditStation& station : stations_)
    if (id != request.end() && *id == station.id) return station;
  throw Error(Errc::invalid_argument, "there is no such station any more");
}

std::optional<PlacedStation> EditSession::put(const json& to, const std::string& name, bool exactly) {
  if (!to.is_array() || to.size() != 3) throw Error(Errc::invalid_argument, "to: three numbers are wanted");
  const Vec3 at{number_of(to[0], "x"), number_of(to[1], "y"), number_of(to[2], "z")};
  std::optional<PlacedStation> placed;
  if (const auto uv = site_.area().project(at)) {
    const double pair[] = {uv->u, uv->v};
    placed = place_stations(site_, pair).front();
  }
  if (exactly || (placed && placed->status == StationStatus::ok)) return placed;
  const Vec3 head = placed ? placed->position : at + Vec3{0, 0, simulator_.scanner().height_m};
  const StationMove move{.to = site_.nearest_place(head)};
  if (!move.to) {
    if (placed) message_ = name + " " + explain(placed->status) + ": " + move_text(head, move);
    return placed;
  }
  message_ = name + " may not stand there: it was put " + offset_text(head, move.to->position) +
             " of it, where the nearest free place is";
  return move.to;
}

std::vector<std::string> EditSession::names() const {
  std::vector<std::string> given;
  for (const EditStation& station : stations_) given.push_back(station.name);
  return station_names(placed(), given);
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

void EditSession::measure(bool quick) {
  std::vector<std::uint32_t> ids;
  for (const EditStation& station : stations_) ids.push_back(station.id);
  const Network all = network();
  surveyed_.follow(all, ids);
  around_.follow(all, ids);
  std::vector<Objective> measures{make_objective("coverage"), make_objective("overlap")};
  const std::optional<Estimate> share = captured();
  if (share) measures.push_back(make_objective("capture"));
  const auto stations = placed();
  evaluation_ = Evaluator({.simulator = simulator_, .surroundings = &surroundings_},
                          {.target = with_class_of(site_.options(), {}), .link = options_.link, .names = names()},
                          std::move(measures))
                    .evaluate({.stations = stations,
                               .surveyed = surveyed_.counts(),
                               .surroundings = &around_.counts(),
                               .captured = {.all = share.value_or(Estimate{})}});
  evaluation_.exact = false;  // links come from a sample, even if coverage does not
  if (!quick) {
    if (stations.size() <= kQuickStations && !stations.empty()) {
      evaluation_.visit = visit_of(stations, evaluation_.links(), *on_site_);
      if (const auto error_mm = registered(all)) evaluation_.values["registration"] = *error_mm;
    }
    look_closer(evaluation_,
                {.simulator = simulator_, .on_site = &*on_site_, .clash = &site_.clash(), .area = &site_.area()});
  }
  colours_ = cell_colours(cells_, surveyed_.sample(), surveyed_.points(), surveyed_.seen_by(), simulator_);
}

// The share that the stations capture as they stand, as `evaluate_stations` has it for the same attainable counts.
std::optional<Estimate> EditSession::captured() const {
  if (!attainable_) return std::nullopt;
  // The voxels of a smaller sample are among those of the larger one.
  const std::vector<std::uint32_t>& sample = surveyed_.sample();
  std::vector<std::size_t> at;
  for (const std::uint32_t voxel : attainable_->voxels())
    at.push_back(static_cast<std::size_t>(std::ranges::lower_bound(sample, voxel) - sample.begin()));
  const auto of_sample = [&](std::span<const std::uint32_t> points) {
    std::vector<std::uint32_t> some;
    for (const std::size_t k : at) some.push_back(points[k]);
    return some;
  };
  AttainableCounts attainable = *attainable_;
  for (const auto points : surveyed_.single_points()) attainable.raise(of_sample(points));
  return attainable.captured(of_sample(surveyed_.points()));
}

std::optional<Estimate> EditSession::registered(const Network& network) const {
  if (std::ranges::count(network, true, &Station::active) < 2 || simulator_.voxel_count() == 0) return std::nullopt;
  const std::uint64_t voxels = std::min(options_.registration_voxels, simulator_.voxel_count());
  RegistrationOptions options = levelled_by(options_.registration, simulator_.scanners());
  options.surfaces = RegistrationSurfaces::surveyed;
  const NetworkCounts counts =
      simulator_.evaluate_sampled({&network, 1}, {.voxels = voxels, .registration = options.model}).front();
  const Estimate rms = registration_estimate(counts, simulator_.voxel_count(), options);
  return Estimate{1000 * rms.value, 1000 * rms.standard_error};
}

// Finds what can be captured from anywhere. False if stopped.
bool EditSession::look(const Progress& progress) {
  const std::uint64_t voxels =
      std::min<std::uint64_t>(options_.attainable_voxels, surveyed_.sample().size());  // constant after construction
  const Candidates found = find_candidates(site_, {.sample_voxels = voxels}, progress);
  if (found.ended() == "cancelled") return false;
  const AttainableCounts& counts = found.attainable_counts();
  std::vector<VoxelStatus> status;
  for (const double count : counts.counts())
    status.push_back({.why = count > 0 ? WhyMissed::captured : WhyMissed::hidden});
  const std::scoped_lock lock(mutex_);
  hidden_ = cell_reasons(cells_, counts.voxels(), status);
  for (std::uint8_t& reason : hidden_)
    if (reason != static_cast<std::uint8_t>(WhyMissed::hidden)) reason = 255;
  attainable_ = counts;
  measure();
  return true;
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

void EditSession::trace_exactly(const Progress& progress, const std::function<std::string(const Evaluation&)>& then) {
  const auto stations = placed();  // stays unchanged while this is busy
  if (std::ranges::none_of(stations, active)) throw Error(Errc::invalid_argument, "there is no station to trace");
  if (options_.attainable_voxels > 0 && !attainable_ && !look(progress)) return;
  Evaluation exact = evaluate_stations({.simulator = simulator_,
                                        .surroundings = &surroundings_,
                                        .on_site = &*on_site_,
                                        .clash = &site_.clash(),
                                        .area = &site_.area()},
                                       stations,
                                       {.field = true,
                                        .registration = options_.registration,
                                        .target = with_class_of(site_.options(), {}),
                                        .attainable = attainable_ ? &*attainable_ : nullptr,
                                        .link = options_.link,
                                        .names = names()},
                                       progress);
  if (exact.counts.cancelled) return;
  std::vector<std::uint32_t> points;
  std::vector<Seer> seen_by;
  for (const std::uint32_t voxel : cells_.voxels) {
    points.push_back(exact.field.count[voxel]);
    seen_by.push_back(seer_of(exact.field, voxel));
  }
  CellColours colours = cell_colours(cells_, cells_.voxels, points, seen_by, simulator_);
  {
    const std::scoped_lock lock(mutex_);
    evaluation_ = exact, evaluation_.field = {}, colours_ = std::move(colours);
    if (std::ranges::any_of(stations, &PlacedStation::existing))
      message_ = "every ray is simulated, also where scans were taken";
  }
  if (!then) return;
  std::string told = then(exact);
  const std::scoped_lock lock(mutex_);
  message_ = std::move(told);
}

// Moves single stations to evenly spread places until no move lowers the number of components. It records no undo step.
// Returns true if it moved any. Links are those of the sample.
bool EditSession::mend(const Progress& progress) {
  const auto parts_now = [&] { return connectivity(evaluation_.scan_overlap_matrix, options_.link).parts; };
  // Keeps the setup, and returns where it stood.
  const auto move_to = [&](std::size_t station, const PlacedStation& place) {
    const PlacedStation before = std::exchange(stations_[station].placed, place);
    stations_[station].placed.setup = before.setup;
    return before;
  };
  bool moved = false;
  // A station that is left out is a component of its own.
  while (stations_.size() > 1 && parts_now() > 1 && !progress.stopped()) {
    constexpr std::size_t kPlaces = 256;
    if (places_.empty()) places_ = candidate_positions(site_, kPlaces);
    std::vector<PlacedStation> all = placed();
    const std::size_t n = all.size();
    all.insert(all.end(), places_.begin(), places_.end());
    const StationGraph graph = overlap_graph(surroundings_, all, options_.link_voxels, progress);
    struct Move {
      std::size_t station, place, parts;
      double away_m;
    };
    std::vector<Move> moves;
    for (std::size_t m = 0; m < n && !progress.stopped(); ++m) {
      if (stations_[m].locked) continue;
      // The station counts without its links, and so is a component of its own.
      const Components part = components(
          n, [&](std::size_t i, std::size_t j) { return i != m && j != m && graph.linked(i, j, options_.link); });
      for (std::size_t p = 0; p < places_.size(); ++p) {
        std::set<std::size_t> joined;
        for (std::size_t k = 0; k < n; ++k)
          if (k != m && graph.linked(n + p, k, options_.link)) joined.insert(part.of[k]);
        const std::size_t parts = part.count - joined.size();
        if (parts >= parts_now()) continue;
        const Vec3 by = places_[p].position - stations_[m].placed.position;
        moves.push_back({m, p, parts, std::sqrt(dot(by, by))});
      }
    }
    if (progress.stopped()) break;
    // Prefers the fewest components, then the shortest move; each station has one move.
    std::ranges::sort(moves, [](const Move& a, const Move& b) {
      return std::tuple(a.parts, a.away_m, a.station, a.place) < std::tuple(b.parts, b.away_m, b.station, b.place);
    });
    std::set<std::size_t> told;
    std::erase_if(moves, [&](const Move& move) { return !told.insert(move.station).second; });
    const std::scoped_lock lock(mutex_);
    const std::size_t parts = parts_now();
    constexpr std::size_t kTried = 20;
    const Move* best = nullptr;
    double most = -1;
    for (std::size_t k = 0; k < moves.size() && k < kTried; ++k) {
      if (best && moves[k].parts > best->parts) break;
      const PlacedStation before = move_to(moves[k].station, places_[moves[k].place]);
      measure(true);  // the noise of a place may undo a link that just holds
      if (parts_now() < parts && evaluation_.value("coverage") > most)
        best = &moves[k], most = evaluation_.value("coverage");
      move_to(moves[k].station, before);
    }
    const bool better = best != nullptr;
    if (best) move_to(best->station, places_[best->place]);
    measure();
    if (!better) break;
    moved = true;
  }
  return moved;
}

// Mends links, then searches briefly from the present stations for more coverage, with links no weaker than they are
// then or than required.
void EditSession::improve(const Progress& progress) {
  const Stations first = stations_;
  if (std::ranges::all_of(stations_, &EditStation::locked))
    throw Error(Errc::invalid_argument, "all stations are locked");
  const auto begin = [this](const char* what) {
    const std::scoped_lock lock(mutex_);
    busy_ = what, done_ = 0;
    ++version_;
  };
  begin("mending links");
  const bool mended = mend(progress);
  begin("improving the others");
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
  const auto parts_now = [&] { return connectivity(evaluation_.scan_overlap_matrix, options_.link).parts; };
  const std::size_t parts = parts_now();
  const double weakest = connectivity(evaluation_.scan_overlap_matrix, 0).weakest_overlap;
  const double before = evaluation_.value("coverage");
  const std::string names[] = {"coverage"};
  SurveyProblem problem = survey_problem(names, start.size(), start.size());
  problem.existing = kept;
  problem.existing_setups = existing_setups;
  if (scanners.size() == 1) problem.scanners = {site_.scanners()[*scanners.begin()]};
  Requirement linked = make_requirement("link>=0", problem.settings());
  linked.limit = stations_.size() > 1 ? std::min(weakest, options_.link) : 0;
  problem.requirements = {std::move(linked)};
  const PlanConfig config{.iterations = 1'000'000,
                          .sigma0 = 0.05,
                          .sample_voxels = surveyed_.sample().size(),
                          .start = start,
                          .max_seconds = options_.improve_seconds};
  std::stop_source abort;  // results are measured here, on the sample
  const auto began = std::chrono::steady_clock::now();
  const auto watch = [&](const PlanProgress& now) {
    if (now.phase == "confirm") abort.request_stop();
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - began;
    if (progress.report) progress.report(std::min(1.0, passed.count() / options_.improve_seconds));
  };
  const PlanResult result =
      plan(site_, problem, config, {.report = watch, .stop = progress.stop, .abort = abort.get_token()});
  const std::scoped_lock lock(mutex_);
  const PlanEntry* best = result.front.empty() ? nullptr : &result.front[answer(result)];
  bool better = best && best->violation == 0 && best->value("coverage") > before;
  if (better) {
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
    better = evaluation_.value("coverage") > before && parts_now() <= parts;
    if (!better) {
      stations_ = now;
      measure();
    }
  }
  if (better || mended) {
    undo_.push_back(first), redo_.clear();
    keep_(stations_);
  }
  if (mended) {
    message_ = parts == 1 ? "all stations are linked now" : "better linked, in " + std::to_string(parts) + " parts";
    message_ += better ? ", and more is captured" : "";
  } else if (better) {
    message_ = "improved";
  } else {
    message_ = "nothing better was found in " + std::to_string(static_cast<int>(options_.improve_seconds)) + " s";
  }
  if (parts > 1)
    message_ += "; no single move of a station links the " + std::to_string(parts) + " parts: add one between";
}

}  // namespace vantage
