// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include "core/parallel.hpp"
#include "trace/vulkan/count_schedule.hpp"
#include "trace/vulkan/vulkan_tracer.hpp"

namespace vantage::vulkan {
namespace {

constexpr std::uint32_t kMostStations = 64;
// kDispatchBytes: of an indirect dispatch
constexpr VkDeviceSize kWordBytes = sizeof(std::uint32_t), kDispatchBytes = 3 * kWordBytes;

KernelVariant count_kernel(Kernel kernel, const DeviceScanner& scanner, bool turned,
                           const Tracer::CountOptions& options) {
  if (kernel != Kernel::count) return {kernel, {}, turned};
  return {kernel, {scanner.noise(), scanner.limits(), options.masks, options.skip}, turned, scanner.listed()};
}

}  // namespace

std::vector<KernelVariant> VulkanTracer::count_kernels(const DeviceScanner& scanner, bool turned,
                                                       const CountOptions& options) const {
  std::vector<KernelVariant> all{count_kernel(Kernel::count, scanner, turned, options), {Kernel::reduce}};
  if (!options.skip) return all;
  for (const Kernel kernel : {Kernel::tiles, Kernel::tile_list, Kernel::tile_pass})
    if (kernel != Kernel::tile_pass || traversal_->tile_pass())
      all.push_back(count_kernel(kernel, scanner, turned, options));
  return all;
}

// Processes scanners one by one, each with all of its stations. With skipping, each submission first finds the tiles of
// directions that see a surveyed brick (tiles), lists them for each part (tile_list), runs the engine's tile pass, and
// counts only over the lists.
class VulkanTracer::ExactCount {
 public:
  ExactCount(VulkanTracer& tracer, std::span<const TraceStation> stations, std::uint32_t station_count,
             const CountOptions& options)
      : t_(tracer),
        stations_by_scanner_(tracer.scanners_.size()),
        station_counts_{station_count},
        options_(tracer.skipping_grids(options)),
        voxels_(static_cast<std::uint32_t>(tracer.scene_.grid->size())),
        mask_words_(options.masks ? (station_count > 32 ? 2 : 1) : 0),
        stride_(totals_seen + station_count + station_count * (station_count - 1) / 2),
        tile_pass_(options_.skip ? tracer.traversal_->tile_pass() : std::nullopt),
        totals_(stride_) {
    for (const TraceStation& station : stations) {
      const RayPattern& pattern = tracer.scanners_[station.scanner].pattern();
      stations_by_scanner_[station.scanner].push_back(station);
      all_rays_ += std::uint64_t{pattern.rows()} * pattern.columns();
    }
  }

  NetworkCounts run(const Progress& progress) {
    ensure_buffers();
    NetworkCounts result;
    double done_rays = 0;
    std::size_t scanner = std::min(next_scanner(0), stations_by_scanner_.size() - 1);  // any, if none has stations
    begin_scanner(scanner);
    for (bool first = true, last = false; !last; first = false) {
      result.cancelled = progress.stopped();
      const std::vector<CountPart> parts =
          result.cancelled ? std::vector<CountPart>() : schedule_->next(t_.exact_sizer_.rays());
      const std::size_t next = schedule_->finished() ? next_scanner(scanner + 1) : scanner;
      last = result.cancelled || next == stations_by_scanner_.size();
      const auto rays = static_cast<double>(schedule_->rays_of(parts));
      const double seconds = submit(parts, first, last);
      t_.exact_sizer_.observe(rays, seconds);
      result.trace_seconds += seconds;
      done_rays += rays;
      if (!result.cancelled) progress(done_rays / static_cast<double>(all_rays_));
      if (!last && next != scanner) begin_scanner(scanner = next);
    }
    t_.read_totals({&result, 1}, station_counts_, totals_, reduction(), stride_);
    read_counters(result);
    if (options_.field) read_field(*options_.field);
    return result;
  }

 private:
  // Returns the first scanner from there on that has stations.
  std::size_t next_scanner(std::size_t scanner) const {
    while (scanner < stations_by_scanner_.size() && stations_by_scanner_[scanner].empty()) ++scanner;
    return scanner;
  }

  void begin_scanner(std::size_t scanner) {
    scanner_ = &t_.scanners_[scanner];
    stations_ = stations_by_scanner_[scanner];
    const RayPattern& pattern = scanner_->pattern();
    schedule_.emplace(static_cast<std::uint32_t>(stations_.size()), pattern.rows(), pattern.columns(),
                      t_.rows_per_dispatch(pattern));
    for (const bool turned : {false, true})
      if (std::ranges::any_of(stations_, [&](const TraceStation& one) { return one.turn.has_value() == turned; }))
        t_.kernels_.compile(t_.count_kernels(*scanner_, turned, options_));
    if (!options_.skip) return;
    t_.ensure(t_.tiles_.far, std::uint64_t{schedule_->tiles()} * CountSchedule::kStationsPerSubmission * kWordBytes,
              "tile far");
    t_.ensure(t_.tiles_.list, schedule_->list_words() * kWordBytes, "tile list");
    if (tile_pass_) t_.ensure(t_.tiles_.starts, schedule_->list_words() * tile_pass_->bytes_per_tile, "tile starts");
  }

