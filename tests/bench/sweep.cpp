// SPDX-License-Identifier: Apache-2.0
#include "sweep.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>
#include <set>
#include <utility>

#include "bench_site.hpp"
#include "core/parse.hpp"
#include "core/text.hpp"
#include "map/chart.hpp"
#include "map/plan_map.hpp"
#include "placement/in_the_way.hpp"
#include "sight.hpp"
#include "sites/random_site.hpp"
#include "support/temporary_folder.hpp"
#include "vantage/candidates.hpp"
#include "vantage/cover.hpp"
#include "vantage/error.hpp"
#include "vantage/export.hpp"
#include "vantage/question.hpp"

namespace vantage::bench {
namespace {

using test::KnownSite;
using test::Place;
using test::Surface;

// Surfaces end up to this far from what stands on them, so a station may be that far off the true floor.
constexpr double kEdge_m = 0.25;
// A room without a station is left out if less of it is captured than this share of what is captured of the site.
constexpr double kRoomShare = 0.7;
// Least distance of stations that see each other, as a share of the median distance to what the station sees.
constexpr double kNearest = 0.25;
// A link is through a wall if scans share less than this part of the wanted overlap by rays.
constexpr double kTrueLink = 0.5;
constexpr std::size_t kSpots = 20'000;
// Side of the square of floor that a person gives each station at most (see `rule_of_thumb`).
constexpr double kFloorEach_m = 10;
constexpr double kCapture = 0.9;  // asked of each plan
constexpr double kBoundSeconds = 20;

// A site of the sweep, with the truth about it unless it is a file.
struct SweptSite {
  std::string name, told;
  std::filesystem::path file;
  SceneOptions scene = {};
  std::optional<KnownSite> truth = std::nullopt;
  std::set<std::string> shut = {};
};

SweptSite random_site(std::uint64_t seed, const std::filesystem::path& folder) {
  const test::RandomSite random = test::make_random_site(seed);
  SweptSite site{.name = std::to_string(seed), .told = random.told, .file = folder / (std::to_string(seed) + ".glb")};
  write_site(random, site.file);
  site.truth = random.site, site.shut = random.shut;
  for (const Unit unit : {Unit::metre, Unit::centimetre, Unit::millimetre, Unit::inch, Unit::foot})
    if (std::abs(random.variant.per_metre * metres_in(unit) - 1) < 1e-6) site.scene.unit = unit;
  site.scene.up = random.variant.z_up ? UpAxis::z : UpAxis::y;
  return site;
}

std::vector<SweptSite> swept_sites(const SweepOptions& options, const std::filesystem::path& folder) {
  std::vector<SweptSite> sites;
  for (const std::string& text : options.sites) {
    if (std::isdigit(static_cast<unsigned char>(text.front())) != 0 &&
        text.find_first_not_of("0123456789.") == std::string::npos) {
      const CountRange seeds = parse_count_range(text, "the seeds of random sites", 0, 1'000'000);
      for (std::size_t seed = seeds.low; seed <= seeds.high; ++seed) sites.push_back(random_site(seed, folder));
    } else if (std::ranges::find(test::site_names(), text) != test::site_names().end()) {
      SweptSite site{.name = text, .told = "reference site", .file = folder / (text + ".glb")};
      site.truth = test::make_site(text);
      write_site(*site.truth, {}, site.file);
      sites.push_back(std::move(site));
    } else {
      SweptSite site{.name = std::filesystem::path(text).stem().string(), .told = "file", .file = text};
      if (options.unit) site.scene.unit = unit_from_string(*options.unit);
      if (options.up) site.scene.up = up_axis_from_string(*options.up);
      sites.push_back(std::move(site));
    }
  }
  return sites;
}

// A network and its figures.
struct Judged {
  std::size_t stations = 0;
  double captured = 0, link = 0;  // weakest link of the tree; 0 if there is none
  bool linked = false;
};

struct Score {
  Judged plan;
  double ground_m2 = 0, seconds = 0;
  std::size_t at_least = 0, greedy = 0, by_thumb = 0;
  std::size_t rooms = 0, visited = 0;  // true ones that a path leads to
  std::vector<std::string> left_out;   // rooms, neither visited nor captured from others
  std::size_t off_ground = 0, in_the_way = 0, near_pairs = 0, links = 0, through_walls = 0;
  bool on_plane = false;
  double closed = 0;  // the largest share of floor that is closed, not planned, and left to the user to decide
  bool met = false;
};

double area_of(const Place& place) { return (place.x1 - place.x0) * (place.y1 - place.y0); }

double area_of(const SearchMesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3 normal = cross(mesh.positions[t[1]] - mesh.positions[t[0]], mesh.positions[t[2]] - mesh.positions[t[0]]);
    sum += std::sqrt(dot(normal, normal)) / 2;
  }
  return sum;
}

bool within(const Place& place, const Vec3& p, double low, double high) {
  return p.x >= place.x0 && p.x <= place.x1 && p.y >= place.y0 && p.y <= place.y1 && p.z >= place.z + low &&
         p.z <= place.z + high;
}

std::vector<Place> open_rooms(const SweptSite& site) {
  std::vector<Place> rooms;
  if (site.truth)
    for (const Place& place : site.truth->places)
      if (!site.shut.contains(place.name)) rooms.push_back(place);
  return rooms;
}

// `entered`: parts without a path to them are planned, too, and the result says so.
bool stands_off(const SweptSite& site, const Vec3& ground, bool entered) {
  const auto off = [&](const Vec3& p) {
    const test::Standing standing = site.truth->at(p);
    return standing.surface != Surface::floor || (site.shut.contains(standing.place) && !entered);
  };
  for (const Vec3& aside : {Vec3{}, {kEdge_m, 0, 0}, {-kEdge_m, 0, 0}, {0, kEdge_m, 0}, {0, -kEdge_m, 0}})
    if (!off(ground + aside)) return false;
  return true;
}

// Stations that a person without a model would take. Each gets a square of floor, of 10 m or, if less, the distance at
// which its points are as dense as wanted. One a room and one for each such square of a larger one; one in a doorway
// between each two rooms on the path; one for each such square of other ground.
std::size_t rule_of_thumb(const std::vector<Place>& rooms, double ground_m2, const Scanner& scanner, double spacing_m) {
  const double side = std::min(kFloorEach_m, spacing_m / scanner.azimuth_step.in_radians());
  const auto stations_on = [&](double m2) { return static_cast<std::size_t>(std::ceil(m2 / (side * side))); };
  std::size_t sum = 0, doorways = 0;
  double inside = 0;
  for (const Place& room : rooms) {
    inside += area_of(room);
    sum += std::max<std::size_t>(1, stations_on(area_of(room)));
    doorways += room.outdoors ? 0 : 1;
  }
  sum += doorways > 0 ? doorways - 1 : 0;
  return std::max<std::size_t>(1, sum + (ground_m2 > inside ? stations_on(ground_m2 - inside) : 0));
}

// Rooms without a station that others capture badly.
std::vector<std::string> rooms_left_out(const SweptSite& swept, Site& site, const PlanEntry& entry,
                                        const std::vector<Place>& unvisited) {
  std::vector<std::string> names;
  if (unvisited.empty()) return names;
  Simulator& simulator = site.simulator();
  VoxelField field;
  const NetworkCounts counts = simulator.evaluate(to_network(entry.stations), {.overlap = false, .field = &field});
  const double whole = coverage(counts, simulator.goal_density());
  for (const Place& place : unvisited) {
    double sum = 0, count = 0;
    for (std::uint64_t v = 0; v < simulator.voxel_count(); ++v) {
      if (!within(place, simulator.voxel_centre(v) - swept.truth->offset, -0.5 * simulator.voxel_size_m(), 2)) continue;
      sum += std::min(1.0, field.count[v] / simulator.goal_density());
      ++count;
    }
    if (count > 0 && sum < kRoomShare * whole * count) names.push_back(place.name);
  }
  return names;
}

void judge_ground(const SweptSite& swept, Site& site, const PlanEntry& entry, Score& score) {
  const std::vector<Place> rooms = open_rooms(swept);
  score.ground_m2 = area_of(site.area().mesh());
  score.by_thumb = rule_of_thumb(rooms, score.ground_m2, site.scanner(), site.simulator_config().point_spacing_m);
  score.on_plane = site.area().on_plane();
  for (const ClosedPart& part : site.area().not_entered())
    if (part.to_decide() && part.kind != ClosedKind::hollow) score.closed = std::max(score.closed, part.share);
  score.in_the_way = static_cast<std::size_t>(std::ranges::count_if(
      entry.stations, [&](const PlacedStation& station) { return in_the_way(site.clash(), station.ground); }));
  if (!swept.truth) return;
  std::vector<Place> unvisited;
  for (const Place& place : rooms) {
    const bool visited = std::ranges::any_of(entry.stations, [&](const PlacedStation& station) {
      return within(place, station.ground - swept.truth->offset, -0.2, 0.5);
    });
    if (!visited) unvisited.push_back(place);
  }
  score.rooms = rooms.size(), score.visited = rooms.size() - unvisited.size();
  score.left_out = rooms_left_out(swept, site, entry, unvisited);
  score.off_ground = static_cast<std::size_t>(std::ranges::count_if(entry.stations, [&](const PlacedStation& station) {
    return stands_off(swept, station.ground, !site.area().entered().empty());
  }));
}

void judge_sight(Site& site, const PlanEntry& entry, const StationLinks& links, double wanted, Score& score) {
  const Sight sight(site.scene().data(), site.scanner(), site.simulator_config().point_spacing_m, kSpots);
  std::vector<Sight::View> views;
  for (const PlacedStation& station : entry.stations) views.push_back(sight.from(station.position));
  for (std::size_t i = 0; i < views.size(); ++i)
    for (std::size_t j = i + 1; j < views.size(); ++j) {
      const Vec3 &a = entry.stations[i].position, &b = entry.stations[j].position;
      if (std::sqrt(dot(a - b, a - b)) < kNearest * std::min(views[i].median_m, views[j].median_m) && sight.free(a, b))
        ++score.near_pairs;
      if (links.values(i, j) < wanted) continue;
      ++score.links;
      if (shared(views[i], views[j]) < kTrueLink * wanted) ++score.through_walls;
    }
}

// `capture`: share that the number of stations is judged for.
void judge_number(const PlanResult& result, double capture, Score& score) {
  const CoverageMatrix matrix = result.candidates->captured_matrix();
  const StationsBound bound = min_cover({.matrix = matrix, .coverage = capture}, {.max_seconds = kBoundSeconds});
  score.at_least = bound.at_least, score.greedy = bound.chosen.size();
}

Judged judged(const Evaluation& network) {
  Judged found{.stations = network.stations.size(), .captured = network.value("capture")};
  if (const auto links = network.links()) {
    found.linked = links->parts.size() == 1;
    found.link = found.linked ? (found.stations > 1 ? links->weakest_value : 1) : 0;
  }
  return found;
}

// The plan of a site on a tile: its levels side by side.
std::unique_ptr<Canvas> tile_of(Site& site, const PlanEntry& entry, const std::string& title) {
  constexpr double kWidth = 900, kHeight = 640, kTop = 60, kLeft = 70, kGap = 20;
  auto tile = std::make_unique<Canvas>(kWidth, kHeight);
  const PlanView view{.scene = site.scene(),
                      .area = site.area(),
                      .stations = entry.stations,
                      .names = station_names(entry.stations),
                      .links = *entry.links(),
                      .title = title};
  const Box window = plan_window(view);
  const std::vector<PlanLevel> levels = cut_levels(view.scene, view.area.mesh(), view.stations);
  const auto count = static_cast<double>(levels.size());
  const double wide = (kWidth - kGap) / count - kLeft;
  const double metre = std::min(wide / window.size().x, (kHeight - kTop - 60) / window.size().y);
  for (std::size_t k = 0; k < levels.size(); ++k)
    draw_plan_map(
        *tile,
        {kLeft + static_cast<double>(k) * (wide + kLeft), kTop, window.size().x * metre, window.size().y * metre}, view,
        window, levels[k], k == 0 ? title : "", levels.size() > 1 ? "z = " + fixed(levels[k].floor, 1) + " m" : "");
  return tile;
}

void draw_sheet(const std::filesystem::path& file, const std::vector<std::unique_ptr<Canvas>>& tiles) {
  if (tiles.empty()) return;
  constexpr std::size_t kColumns = 3;
  constexpr double kWide = 480;
  const double high = kWide * tiles.front()->height() / tiles.front()->width();
  const std::size_t rows = (tiles.size() + kColumns - 1) / kColumns;
  Canvas sheet(kColumns * kWide, static_cast<double>(rows) * high);
  for (std::size_t k = 0; k < tiles.size(); ++k)
    sheet.page({static_cast<double>(k % kColumns) * kWide, static_cast<double>(k / kColumns) * high, kWide, high},
               *tiles[k]);
  sheet.save(file);
}

// A table as CSV and as Markdown, from the same cells.
class Table {
 public:
  explicit Table(std::vector<std::string> heads) { add(std::move(heads)); }
  void add(std::vector<std::string> cells) { rows_.push_back(std::move(cells)); }
  void write(const std::filesystem::path& folder, const std::string& name) const {
    std::string csv, markdown;
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      markdown += "|";
      for (std::size_t c = 0; c < rows_[r].size(); ++c) {
        csv += (c > 0 ? "," : "") + ("\"" + rows_[r][c] + "\"");
        markdown += " " + rows_[r][c] + " |";
      }
      csv += "\n", markdown += "\n";
      if (r > 0) continue;
      markdown += "|";
      for (std::size_t c = 0; c < rows_[r].size(); ++c) markdown += " --- |";
      markdown += "\n";
    }
    write_text(folder / (name + ".csv"), csv);
    write_text(folder / (name + ".md"), markdown);
  }

