// SPDX-License-Identifier: Apache-2.0
#include "trace/spread/spread_tracer.hpp"

#include <algorithm>
#include <chrono>
#include <map>
#include <mutex>
#include <utility>

#include "trace/deliver_once.hpp"
#include "trace/field_counts.hpp"
#include "trace/sample_runs.hpp"
#include "trace/spread/merge_counts.hpp"

namespace vantage {
namespace {

// Estimated cost of copying a field of counts and masks from a device and merging it, until measured.
constexpr double kFirstMergeSecondsAVoxel = 1e-8;

// "2 x NVIDIA H200", "NVIDIA H200, Intel Xeon (16 threads)".
EngineInfo info_of_all(const std::vector<std::unique_ptr<Tracer>>& tracers) {
  std::vector<std::pair<std::string, int>> devices;
  for (const auto& tracer : tracers) {
    const std::string& name = tracer->info().device;
    const auto known = std::find_if(devices.begin(), devices.end(), [&](const auto& d) { return d.first == name; });
    if (known == devices.end()) {
      devices.emplace_back(name, 1);
    } else {
      ++known->second;
    }
  }
  EngineInfo all = tracers.front()->info();
  all.device.clear();
  for (const auto& [name, many] : devices)
    all.device += (all.device.empty() ? "" : ", ") + (many > 1 ? std::to_string(many) + " x " : "") + name;
  all.reason = "asked for together";
  return all;
}

template <class T>
void put(std::vector<T>& whole, const std::vector<T>& part, std::size_t at, std::size_t size) {
  if (part.empty()) return;
  whole.resize(size);
  std::copy(part.begin(), part.end(), whole.begin() + static_cast<std::ptrdiff_t>(at));
}

bool came_to_end(const std::vector<NetworkCounts>& counts) {
  return std::none_of(counts.begin(), counts.end(), [](const auto& c) { return c.cancelled; });
}

// Sets the workers' summed counts to what one tracer would return.
void settle(std::vector<NetworkCounts>& all, bool finished, std::size_t workers) {
  for (NetworkCounts& counts : all) {
    counts.cancelled = !finished;
    counts.trace_seconds /= static_cast<double>(workers);
  }
}

}  // namespace

SpreadTracer::SpreadTracer(std::vector<std::unique_ptr<Tracer>> tracers, const TraceScene& scene, WorkerPool::Warn warn,
                           Options options)
    : info_(options.info ? *std::move(options.info) : info_of_all(tracers)),
      grid_(scene.grid),
      scanners_(scene.scanners),
      pool_(std::move(tracers), std::move(warn)),
      split_(options.split),
      population_(options.population),
      merge_seconds_a_voxel_(kFirstMergeSecondsAVoxel) {}

void SpreadTracer::set_goal_density(double goal) {
  Tracer::set_goal_density(goal);
  for (std::size_t k = 0; k < pool_.size(); ++k)
    if (Tracer* const worker = pool_.worker(k)) worker->set_goal_density(goal);
}

std::uint64_t SpreadTracer::uploaded_bytes() const {
  std::uint64_t sum = 0;
  for (std::size_t k = 0; k < pool_.size(); ++k)
    if (const Tracer* const worker = pool_.worker(k)) sum += worker->uploaded_bytes();
  return sum;
}

std::uint64_t SpreadTracer::preferred_scan_rays(std::uint32_t scanner) const {
  std::uint64_t sum = 0;
  for (std::size_t k = 0; k < pool_.size(); ++k)
    if (const Tracer* const worker = pool_.worker(k)) sum += worker->preferred_scan_rays(scanner);
  return sum;
}

void SpreadTracer::scan(const TraceStation& station, std::uint64_t first_ray, std::uint64_t ray_count,
                        std::uint32_t outputs, RawChunk& chunk) {
  const std::uint64_t columns = scanners_[station.scanner].pattern->columns();
  std::mutex mutex;
  RawChunk whole;
  pool_.work(ray_count / columns, rows_, {}, [&](Tracer& tracer, const Chunk& rows, const Progress&, const auto&) {
    RawChunk part;
    const std::uint64_t at = rows.first * columns;
    tracer.scan(station, first_ray + at, rows.size() * columns, outputs, part);
    const std::lock_guard lock(mutex);
    if (rows.size() * columns == ray_count) {
      whole = std::move(part);
      return true;
    }
    put(whole.range, part.range, at, ray_count);
    put(whole.position, part.position, at, ray_count);
    put(whole.normal, part.normal, at, ray_count);
    put(whole.reflectivity, part.reflectivity, at, ray_count);
    put(whole.primitive, part.primitive, at, ray_count);
    put(whole.barycentric, part.barycentric, at, ray_count);
    put(whole.voxel, part.voxel, at, ray_count);
    return true;
  });
  chunk = std::move(whole);
}

NetworkCounts SpreadTracer::count(std::span<const TraceStation> stations, std::uint32_t station_count,
                                  const CountOptions& options, const Progress& progress) {
  return split_pays(stations.size()) ? count_by_station(stations, station_count, options, progress)
                                     : count_whole(stations, station_count, options, progress);
}

bool SpreadTracer::split_pays(std::size_t stations) const {
  const auto workers = static_cast<double>(pool_.left());
  if (workers < 2 || stations < 2) return false;
  if (split_ == Split::always) return true;
  const double alone = seconds_a_station_ * static_cast<double>(stations);
  return alone * (1 - 1 / workers) > merge_seconds_a_voxel_ * static_cast<double>(grid_->size()) * workers;
}

NetworkCounts SpreadTracer::count_whole(std::span<const TraceStation> stations, std::uint32_t station_count,
                                        const CountOptions& options, const Progress& progress) {
  NetworkCounts counts;
  pool_.work(1, networks_, progress, [&](Tracer& tracer, const Chunk&, const Progress& own, const auto&) {
    counts = tracer.count(stations, station_count, options, own);
    return !counts.cancelled;
  });
  if (!counts.cancelled && !stations.empty())
    seconds_a_station_ = counts.trace_seconds / static_cast<double>(stations.size());
  return counts;
}

NetworkCounts SpreadTracer::count_by_station(std::span<const TraceStation> stations, std::uint32_t station_count,
                                             const CountOptions& options, const Progress& progress) {
  using Clock = std::chrono::steady_clock;
  std::mutex mutex;
  PassField field;
  NetworkCounts sums;
  double tracing = 0, merging = 0;
  std::size_t merged = 0;
  const auto one = [&](Tracer& tracer, const Chunk& chunk, const Progress& own, const auto&) {
    PassField part;
    const auto begun = Clock::now();
    const NetworkCounts counts = tracer.count(stations.subspan(chunk.first, chunk.size()), station_count,
                                              {.masks = options.masks, .skip = options.skip, .field = &part}, own);
    if (counts.cancelled) return false;
    const std::lock_guard lock(mutex);
    add_field(field, std::move(part));
    add_station_sums(sums, counts);
    const double whole = std::chrono::duration<double>(Clock::now() - begun).count();
    tracing += counts.trace_seconds;
    merging += std::max(0.0, whole - counts.trace_seconds);
    ++merged;
    return true;
  };
  const std::size_t workers = pool_.left();
  const bool finished = pool_.work(stations.size(), stations_, progress, one);
  field.count.resize(grid_->size());
  field.stations.resize(options.masks ? grid_->size() : 0);
  NetworkCounts counts = reduce_field(field.count, field.stations, station_count, goal_density_, grid_->demands());
  add_station_sums(counts, sums);
  counts.cancelled = !finished;
  counts.trace_seconds = tracing / static_cast<double>(workers);
  if (merged > 0) merge_seconds_a_voxel_ = merging / static_cast<double>(merged * grid_->size());
  if (options.field) *options.field = std::move(field);
  return counts;
}

std::vector<NetworkCounts> SpreadTracer::count_each(std::span<const std::vector<TraceStation>> networks,
                                                    std::span<const std::uint32_t> station_counts,
                                                    const CountOptions& options, const Progress& progress) {
  if (networks.size() < pool_.left()) return Tracer::count_each(networks, station_counts, options, progress);
  std::vector<NetworkCounts> all(networks.size());
  for (NetworkCounts& counts : all) counts.cancelled = true;
  pool_.work(networks.size(), networks_, progress,
             [&](Tracer& tracer, const Chunk& chunk, const Progress& own, const auto&) {
               const std::vector<NetworkCounts> counts =
                   tracer.count_each(networks.subspan(chunk.first, chunk.size()),
                                     station_counts.subspan(chunk.first, chunk.size()), options, own);
               // Each chunk has its own range of `all`.
               std::copy(counts.begin(), counts.end(), all.begin() + static_cast<std::ptrdiff_t>(chunk.first));
               return came_to_end(counts);
             });
  return all;
}

std::vector<NetworkCounts> SpreadTracer::count_sampled(std::span<const std::vector<TraceStation>> networks,
                                                       std::span<const std::uint32_t> station_counts,
                                                       const SampleJob& job, const Progress& progress) {
  // The case of a search; other outputs need all voxels of a network together.
  const bool sums_alone = job.groups == 0 && !job.points && !job.station_masks && !job.registration;
  return population_ == Population::by_voxels && sums_alone && !job.sample.empty() && pool_.left() > 1
             ? count_by_voxels(networks, station_counts, job, progress)
             : count_by_networks(networks, station_counts, job, progress);
}

std::vector<NetworkCounts> SpreadTracer::count_by_voxels(std::span<const std::vector<TraceStation>> networks,
                                                         std::span<const std::uint32_t> station_counts,
                                                         const SampleJob& job, const Progress& progress) {
  std::mutex mutex;
  std::vector<NetworkCounts> all(networks.size());
  const SampleRuns runs(job.sample.size());
  const std::size_t workers = pool_.left();
  const bool finished = pool_.work(
      runs.size(), runs_, progress, [&](Tracer& tracer, const Chunk& chunk, const Progress& own, const auto&) {
        const std::vector<std::uint32_t> voxels = runs.runs(job.sample, chunk.first, chunk.end);
        SampleJob part = job;
        part.sample = voxels, part.leave_out = {};
        const std::vector<NetworkCounts> counts = tracer.count_sampled(networks, station_counts, part, own);
        if (!came_to_end(counts)) return false;
        const std::lock_guard lock(mutex);
        for (std::size_t n = 0; n < counts.size(); ++n) add_voxels(all[n], counts[n]);
        return true;
      });
  settle(all, finished, workers);
  return all;
}

std::vector<NetworkCounts> SpreadTracer::count_by_networks(std::span<const std::vector<TraceStation>> networks,
                                                           std::span<const std::uint32_t> station_counts,
                                                           const SampleJob& job, const Progress& progress) {
  std::vector<NetworkCounts> all(networks.size());
  // A dropped worker may have delivered networks that another worker counts again.
  DeliverOnce deliver(job, networks.size());
  const std::size_t workers = pool_.left();
  const bool finished =
      pool_.work(networks.size(), samples_, progress,
                 [&](Tracer& tracer, const Chunk& chunk, const Progress& own, const WorkerPool::OnCaller& ask) {
                   std::vector<NetworkCounts> counts = tracer.count_sampled(
                       networks.subspan(chunk.first, chunk.size()), station_counts.subspan(chunk.first, chunk.size()),
                       deliver.chunk(chunk.first, ask), own);
                   const bool done = came_to_end(counts);
                   // Each chunk has its own range of `all`.
                   std::move(counts.begin(), counts.end(), all.begin() + static_cast<std::ptrdiff_t>(chunk.first));
                   return done;
                 });
  settle(all, finished, workers);
  return all;
}

}  // namespace vantage