  void ensure_buffers() {
    t_.ensure(t_.sums_.counts, voxels_ * kWordBytes, "counts");
    if (mask_words_) t_.ensure(t_.sums_.masks, masks_bytes(), "station masks");
    t_.ensure(t_.sums_.station_counters, sizeof counters_, "station counters");
    t_.ensure_totals(1, 1, stride_);
    if (!options_.skip) return;
    t_.ensure(t_.tiles_.dispatch, CountSchedule::kPartsPerSubmission * kDispatchBytes, "tile dispatch",
              VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT);
    t_.ensure(t_.tiles_.rays, sizeof tile_rays_, "tile rays");
  }

  // Submits the parts and waits. The first submission clears the sums, the last reads them back.
  double submit(std::span<const CountPart> parts, bool first, bool last) {
    const auto record = [&](const Recorder& r) {
      if (first) record_start(r);
      if (options_.skip) record_tile_start(r);
      r.shader_after_transfer();
      if (options_.skip) record_tiles(r, parts);
      for (std::size_t k = 0; k < parts.size(); ++k) record_part(r, parts[k], k);
      if (!last) return;
      r.shader_after_shader();
      t_.record_reduction(r, reduction(), 0, 1, stride_);
    };
    std::vector<Commands::Download> wanted;
    if (last) {
      wanted.push_back({t_.sums_.totals, totals_.data(), totals_.size() * kWordBytes});
      wanted.push_back({t_.sums_.station_counters, counters_.data(), sizeof counters_});
      if (options_.skip) wanted.push_back({t_.tiles_.rays, &tile_rays_, sizeof tile_rays_});
    }
    return t_.commands_.run_and_download(record, wanted);
  }

  void record_start(const Recorder& r) {
    r.zero(t_.sums_.counts, 0, voxels_ * kWordBytes);
    if (mask_words_) r.zero(t_.sums_.masks, 0, masks_bytes());
    r.zero(t_.sums_.station_counters);
    if (options_.skip) r.zero(t_.tiles_.rays);
    t_.record_totals_start(r, station_counts_);
  }

  void record_tile_start(const Recorder& r) {
    r.zero(t_.tiles_.far);
    r.zero(t_.tiles_.list);
    r.zero(t_.tiles_.dispatch);
  }

  void record_tiles(const Recorder& r, std::span<const CountPart> parts) {
    for (std::size_t k = 0; k < parts.size(); ++k)
      if (k == 0 || parts[k].slot != parts[k - 1].slot)  // once per station
        r.dispatch(pipeline_of(Kernel::tiles, parts[k]), tile_push(parts[k], k),
                   groups_of(t_.scene_.grid->bricks().size()));
    r.shader_after_shader();
    const auto for_each_list = [&](Kernel each) {
      for (std::size_t k = 0; k < parts.size(); ++k)
        r.dispatch(pipeline_of(each, parts[k]), tile_push(parts[k], k), groups_of(schedule_->tiles_of(parts[k])));
      r.shader_after_shader();
    };
    for_each_list(Kernel::tile_list);
    if (tile_pass_) for_each_list(Kernel::tile_pass);
  }

  // Counts are sums, so parts of a submission need no barriers between them.
  void record_part(const Recorder& r, const CountPart& part, std::size_t k) {
    if (headroom_.clamp_before(schedule_->rays_of({&part, 1}))) record_clamp(r);
    const BoundPipeline pipeline = pipeline_of(Kernel::count, part);
    const CountPush push = count_push(part, k);
    if (options_.skip) {
      r.dispatch_indirect(pipeline, push, t_.tiles_.dispatch, k * kDispatchBytes);
    } else {
      r.dispatch(pipeline, push, groups_of(scanner_->pattern().columns(), block_columns),
                 groups_of(part.row_count, scanner_->rows_of_group()));
    }
  }

  BoundPipeline pipeline_of(Kernel kernel, const CountPart& part) const {
    const bool turned = stations_[part.station].turn.has_value();
    return t_.kernels_.get(scanner_->set(), count_kernel(kernel, *scanner_, turned, options_));
  }

  void record_clamp(const Recorder& r) {
    const std::uint32_t groups = groups_of(voxels_);
    r.shader_after_shader();
    r.dispatch(t_.kernels_.get(Kernel::clamp), ClampPush{t_.sums_.counts.address(), voxels_, 0},
               std::min(groups, groups_in_row), groups_of(groups, groups_in_row));
    r.shader_after_shader();
  }