 private:
  std::vector<std::vector<std::string>> rows_;
};

std::vector<std::string> cells(const SweptSite& site, const Score& score) {
  const bool known = score.rooms > 0;
  return {site.name,
          site.told,
          fixed(score.ground_m2, 0),
          number(score.plan.stations),
          number(score.at_least),
          number(score.greedy),
          number(score.by_thumb),
          known ? number(score.visited) + " of " + number(score.rooms) : "–",
          known ? number(score.left_out.size()) : "–",
          site.truth ? number(score.off_ground) : "–",
          number(score.in_the_way),
          number(score.near_pairs),
          number(score.through_walls) + " of " + number(score.links),
          score.plan.linked ? "yes" : "no",
          percent(score.plan.captured),
          score.met ? "yes" : "no",
          fixed(score.seconds, 0)};
}

// Least number of steps without a link of any round from `first` and back that is no longer than `most_m`, by dynamic
// programming over sets (Held and Karp: A Dynamic Programming Approach to Sequencing Problems, 1962); `known` if it is
// no smaller. Empty if the stations are too many for that.
std::optional<std::size_t> least_unlinked(const StationLinks& links, const std::vector<std::vector<float>>& metres,
                                          std::size_t first, float most_m, std::size_t known) {
  constexpr std::size_t kMostStations = 20, kMostStates = std::size_t{1} << 26;
  const std::size_t stations = metres.size();
  if (stations > kMostStations || (stations * known << stations) > kMostStates) return std::nullopt;
  const std::size_t sets = std::size_t{1} << stations;
  // Shortest walk by visited set, last station and steps without a link: fewer than `known`.
  constexpr float kNone = std::numeric_limits<float>::infinity();
  std::vector<float> least(sets * stations * known, kNone);
  const auto at = [&](std::size_t set, std::size_t last) { return (set * stations + last) * known; };
  if (known > 0) least[at(std::size_t{1} << first, first)] = 0;
  for (std::size_t set = 1; set < sets; ++set)
    for (std::size_t last = 0; last < stations; ++last)
      for (std::size_t next = 0; next < stations; ++next) {
        if (set >> next & 1) continue;
        const bool linked = links.values(last, next) >= links.least && links.values(last, next) > 0;
        for (std::size_t u = 0; u + (linked ? 0 : 1) < known; ++u) {
          float& there = least[at(set | std::size_t{1} << next, next) + u + (linked ? 0 : 1)];
          there = std::min(there, least[at(set, last) + u] + metres[last][next]);
        }
      }
  for (std::size_t u = 0; u < known; ++u)
    for (std::size_t last = 0; last < stations; ++last)
      if (least[at(sets - 1, last) + u] + metres[last][first] <= most_m) return u;
  return known;
}

