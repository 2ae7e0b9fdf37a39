// SPDX-License-Identifier: Apache-2.0
#include "day.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>
#include <utility>

#include "core/glm.hpp"
#include "core/parse.hpp"
#include "core/philox.hpp"
#include "scene/changed_scene.hpp"
#include "scene/scene_data.hpp"
#include "vantage/cover.hpp"
#include "vantage/export.hpp"
#include "vantage/taken_scans.hpp"

namespace vantage::bench {
namespace {

double apart(const Vec3& a, const Vec3& b) { return std::sqrt(dot(a - b, a - b)); }

// The scene with these boxes, which block.
Scene with_things(const Scene& scene, const std::vector<std::string>& things) {
  auto data = std::make_shared<SceneData>(scene.data());
  const auto first = static_cast<std::uint32_t>(data->triangles.size());
  for (const std::string& text : things) {
    const std::vector<double> v = parse_numbers(text, "--thing", 6, 6, Interval{.low = -1e6, .high = 1e6});
    constexpr int kFaces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (const auto& face : kFaces) {
      const auto at = static_cast<std::uint32_t>(data->positions.size());
      for (const int k : face)
        data->positions.push_back(narrow(Vec3{v[k & 1 ? 3 : 0], v[k & 2 ? 4 : 1], v[k & 4 ? 5 : 2]} - data->origin));
      data->triangles.push_back({at, at + 1, at + 2});
      data->triangles.push_back({at, at + 2, at + 3});
    }
  }
  if (!data->normals.empty()) data->normals.resize(data->positions.size());
  if (!data->texcoords.empty()) data->texcoords.resize(data->positions.size());
  if (!data->colours.empty()) data->colours.resize(data->positions.size(), 0xFFFFFFFF);
  const auto count = static_cast<std::uint32_t>(data->triangles.size()) - first;
  if (count == 0) return scene;
  data->ranges.push_back({first, count, 0});
  data->meshes.push_back({.name = "things", .role = Role::blocking, .triangle_count = count});
  return Scene(std::move(data));
}

// Writes the scan that is taken at `head` as a file, in a frame that is turned and shifted as a rough pose is.
void take_scan(Site& real, const Vec3& head, const DayOptions& options, std::uint64_t number,
               const std::filesystem::path& file) {
  RandomStream random(options.seed, number);
  const auto direction = [&] {
    const double x = random.normal(), y = random.normal(), z = random.normal();
    return normalize(glm::dvec3(x, y, z));
  };
  const glm::dvec3 shift = options.shift_m * direction();
  const glm::dmat3 turn = glm::mat3_cast(glm::angleAxis(Angle::degrees(options.turn_deg).in_radians(), direction()));
  Simulator& simulator = real.simulator();
  PointCloudWriter writer(file, simulator.origin(), scan_position | scan_reflectivity);
  writer.begin_station({.name = file.stem().string(), .head = head + to_vec3(shift), .scanner = real.scanner()});
  const glm::dvec3 local = to_glm(head - simulator.origin());
  ScanOptions what{.outputs = scan_position | scan_reflectivity};
  if (options.instrument) what.instrument = draw_instrument_errors(real.scanner(), *options.instrument);
  simulator.scan({.position = head}, what, [&](const ScanChunk& chunk) {
    ScanChunk rough = chunk;
    for (auto& p : rough.position) {
      const glm::dvec3 q = local + shift + turn * (glm::dvec3(p[0], p[1], p[2]) - local);
      p = {static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z)};
    }
    writer.write(rough, 1);
  });
  writer.close();
}

// Place where a crew stands that was sent to `head`: there, or as near as things allow.
Vec3 stood_at(Site& real, const Vec3& head) {
  if (real.place_head(head).station.status == StationStatus::ok) return head;
  Vec3 best = head;
  double nearest = std::numeric_limits<double>::infinity();
  for (const PlacedStation& place : candidate_positions(real, 4096))
    if (const double distance = apart(place.position, head); distance < nearest)
      nearest = distance, best = place.position;
  return best;
}

// The fewest connected stations among candidates. Each is the one that adds most, among those linked to earlier
// ones.
std::vector<PlacedStation> planned_stations(Site& site, const DayOptions& options) {
  const Candidates candidates = find_candidates(site);
  const CoverageMatrix matrix = candidates.captured_matrix();
  const StationGraph graph = overlap_graph(site.surroundings(), candidates.stations());
  const CoverProblem problem{.matrix = matrix, .graph = &graph, .coverage = options.capture, .link = options.link};
  std::vector<std::size_t> left = min_connected_cover(problem).best.chosen, ordered;
  std::vector<PlacedStation> stations;
  while (!left.empty()) {
    const auto with = [&](std::size_t k) {
      std::vector<std::size_t> chosen = ordered;
      chosen.push_back(k);
      const bool linked = std::ranges::any_of(ordered, [&](std::size_t o) { return graph.linked(o, k, options.link); });
      return std::pair(linked, matrix.coverage(chosen));
    };
    const auto best = std::ranges::max_element(left, {}, with);
    ordered.push_back(*best);
    stations.push_back(candidates.stations()[*best]);
    left.erase(best);
  }
  return stations;
}

// Shares of what is attainable that the first 1, 2, … stations capture in truth.
std::vector<double> captured_by(Site& real, const Candidates& candidates, const std::vector<Vec3>& heads) {
  std::vector<PlacedStation> stations;
  for (const Vec3& head : heads) stations.push_back(real.place_head(head).station), stations.back().existing = true;
  const SampledCoverage sampled = sample_coverage(real.simulator(), stations, candidates.coverage().sample_voxels());
  std::vector<double> amounts(sampled.matrix().elements()), shares;
  for (std::size_t k = 0; k < stations.size(); ++k) {
    for (const CoverageMatrix::Entry& one : sampled.matrix().column(k)) amounts[one.element] += one.amount;
    shares.push_back(candidates.attainable_counts().captured(std::span<const double>(amounts)).value);
  }
  return shares;
}

}  // namespace

