// SPDX-License-Identifier: Apache-2.0
#include "rates.hpp"

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <limits>
#include <memory>
#include <utility>

#include "scan/limit_model.hpp"
#include "vantage/objective.hpp"

namespace vantage::bench {
namespace {

struct TimedWay {
  std::string name;
  std::size_t tracer;
  bool skip;
  double best = std::numeric_limits<double>::infinity(), device = 0,
         cpu = std::numeric_limits<double>::infinity();  // seconds
  NetworkCounts counts{};
};

bool same_values(const NetworkCounts& a, const NetworkCounts& b) {
  return a.saturated == b.saturated && a.partial_points == b.partial_points && a.seen == b.seen && a.shared == b.shared;
}

}  // namespace

void RatesOptions::add(CLI::App& command) {
  site.add(command);
  command.add_option("--first", first, "Only the first stations; 0: all")->capture_default_str();
  command.add_flag("--unsorted", unsorted,
                   "Also ray_query over triangles in the file's order, where that is not the default");
  command.add_option("--glass", glass, "Nodes of glass");
  command.add_option("--shared-meshes", shared_meshes,
                     "Store meshes that nodes share once: auto, always, never; if so, also with each where it stands");
  command.add_option("--detection", detection_m,
                     "Also with echoes limited to this range at normal incidence on R = 0.5, in metres, and, if the "
                     "scene has glass, weakened by it");
}

void run_rates(const RatesOptions& options) {
  const Scene scene = Scene::load(
      options.site.scene, {.glass = options.glass, .shared_meshes = shared_meshes_from_string(options.shared_meshes)});
  Network network = options.site.stations();
  if (options.first > 0 && options.first < network.size()) network.resize(options.first);
  TracedSite site = options.site.traced(scene, network);

  std::vector<std::unique_ptr<Tracer>> tracers;
  std::vector<TimedWay> ways;
  const auto add = [&](const EngineInfo& info, const std::string& suffix) {
    const Stopwatch watch;
    tracers.push_back(make_tracer(
        info.engine, info.engine == Engine::embree ? std::nullopt : std::optional(info.device_index), site.scene));
    tracers.back()->set_goal_density(site.goal_density);
    std::fprintf(stderr, "%s%s on %s: ready after %.2f s\n", to_string(info.engine).c_str(), suffix.c_str(),
                 info.device.c_str(), watch.seconds());
    for (const bool skip : {false, true})
      ways.push_back({.name = to_string(info.engine) + suffix, .tracer = tracers.size() - 1, .skip = skip});
  };
  for (const EngineInfo& info : options.site.engines_here()) {
    add(info, "");
    if (info.engine == Engine::embree) {
      for (const auto& [way, suffix] : {std::pair{WholeScans::traced, "-traced"}, {WholeScans::drawn, "-drawn"}}) {
        site.scene.whole_scans = way;
        add(info, suffix);
      }
      site.scene.whole_scans = WholeScans::faster;
    }
    if (options.detection_m > 0) {
      Scanner scanner = options.site.scanner();
      scanner.detection_range_m = options.detection_m;
      scanner.detection_reflectivity = 0.5;
      LimitModel limits = make_limit_model(scene.data(), scanner, {});
      const bool glass = std::exchange(limits.glass, false);
      site.scene.scanners[0].limits = std::make_shared<const LimitModel>(limits);
      add(info, "-echo");
      limits.glass = glass;
      site.scene.scanners[0].limits = std::make_shared<const LimitModel>(limits);
      if (glass) add(info, "-glass");
      site.scene.scanners[0].limits = nullptr;
    }
    if (scene.data().shares()) {
      const auto stored = std::exchange(site.scene.scene, flattened(site.scene.scene));
      add(info, "-flat");
      site.scene.scene = stored;
    }
    if (options.unsorted && info.engine == Engine::ray_query) {
      site.scene.sort_triangles = false;
      add(info, "-unsorted");
      site.scene.sort_triangles = true;
    }
  }

  // The first round warms up and is not counted.
  for (std::uint32_t round = 0; round <= options.site.repeats; ++round)
    for (TimedWay& way : ways) {
      const Stopwatch watch;
      const std::clock_t cpu_start = std::clock();
      NetworkCounts counts = tracers[way.tracer]->count(site.stations, static_cast<std::uint32_t>(site.stations.size()),
                                                        {.masks = true, .skip = way.skip}, {});
      const double seconds = watch.seconds(), cpu = static_cast<double>(std::clock() - cpu_start) / CLOCKS_PER_SEC;
      if (round > 0) way.cpu = std::min(way.cpu, cpu);
      if (round > 0 && seconds < way.best) {
        way.best = seconds;
        way.device = counts.trace_seconds;
      }
      way.counts = std::move(counts);
    }
  const std::uint64_t rays = options.site.scanner().rays();
  const VoxelGrid& grid = *site.scene.grid;
  std::printf("# %zu triangles, %zu stations, %llu rays each, %llu voxels of %.4g m, goal %.3f\n",
              scene.triangle_count(), site.stations.size(), static_cast<unsigned long long>(rays),
              static_cast<unsigned long long>(grid.size()), grid.voxel_size(), site.goal_density);
  std::printf(
      "engine,skip,milliseconds,device_milliseconds,cpu_milliseconds,traced_rays,million_rays_per_second,coverage,same_"
      "counts_as_"
      "without_skipping\n");
  for (std::size_t k = 0; k < ways.size(); ++k) {
    const TimedWay& way = ways[k];
    std::printf("%s,%d,%.3f,%.3f,%.3f,%llu,%.2f,%.9f,%d\n", way.name.c_str(), way.skip, way.best * 1e3,
                way.device * 1e3, way.cpu * 1e3, static_cast<unsigned long long>(way.counts.rays),
                static_cast<double>(rays * site.stations.size()) / way.best * 1e-6,
                coverage(way.counts, site.goal_density), same_values(way.counts, ways[k - (way.skip ? 1 : 0)].counts));
  }
}

}  // namespace vantage::bench