// The round of a plan, and the shortest one found without regard to links.
std::vector<std::string> round_cells(const SweptSite& swept, Site& site, const PlanEntry& entry,
                                     const StationLinks& links) {
  constexpr double kMostLonger = 1.3;
  const OnSite on_site = site.on_site();
  const double shortest_m = on_site.visit(entry.stations).walk_m;
  const std::size_t stations = entry.stations.size();
  std::vector<std::vector<float>> metres(stations, std::vector<float>(stations, 0));
  for (std::size_t i = 0; i < stations; ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const Vec3 &a = entry.stations[i].ground, &b = entry.stations[j].ground;
      const double straight_m = std::sqrt(dot(a - b, a - b));
      metres[i][j] = metres[j][i] =
          static_cast<float>(on_site.way_m(a, b).value_or(on_site.options().detour * straight_m));
    }
  const auto least = least_unlinked(links, metres, entry.visit->order.front(),
                                    static_cast<float>(kMostLonger * shortest_m), entry.visit->unlinked);
  return {swept.name,
          number(stations),
          fixed(entry.visit->walk_m, 0),
          shortest_m > 0 ? fixed(entry.visit->walk_m / shortest_m, 2) : "–",
          number(entry.visit->unlinked) + " of " + number(stations - 1),
          least ? number(*least) : "–"};
}