void DayOptions::add(CLI::App& command) {
  command.add_option("scene", scene, "The model")->required();
  command.add_option("-o,--output", folder, "Folder for the scans of the day")->required();
  command.add_option("--thing", things, "x,y,z,x,y,z: a box that is there and not in the model")->take_all();
  command.add_option("--scanner", scanner, "Preset")->capture_default_str();
  command.add_option("--steps", steps_deg, "Degrees between rays, in place of the preset's");
  command.add_option("--user-size", user_size_m, "Upper bound of the voxel size, metres");
  command.add_option("--spacing", spacing_m, "Wanted distance between points, metres");
  command.add_option("--capture", capture, "Wanted share")->capture_default_str();
  command.add_option("--link", link, "Least scan overlap of links")->capture_default_str();
  command.add_option("--shift", shift_m, "Error of poses, metres")->capture_default_str();
  command.add_option("--turn", turn_deg, "Error of poses, degrees")->capture_default_str();
  command.add_option("--instrument-errors", instrument, "Seed of the errors of the instrument; none otherwise");
  command.add_option("--most", most, "Most stations of the day")->capture_default_str();
  command.add_option("--seed", seed, "Of errors of poses")->capture_default_str();
}

void run_day(const DayOptions& options) {
  const std::filesystem::path folder = options.folder;
  std::filesystem::create_directories(folder);
  // Removes files of an earlier run: two digits and the ending.
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".e57" && entry.path().stem().string().size() == 2)
      std::filesystem::remove(entry.path());
  vantage::SiteOptions as;
  as.scanner = options.scanner;
  as.user_size_m = options.user_size_m, as.spacing_m = options.spacing_m;
  if (!options.steps_deg.empty()) {
    const Angle step = Angle::degrees(options.steps_deg.front());
    as.steps = {step, step};
  }
  const Scene model = Scene::load(options.scene);
  Site site(model, as), real(with_things(model, options.things), as);

  const std::vector<PlacedStation> round = planned_stations(site, options);
  write_stations_csv(folder / "plan.csv", round);
  std::vector<Vec3> kept;
  for (const PlacedStation& station : round) kept.push_back(stood_at(real, station.position));

  std::vector<Vec3> adapted{kept.front()};
  std::vector<double> told;  // what the command said after each scan
  double worst_head = 0, seconds = 0;
  for (std::size_t taken = 1;; ++taken) {
    char name[32];
    std::snprintf(name, sizeof name, "%02zu.e57", taken);
    take_scan(real, adapted.back(), options, taken, folder / name);
    const auto begun = std::chrono::steady_clock::now();
    std::vector<TakenScan> scans = read_taken_scans(folder);
    fit_to_model(site, scans);
    const SiteChanges changes = changes_of(site, scans);
    Site found = changed_site(site, changes);
    const auto next = next_stations(found, scans, changes, round, {.capture = options.capture, .link = options.link});
    seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    for (std::size_t k = 0; k < scans.size(); ++k) worst_head = std::max(worst_head, apart(scans[k].head, adapted[k]));
    told.push_back(next->captured.value);
    std::fprintf(stderr, "%zu scans: captured %.3f, %zu things, %zu seen through, %zu further stations, %.1f s\n",
                 taken, next->captured.value, changes.things.size(), changes.seen_through.size(), next->next.size(),
                 seconds);
    if (next->next.empty() || taken == options.most) break;
    adapted.push_back(stood_at(real, next->next.front().station.position));
  }

  const Candidates truth = find_candidates(real);
  const std::vector<double> by_plan = captured_by(real, truth, kept), by_day = captured_by(real, truth, adapted);
  std::printf("stations,kept plan,adapted plan,told\n");
  for (std::size_t k = 0; k < std::max(by_plan.size(), by_day.size()); ++k) {
    std::printf("%zu,", k + 1);
    if (k < by_plan.size()) std::printf("%.4f", by_plan[k]);
    std::printf(",");
    if (k < by_day.size()) std::printf("%.4f,%.4f", by_day[k], told[k]);
    std::printf("\n");
  }
  std::printf("# heads are known to %.1f mm at worst; the last answer took %.1f s\n", 1e3 * worst_head, seconds);
}

}  // namespace vantage::bench
