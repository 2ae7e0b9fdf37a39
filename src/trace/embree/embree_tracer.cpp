// SPDX-License-Identifier: Apache-2.0
#include "trace/embree/embree_tracer.hpp"

#include <tbb/task_arena.h>

#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "core/embree.hpp"
#include "trace/embree/count_network.hpp"
#include "trace/embree/sample_networks.hpp"
#include "trace/embree/scan_station.hpp"
#include "trace/embree/station_rays.hpp"

namespace vantage {
namespace {

std::string processor_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "CPU";
}

class EmbreeTracer final : public Tracer {
 public:
  explicit EmbreeTracer(const TraceScene& scene)
      : scene_(std::make_shared<EmbreeScene>(scene)), scanners_(rays_of(scene)), info_(embree_engine_info()) {}

  const EngineInfo& info() const override { return info_; }

  void scan(const TraceStation& station, std::uint64_t first_ray, std::uint64_t ray_count, std::uint32_t outputs,
            RawChunk& chunk) override {
    scan_.scan(scanners_[station.scanner], station, first_ray, ray_count, outputs, chunk);
  }

  std::uint64_t preferred_scan_rays(std::uint32_t scanner) const override {
    constexpr std::uint64_t kRaysWanted = std::uint64_t{1} << 20;
    const std::uint64_t columns = scanners_[scanner].pattern().columns();
    const std::uint64_t rows =
        std::max<std::uint64_t>(RayTile::kSide, kRaysWanted / columns / RayTile::kSide * RayTile::kSide);
    return rows * columns;
  }

  NetworkCounts count(std::span<const TraceStation> stations, std::uint32_t station_count, const CountOptions& options,
                      const Progress& progress) override {
    return count_network(scanners_, stations, station_count, goal_density_, options, field_, progress);
  }

  std::vector<NetworkCounts> count_each(std::span<const std::vector<TraceStation>> networks,
                                        std::span<const std::uint32_t> station_counts, const CountOptions& options,
                                        const Progress& progress) override {
    return count_networks(scanners_, networks, station_counts, goal_density_, options, field_, progress);
  }

  std::vector<NetworkCounts> count_sampled(std::span<const std::vector<TraceStation>> networks,
                                           std::span<const std::uint32_t> station_counts, const SampleJob& job,
                                           const Progress& progress) override {
    return sample_networks(scanners_, networks, station_counts, goal_density_, job, samples_, progress);
  }

  bool take(const TraceScene& scene, const SceneDifference& difference) override {
    if (!scene_->take(scene, difference)) return false;
    scan_ = {}, field_ = {}, samples_ = {};
    scanners_ = rays_of(scene);
    return true;
  }

 private:
  std::vector<StationRays> rays_of(const TraceScene& scene) const {
    std::vector<StationRays> rays;
    for (const TraceScanner& scanner : scene.scanners) rays.emplace_back(scene_, scanner);
    return rays;
  }

  std::shared_ptr<EmbreeScene> scene_;
  std::vector<StationRays> scanners_;
  EngineInfo info_;
  ChunkedScan scan_;
  PassField field_;
  LruCache<SampledVoxels> samples_;
};

}  // namespace

bool EmbreeScene::take(const TraceScene& traced, const SceneDifference& difference) {
  if (scene->shares() || traced.scene->shares()) return false;
  std::optional<RayCaster::Change> change = caster.prepare(traced.scene, difference);
  if (!change) return false;
  std::vector<std::uint32_t> neighbours = patches->neighbours_after(*traced.scene, difference);
  BrickPrefixes later_prefixes(*traced.grid);
  Surface later_surface(traced.scene, planes);  // it asks the planes only for hits
  auto later_triangles =
      traced.sample_triangles ? traced.sample_triangles : std::make_shared<SampleTriangles>(traced.scene, traced.grid);
  std::unique_ptr<const GlassPanes> later_glass =
      weakens_through_glass(traced) ? std::make_unique<const GlassPanes>(traced.scene, planes) : nullptr;
  planes->take(traced.scene, difference);
  caster.take(std::move(*change));
  surface = std::move(later_surface);
  prefixes = std::move(later_prefixes);
  patches.emplace(*traced.scene, std::move(neighbours));
  glass = std::move(later_glass);
  sample_triangles = std::move(later_triangles);
  scene = traced.scene, grid = traced.grid;
  return true;
}

EngineInfo embree_engine_info() {
  EngineInfo info;
  info.engine = Engine::embree;
  info.device = processor_name() + " (" + std::to_string(tbb::this_task_arena::max_concurrency()) + " threads)";
  info.driver = "Embree " RTC_VERSION_STRING;
  info.usable = true;
  info.reason = embree::told();
  return info;
}

std::unique_ptr<Tracer> make_embree_tracer(const TraceScene& scene) { return std::make_unique<EmbreeTracer>(scene); }

}  // namespace vantage