// Returns in words the faults that no plan may have.
std::vector<std::string> faults_of(const SweptSite& site, const Score& score) {
  std::vector<std::string> faults;
  const auto none = [&](std::size_t count, const std::string& what) {
    if (count > 0) faults.push_back(number(count) + " " + what);
  };
  none(score.off_ground, "stations off the true ground");
  none(score.through_walls, "links through walls");
  none(score.near_pairs, "pairs of stations nearer than a quarter of what they look at");
  constexpr double kMostClosed = 0.1;
  if (score.closed > kMostClosed) faults.push_back(percent(score.closed) + " of all floor is closed, and not planned");
  if (site.truth && score.on_plane) faults.push_back("stations on a plane that was laid, though there is ground");
  // Without the truth the rule knows no rooms.
  if (site.truth && score.plan.stations > score.by_thumb)
    faults.push_back(number(score.plan.stations) + " stations, a person takes " + number(score.by_thumb));
  return faults;
}

// Plans for the stations that pay if there is no `capture`.
PlanResult planned(Site& site, const SweepOptions& options, std::optional<double> capture, double link) {
  SurveyQuestion question;
  question.capture = capture, question.link = link, question.targets = 0;
  return plan(site, question, {.max_seconds = options.max_seconds});
}

// The plan by hand, and the plan itself if it is as good, else one for the figures of the plan by hand.
std::optional<std::array<Judged, 2>> compare(const SweptSite& swept, Site& site, const PlanResult& result,
                                             const SweepOptions& options) {
  const std::filesystem::path file = std::filesystem::path(options.by_hand) / (swept.name + ".csv");
  if (options.by_hand.empty() || !std::filesystem::exists(file)) return std::nullopt;
  std::vector<PlacedStation> stations;
  for (const StationRow& row : read_stations_csv(file)) {
    if (!row.position) throw Error(Errc::malformed_file, file.string() + ": give x, y and z of every head");
    stations.push_back(site.place_head(*row.position).station);
    if (stations.back().status != StationStatus::ok)
      throw Error(Errc::malformed_file,
                  file.string() + ": station " + number(stations.size()) + " " + explain(stations.back().status));
  }
  const Judged hand =
      judged(site.evaluate(stations, {.attainable = &result.candidates->attainable_counts(), .link = default_link}));
  // A plan that is as good in each figure needs no other question.
  const Judged plan = judged(result.front[answer(result)]);
  if (plan.stations <= hand.stations && plan.captured >= hand.captured && plan.linked >= hand.linked)
    return std::array{hand, plan};
  const PlanResult same = planned(site, options, hand.captured, hand.linked ? default_link : 0);
  const Judged equal = judged(same.front[answer(same)]);
  return std::array{hand, equal};
}