  // `k`: index of the part in its submission.
  TilePush tile_push(const CountPart& part, std::size_t k) const {
    TilePush push{};
    push.tile_far = t_.tiles_.far.address() + std::uint64_t{part.slot} * schedule_->tiles() * kWordBytes;
    push.tile_list = t_.tiles_.list.address() + part.list * kWordBytes;
    push.dispatch = t_.tiles_.dispatch.address() + k * kDispatchBytes;
    push.rays = t_.tiles_.rays.address();
    if (tile_pass_) push.starts = t_.tiles_.starts.address() + part.list * tile_pass_->bytes_per_tile;
    const Float3& origin = stations_[part.station].origin;
    push.origin = {origin.x, origin.y, origin.z};
    set_turn(push.turn, stations_[part.station]);
    push.first_row = part.first_row;
    push.row_count = part.row_count;
    return push;
  }

  CountPush count_push(const CountPart& part, std::size_t k) const {
    const TraceStation& station = stations_[part.station];
    CountPush push{};
    push.counts = t_.sums_.counts.address();
    push.masks = mask_words_ ? t_.sums_.masks.address() + std::uint64_t{station.bit() / 32} * voxels_ * kWordBytes : 0;
    push.counters = t_.sums_.station_counters.address();
    push.origin = {station.origin.x, station.origin.y, station.origin.z};
    set_turn(push.turn, station);
    push.place = station.place;
    push.first_row = part.first_row;
    push.row_count = part.row_count;
    if (options_.skip) {
      const TilePush tile = tile_push(part, k);
      push.tile_far = tile.tile_far;
      push.tile_list = tile.tile_list;
      push.starts = tile.starts;
    }
    return push;
  }

  Reduction reduction() const {
    Reduction reduction{t_.sums_.counts.address(),
                        mask_words_ ? t_.sums_.masks.address() : 0,
                        voxels_,
                        1,
                        mask_words_,
                        false,
                        t_.device_scene_.demands().addresses()};
    if (t_.device_scene_.demands().weights) reduction.weight = {t_.scene_.grid->total_weight()};
    return reduction;
  }

  void read_counters(NetworkCounts& result) const {
    result.points_on_surveyed.assign(station_counts_[0], 0);
    if (!options_.skip) result.points.assign(station_counts_[0], 0);
    if (t_.limited()) result.dropped.assign(station_counts_[0], {});
    for (std::uint32_t bit = 0; bit < station_counts_[0]; ++bit) {
      const std::uint64_t* const own = counters_.data() + std::size_t{station_counters} * bit;
      if (!options_.skip) result.points[bit] = own[counter_points];
      result.points_on_surveyed[bit] = own[counter_counted];
      if (t_.limited())
        result.dropped[bit] = {own[counter_dropped], own[counter_misses], own[counter_misses + 1],
                               own[counter_misses + 2], own[counter_misses + 3]};
    }
    result.rays = options_.skip ? tile_rays_ : all_rays_;
  }

  void read_field(PassField& field) {
    field.count.resize(voxels_);
    t_.commands_.download(t_.sums_.counts, field.count.data(), voxels_ * kWordBytes);
    field.stations.resize(options_.masks ? voxels_ : 0);
    constexpr std::uint32_t kTogether = 1 << 22;  // voxels whose masks are in transfer at once
    std::array<std::vector<std::uint32_t>, 2> bits;
    for (std::uint32_t first = 0; mask_words_ > 0 && first < voxels_; first += std::min(kTogether, voxels_ - first)) {
      const std::uint32_t count = std::min(kTogether, voxels_ - first);
      for (std::uint32_t w = 0; w < mask_words_; ++w) {
        bits[w].resize(count);
        t_.commands_.download(t_.sums_.masks, bits[w].data(), count * kWordBytes,
                              (std::uint64_t{w} * voxels_ + first) * kWordBytes);
      }
      parallel::for_all(std::uint32_t{0}, count, [&](std::uint32_t v) {
        field.stations[first + v] = bits[0][v] | (mask_words_ > 1 ? std::uint64_t{bits[1][v]} << 32 : 0);
      });
    }
  }

  VkDeviceSize masks_bytes() const { return std::uint64_t{voxels_} * mask_words_ * kWordBytes; }

  VulkanTracer& t_;
  std::vector<std::vector<TraceStation>> stations_by_scanner_;
  std::array<std::uint32_t, 1> station_counts_;
  CountOptions options_;
  std::uint32_t voxels_, mask_words_, stride_;
  std::uint64_t all_rays_ = 0;
  // Current scanner.
  const DeviceScanner* scanner_ = nullptr;
  std::span<const TraceStation> stations_;
  std::optional<CountSchedule> schedule_;
  CountHeadroom headroom_;
  std::optional<Traversal::TilePass> tile_pass_;
  // Read back from the device.
  std::vector<std::uint32_t> totals_;
  std::array<std::uint64_t, std::size_t{station_counters} * kMostStations> counters_{};  // of every place
  std::uint64_t tile_rays_ = 0;
};

NetworkCounts VulkanTracer::count(std::span<const TraceStation> stations, std::uint32_t station_count,
                                  const CountOptions& options, const Progress& progress) {
  return ExactCount(*this, stations, station_count, options).run(progress);
}

}  // namespace vantage::vulkan
