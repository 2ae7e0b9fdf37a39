// SPDX-License-Identifier: Apache-2.0
#include "drag.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <numbers>

#include "edit/session.hpp"
#include "networks.hpp"
#include "support/site_of.hpp"
#include "vantage/error.hpp"
#include "vantage/planner.hpp"

namespace vantage::bench {
namespace {

double cpu_ms() { return static_cast<double>(std::clock()) * 1e3 / CLOCKS_PER_SEC; }

double at_share(std::vector<double> values, double share) {
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

}  // namespace

void DragOptions::add(CLI::App& command) {
  site.add(command);
  command.add_option("--count", count, "Stations, drawn on the search area, where none are given")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command.add_option("--moves", moves, "Of the first station, around a circle of 1 m")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command.add_option("--sample", sample, "Voxels that every move is measured on")->capture_default_str();
  command.add_option("--seed", seed, "Of the stations that are drawn")->capture_default_str();
}

void run_drag(const DragOptions& options) {
  const Scene scene = Scene::load(options.site.scene);
  const Scanner scanner = options.site.scanner();
  const bool given = !options.site.typed.empty() || !options.site.station_file.empty();
  const Network network =
      given ? options.site.stations()
            : networks_on_search_area(scene, 1, options.count, scanner.height_m, options.seed).front();
  for (const EngineInfo& engine : options.site.engines_here()) {
    SimulatorConfig config = options.site.config();
    config.engine = engine.engine, config.device_index = engine.device_index;
    Site site = test::site_of(Simulator(scene, scanner, config));
    std::vector<EditStation> stations;
    for (const Station& station : network) stations.push_back({.placed = site.place_head(station.position).station});
    EditSession session(
        site, stations, {.voxels = options.sample, .attainable_voxels = 0}, [](const auto&) {},
        [](const auto&, const auto&) { return std::string(); });
    const Vec3 middle = stations.front().placed.ground;
    std::vector<double> wall, cpu;
    std::size_t off_ground = 0;
    for (std::size_t k = 0; k < options.moves; ++k) {
      const double angle = 2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(options.moves);
      const Vec3 to = middle + Vec3{std::cos(angle), std::sin(angle), 0};
      const Stopwatch watch;
      const double before = cpu_ms();
      try {
        session.change({{"do", "move"}, {"id", 1}, {"to", {to.x, to.y, to.z}}, {"begin", k == 0}, {"end", false}});
      } catch (const Error&) {
        ++off_ground;
        continue;
      }
      const std::string answer = session.state().dump();
      cpu.push_back(cpu_ms() - before);
      wall.push_back(1e3 * watch.seconds());
    }
    if (wall.empty()) throw Error(Errc::invalid_argument, "drag: the first station has no ground around it");
    std::printf("%s: %zu stations, %llu of %llu voxels, %zu moves (%zu off the ground)\n",
                to_string(engine.engine).c_str(), stations.size(), static_cast<unsigned long long>(options.sample),
                static_cast<unsigned long long>(site.simulator().voxel_count()), wall.size(), off_ground);
    std::printf("  wall ms a move: %.1f in the middle, %.1f at 90 %%\n", at_share(wall, 0.5), at_share(wall, 0.9));
    std::printf("  CPU ms a move, of all threads: %.1f in the middle, %.1f at 90 %%\n", at_share(cpu, 0.5),
                at_share(cpu, 0.9));
  }
}

}  // namespace vantage::bench