// The results so far.
class Sweep {
 public:
  // Returns false if the plan has a fault that no plan may have.
  bool add(const SweptSite& swept, const SweepOptions& options);
  void write(const std::filesystem::path& folder) const {
    sites_.write(folder, "sweep");
    rounds_.write(folder, "rounds");
    if (any_by_hand_) by_hand_.write(folder, "by_hand");
    draw_sheet(folder / "sweep.png", tiles_);
  }

 private:
  Table sites_{{"site", "what", "ground m²", "stations", "proven least", "greedy", "rule of thumb", "rooms visited",
                "rooms left out", "off ground", "in the way", "too near", "links through walls", "linked", "captured",
                "met", "s"}};
  Table rounds_{{"site", "stations", "walk, m", "of the shortest", "steps without a link", "least possible"}};
  Table by_hand_{
      {"site", "by hand", "captured", "linked", "default", "captured", "linked", "default at equal figures"}};
  std::vector<std::unique_ptr<Canvas>> tiles_;
  bool any_by_hand_ = false;
};

bool Sweep::add(const SweptSite& swept, const SweepOptions& options) {
  vantage::SiteOptions as;
  as.scene = swept.scene;
  if (options.step_deg) as.steps = {Angle::degrees(*options.step_deg), Angle::degrees(*options.step_deg)};
  as.user_size_m = options.user_size_m, as.spacing_m = options.spacing_m;
  const Stopwatch watch;
  Site site = Site::open(swept.file, as);
  const PlanResult result = planned(site, options, options.pays ? std::nullopt : std::optional(kCapture), default_link);
  Score score;
  score.seconds = watch.seconds();
  const PlanEntry& entry = result.front[answer(result)];
  score.plan = judged(entry), score.met = met(result);
  judge_ground(swept, site, entry, score);
  if (const auto links = entry.links()) judge_sight(site, entry, *links, default_link, score);
  judge_number(result, options.pays ? score.plan.captured : kCapture, score);
  if (const auto links = entry.links(); links && entry.visit) rounds_.add(round_cells(swept, site, entry, *links));
  sites_.add(cells(swept, score));
  tiles_.push_back(tile_of(
      site, entry, swept.name + ": " + number(score.plan.stations) + " stations, " + percent(score.plan.captured)));
  std::fprintf(stderr, "%s, %s: %zu stations, %zu proven, %zu by thumb, %s captured, %.0f s\n", swept.name.c_str(),
               swept.told.c_str(), score.plan.stations, score.at_least, score.by_thumb,
               percent(score.plan.captured).c_str(), score.seconds);
  const std::vector<std::string> faults = faults_of(swept, score);
  for (const std::string& fault : faults) std::fprintf(stderr, "    fault: %s\n", fault.c_str());
  for (const StoreyTie& tie : entry.storey_ties)
    std::fprintf(stderr,
                 "    S%zu-S%zu alone tie two storeys past the stair: %.2f shared, %.1f m apart, %.0f m on foot\n",
                 tie.a + 1, tie.b + 1, tie.value, tie.apart_m, tie.way_m);
  if (const auto pair = compare(swept, site, result, options)) {
    const auto& [hand, equal] = *pair;
    any_by_hand_ = true;
    by_hand_.add({swept.name, number(hand.stations), percent(hand.captured), hand.linked ? "yes" : "no",
                  number(score.plan.stations), percent(score.plan.captured), score.plan.linked ? "yes" : "no",
                  number(equal.stations) + " (" + percent(equal.captured) + ")"});
    if (equal.stations > hand.stations)
      std::fprintf(stderr, "    by hand %zu stations have %s, by default it takes %zu\n", hand.stations,
                   percent(hand.captured).c_str(), equal.stations);
  }
  return faults.empty();
}

}  // namespace

