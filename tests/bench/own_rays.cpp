// SPDX-License-Identifier: Apache-2.0
#include "own_rays.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/parallel.hpp"
#include "core/philox.hpp"
#include "trace/rays/ray_finder.hpp"
#include "vantage/rays.hpp"

namespace vantage::bench {
namespace {

enum class Order { blocks, rows, shuffled };
constexpr std::array kOrders{std::pair{Order::blocks, "blocks"}, std::pair{Order::rows, "rows"},
                             std::pair{Order::shuffled, "shuffled"}};
constexpr std::array kQuestions{std::pair{RayQuestion::nearest, "nearest"}, std::pair{RayQuestion::blocked, "blocked"},
                                std::pair{RayQuestion::count, "count"}};

// Orders of the directions of a pattern: in blocks, as counting takes them, row by row, or at random.
std::vector<Vec3> directions_of(const RayPattern& pattern, Order order) {
  std::vector<Vec3> all;
  all.reserve(std::size_t{pattern.rows()} * pattern.columns());
  const std::uint32_t high = order == Order::blocks ? block_rows : 1, wide = order == Order::blocks ? block_columns : 1;
  for (std::uint32_t r = 0; r < pattern.rows(); r += high)
    for (std::uint32_t c = 0; c < pattern.columns(); c += wide)
      for (std::uint32_t k = 0; k < high * wide; ++k) {
        // As place_in_block() of lib/pattern.glsl.
        const std::uint32_t column = (k & 3) | (k >> 3 & 1) << 2 | (k >> 5 & 1) << 3,
                            row = (k >> 2 & 1) | (k >> 4 & 1) << 1 | (k >> 6 & 1) << 2;
        const bool one = high * wide == 1;
        const std::uint32_t i = r + (one ? 0 : row), j = c + (one ? 0 : column);
        if (i < pattern.rows() && j < pattern.columns()) all.push_back(widen(pattern.direction(i, j)));
      }
  if (order == Order::shuffled) {
    RandomStream random(1);
    for (std::size_t k = all.size(); k > 1; --k)
      std::swap(all[k - 1], all[static_cast<std::size_t>(random.uniform() * static_cast<double>(k))]);
  }
  return all;
}

// All rays through a finder; counts those that it leaves open.
std::size_t open_of(RayFinder& finder, const Vec3& origin, std::span<const Vec3> directions, const RayPattern& pattern,
                    RayQuestion question, std::uint32_t end, std::size_t batch) {
  std::size_t open = 0;
  if (batch == 0) batch = finder.most_rays();
  for (std::size_t first = 0; first < directions.size(); first += batch) {
    const std::size_t count = std::min(batch, directions.size() - first);
    finder.reserve(count);
    const std::span<OwnRay> rays = finder.rays(0);
    parallel::for_all(std::size_t{0}, count, [&](std::size_t k) {
      const Float3 at = narrow(origin + directions[first + k] * pattern.min_range),
                   unit = narrow(directions[first + k]);
      rays[k] = {.origin = {at.x, at.y, at.z},
                 .from = 0,
                 .direction = {unit.x, unit.y, unit.z},
                 .range = pattern.max_range - pattern.min_range};
    });
    finder.find(0, count, question, end);
    open += static_cast<std::size_t>(std::ranges::count(finder.answers(0).first(count), open_answer));
  }
  return open;
}

struct Line {
  std::string engine, what, order;
  std::size_t rays;
  double best = std::numeric_limits<double>::infinity();  // seconds
  double open = -1;
};

}  // namespace

void OwnRaysOptions::add(CLI::App& command) {
  site.add(command);
  command.add_option("--most", most, "Most rays of a whole call")->capture_default_str();
  command.add_option("--batch", batch, "Rays that a device alone has at once; 0: as many as in whole calls")
      ->capture_default_str();
}

void run_own_rays(const OwnRaysOptions& options) {
  const Scene scene = Scene::load(options.site.scene);
  Network network = options.site.stations();
  network.resize(1);
  TracedSite site = options.site.traced(scene, network);
  const RayPattern& pattern = *site.scene.scanners[0].pattern;
  const Vec3 local = widen(site.stations[0].origin), origin = local + scene.data().origin;
  std::vector<std::vector<Vec3>> directions;
  for (const auto& [order, name] : kOrders) directions.push_back(directions_of(pattern, order));
  const std::size_t rays = directions[0].size(), some = std::min(rays, options.most);
  const double range = pattern.max_range;

  std::vector<std::pair<Line, std::function<void(Line&)>>> ways;
  std::vector<std::unique_ptr<Tracer>> tracers;
  std::vector<std::unique_ptr<RayFinder>> finders;
  std::vector<std::unique_ptr<RayTracer>> own;
  const std::shared_ptr<const SceneData> data = site.scene.scene;
  for (const EngineInfo& info : options.site.engines_here()) {
    const DeviceChoice device{info.engine, info.device_index};
    const std::string name = to_string(info.engine);
    const bool on_device = info.engine != Engine::embree;
    own.push_back(std::make_unique<RayTracer>(scene, device));
    for (std::size_t k = 0; k < kOrders.size(); ++k)
      for (const auto& [question, what] : kQuestions)
        ways.emplace_back(
            Line{name, std::string("whole ") + what, kOrders[k].second, some},
            [&, question = question, tracer = own.back().get(), k](Line& line) {
              const Rays given{{&origin, 1}, std::span(directions[k]).subspan((rays - some) / 2, some), {&range, 1}};
              const RayOptions from{.from_m = pattern.min_range};
              const Stopwatch watch;
              if (question == RayQuestion::nearest) tracer->nearest(given, from);
              if (question == RayQuestion::blocked) tracer->blocked(given, from);
              if (question == RayQuestion::count) tracer->count(given, from);
              line.best = std::min(line.best, watch.seconds());
            });
    if (!on_device) continue;
    tracers.push_back(make_tracer(info.engine, info.device_index, site.scene));
    tracers.back()->set_goal_density(site.goal_density);
    ways.emplace_back(Line{name, "every ray counted", "blocks", rays}, [&, tracer = tracers.back().get()](Line& line) {
      line.best =
          std::min(line.best, tracer->count(site.stations, 1, {.masks = true, .skip = false}, {}).trace_seconds);
    });
    finders.push_back(make_ray_finder(device, data));
    for (std::size_t k = 0; k < kOrders.size(); ++k)
      for (const auto& [question, what] : kQuestions)
        ways.emplace_back(Line{name, std::string("device ") + what, kOrders[k].second, rays},
                          [&, question = question, finder = finders.back().get(), k](Line& line) {
                            const double before = finder->device_seconds();
                            const std::size_t open = open_of(*finder, local, directions[k], pattern, question,
                                                             data->opaque_count(), options.batch);
                            line.best = std::min(line.best, finder->device_seconds() - before);
                            line.open = static_cast<double>(open) / static_cast<double>(rays);
                          });
  }
  // The first round warms up and is not counted.
  for (std::uint32_t round = 0; round <= options.site.repeats; ++round)
    for (auto& [line, run] : ways) {
      run(line);
      if (round == 0) line.best = std::numeric_limits<double>::infinity();
    }
  std::printf("# %zu triangles, %zu rays of one station, whole calls of %zu\n", scene.triangle_count(), rays, some);
  std::printf("engine,what,order,rays,milliseconds,million_rays_per_second,open_share\n");
  for (const auto& [line, run] : ways)
    std::printf("%s,%s,%s,%zu,%.3f,%.2f,%s\n", line.engine.c_str(), line.what.c_str(), line.order.c_str(), line.rays,
                line.best * 1e3, static_cast<double>(line.rays) / line.best * 1e-6,
                line.open < 0 ? "" : std::to_string(line.open).c_str());
}

}  // namespace vantage::bench