void SweepOptions::add(CLI::App& command) {
  command
      .add_option("sites", sites,
                  "Seeds of random sites (7, 1..12), reference sites (office, house, street, plant), or files")
      ->required();
  command.add_option("-o,--output", folder, "Folder for the tables and the picture")->required();
  command.add_option("--by-hand", by_hand, "Folder of plans by hand, NAME.csv each, to compare");
  command.add_option("--unit", unit, "Unit of files: m, cm, mm, in, ft; recognised otherwise");
  command.add_option("--up", up, "Up axis of files: x, y, z; recognised otherwise");
  command.add_option("--step", step_deg, "Degrees between rays; that of the default scanner otherwise");
  command.add_option("--user-size", user_size_m, "Upper bound of the voxel size, metres; the site's own otherwise");
  command.add_option("--spacing", spacing_m, "Wanted distance of points, metres; the site's own otherwise");
  command.add_flag("--pays", pays, "Plan for the stations that pay, as by default, and not for 90 %");
  command.add_option("--max-time", max_seconds, "Seconds for each plan; none otherwise");
}

bool run_sweep(const SweepOptions& options) {
  const test::TemporaryFolder models;
  std::filesystem::create_directories(options.folder);
  Sweep sweep;
  bool good = true;
  for (const SweptSite& swept : swept_sites(options, models.path())) {
    try {
      good = sweep.add(swept, options) && good;
    } catch (const Error& failure) {
      good = false;
      std::fprintf(stderr, "%s: %s\n", swept.name.c_str(), failure.what());
    }
    sweep.write(options.folder);  // writes finished sites even if a later one ends early
  }
  return good;
}

}  // namespace vantage::bench
