// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <string>

#include "trace/vulkan/vulkan_tracer.hpp"

namespace vantage::vulkan {
namespace {

constexpr double seconds_per_submission = 0.25;
constexpr std::uint32_t stations_per_submission = 16, parts_per_submission = 256;
constexpr std::uint32_t dispatch_words = 3;  // of an indirect dispatch

}  // namespace

NetworkCounts VulkanTracer::count(std::span<const TraceStation> stations, std::uint32_t station_count,
                                  const CountOptions& options, const Progress& progress) {
  const auto voxels = static_cast<std::uint32_t>(scene_.grid->size());
  const std::uint32_t columns = scene_.pattern->columns(), rows = scene_.pattern->rows();
  const std::uint32_t mask_words = options.masks ? (station_count > 32 ? 2 : 1) : 0;
  ensure(counts_, voxels * sizeof(std::uint32_t), "counts");
  if (mask_words) ensure(masks_, std::uint64_t{voxels} * mask_words * sizeof(std::uint32_t), "station masks");
  ensure(station_counters_, 64 * 4 * sizeof(std::uint32_t), "station counters");
  const std::uint32_t tiles_in_row = groups_of(columns, tile_side), tiles = tiles_in_row * groups_of(rows, tile_side);
  const std::uint64_t list_words = std::uint64_t{tiles} * stations_per_submission + parts_per_submission;
  const bool with_starts = info_.engine == Engine::compute_bvh;
  if (options.skip) {
    ensure(tile_far_, std::uint64_t{tiles} * stations_per_submission * sizeof(std::uint32_t), "tile far");
    ensure(tile_list_, list_words * sizeof(std::uint32_t), "tile list");
    ensure(tile_dispatch_, parts_per_submission * dispatch_words * sizeof(std::uint32_t), "tile dispatch",
           VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT);
    ensure(tile_rays_, 2 * sizeof(std::uint32_t), "tile rays");
    if (with_starts) ensure(tile_starts_, list_words * tile_starts * sizeof(TileStart), "tile starts");
  }
  const std::array<std::uint32_t, 1> station_counts{station_count};
  const std::uint32_t stride = totals_seen + station_count + station_count * (station_count - 1) / 2;
  ensure_totals(1, 1, stride);
  Reduction reduction{counts_.address(), mask_words ? masks_.address() : 0, voxels, 1, mask_words, false};
  if (weights_) {
    reduction.weights = weights_.address();
    reduction.weight = {scene_.grid->total_weight()};
  }

  struct Part {  // rows of a station
    std::uint32_t station, first_row, row_count, slot;
    std::uint64_t list;  // its list of tiles within tile_list_, in words
  };
  const auto tile_push = [&](const Part& part, std::size_t k) {
    TilePush push{};
    push.tile_far = tile_far_.address() + std::uint64_t{part.slot} * tiles * sizeof(std::uint32_t);
    push.tile_list = tile_list_.address() + part.list * sizeof(std::uint32_t);
    push.dispatch = tile_dispatch_.address() + k * dispatch_words * sizeof(std::uint32_t);
    push.rays = tile_rays_.address();
    if (with_starts) push.starts = tile_starts_.address() + part.list * tile_starts * sizeof(TileStart);
    const Float3& origin = stations[part.station].origin;
    push.origin = {origin.x, origin.y, origin.z};
    push.first_row = part.first_row;
    push.row_count = part.row_count;
    return push;
  };
  std::uint64_t since_clamp = 0;
  const auto record_parts = [&](VkCommandBuffer c, std::span<const Part> parts) {
    if (options.skip) {
      vkCmdFillBuffer(c, tile_far_.handle(), 0, VK_WHOLE_SIZE, 0);
      vkCmdFillBuffer(c, tile_list_.handle(), 0, VK_WHOLE_SIZE, 0);
      vkCmdFillBuffer(c, tile_dispatch_.handle(), 0, VK_WHOLE_SIZE, 0);
    }
    shader_after_transfer(c);
    if (options.skip) {
      for (std::size_t k = 0; k < parts.size(); ++k)
        if (k == 0 || parts[k].slot != parts[k - 1].slot)
          kernels_.get(Kernel::tiles).dispatch(c, tile_push(parts[k], k), groups_of(scene_.grid->bricks().size()));
      shader_after_shader(c);
      for (std::size_t k = 0; k < parts.size(); ++k)
        kernels_.get(Kernel::tile_list)
            .dispatch(c, tile_push(parts[k], k),
                      groups_of(std::uint64_t{groups_of(parts[k].row_count, tile_side)} * tiles_in_row));
      shader_after_shader(c);
      for (std::size_t k = 0; with_starts && k < parts.size(); ++k)
        kernels_.get(Kernel::tile_starts)
            .dispatch(c, tile_push(parts[k], k),
                      groups_of(std::uint64_t{groups_of(parts[k].row_count, tile_side)} * tiles_in_row));
      if (with_starts) shader_after_shader(c);
    }
    // Counts are sums, so the parts need not wait for each other.
    const ComputePipeline& pipeline = kernels_.get(Kernel::count, {noise(), options.masks, options.skip});
    for (std::size_t k = 0; k < parts.size(); ++k) {
      const Part& part = parts[k];
      const TraceStation& station = stations[part.station];
      const std::uint64_t rays = std::uint64_t{part.row_count} * columns;
      if (since_clamp + rays > count_limit - 1) {
        shader_after_shader(c);
        const std::uint32_t groups = groups_of(voxels);
        kernels_.get(Kernel::clamp)
            .dispatch(c, ClampPush{counts_.address(), voxels, 0}, std::min(groups, 32768u), groups_of(groups, 32768u));
        shader_after_shader(c);
        since_clamp = 0;
      }
      since_clamp += rays;
      CountPush push{};
      push.counts = counts_.address();
      push.masks =
          mask_words ? masks_.address() + std::uint64_t{station.place / 32} * voxels * sizeof(std::uint32_t) : 0;
      push.station_counters = station_counters_.address();
      push.origin = {station.origin.x, station.origin.y, station.origin.z};
      push.place = station.place;
      push.first_row = part.first_row;
      push.row_count = part.row_count;
      if (!options.skip) {
        pipeline.dispatch(c, push, groups_of(columns, block_columns), groups_of(push.row_count, block_rows));
        continue;
      }
      const TilePush tile = tile_push(part, k);
      push.tile_far = tile.tile_far;
      push.tile_list = tile.tile_list;
      push.starts = tile.starts;
      pipeline.bind(c, &push);
      vkCmdDispatchIndirect(c, tile_dispatch_.handle(), k * dispatch_words * sizeof(std::uint32_t));
    }
  };

  NetworkCounts result;
  std::array<std::uint64_t, 64 * 2> counters{};
  std::uint64_t tile_rays = 0;
  std::vector<std::uint32_t> totals(stride);
  std::vector<Commands::Download> wanted{{totals_, totals.data(), stride * sizeof(std::uint32_t)},
                                         {station_counters_, counters.data(), sizeof counters}};
  if (options.skip) wanted.push_back({tile_rays_, &tile_rays, sizeof tile_rays});

  // As much work a submission as reports and stops in time.
  const std::uint64_t all_rays = std::uint64_t{rows} * columns * stations.size();
  std::uint64_t done_rays = 0;
  std::uint32_t station = 0, row = 0;
  for (bool first = true, last = false; !last; first = false) {
    std::vector<Part> parts;
    std::uint64_t rays = 0, list = 0;
    std::uint32_t slots = 0;
    result.cancelled = progress.stopped();
    while (!result.cancelled && station < stations.size() && rays < rays_per_submission_ &&
           parts.size() < parts_per_submission) {
      const bool same_station = !parts.empty() && parts.back().station == station;
      if (!same_station && slots == stations_per_submission) break;
      if (!same_station) ++slots;
      const std::uint32_t row_count = std::min(rows_per_dispatch(), rows - row);
      parts.push_back({station, row, row_count, slots - 1, list});
      list += 1 + std::uint64_t{groups_of(row_count, tile_side)} * tiles_in_row;
      rays += std::uint64_t{row_count} * columns;
      row += row_count;
      if (row == rows) {
        row = 0;
        ++station;
      }
    }
    last = result.cancelled || station == stations.size();
    const auto record = [&](VkCommandBuffer c) {
      if (first) {
        vkCmdFillBuffer(c, counts_.handle(), 0, voxels * sizeof(std::uint32_t), 0);
        if (mask_words)
          vkCmdFillBuffer(c, masks_.handle(), 0, std::uint64_t{voxels} * mask_words * sizeof(std::uint32_t), 0);
        vkCmdFillBuffer(c, station_counters_.handle(), 0, VK_WHOLE_SIZE, 0);
        if (options.skip) vkCmdFillBuffer(c, tile_rays_.handle(), 0, VK_WHOLE_SIZE, 0);
        record_totals_start(c, station_counts);
      }
      record_parts(c, parts);
      if (!last) return;
      shader_after_shader(c);
      record_reduction(c, reduction, 0, 1, stride);
    };
    const double seconds = commands_.run_and_download(
        record, last ? std::span<const Commands::Download>(wanted) : std::span<const Commands::Download>());
    result.trace_seconds += seconds;
    done_rays += rays;
    if (rays >= rays_per_dispatch() && seconds > 0)
      rays_per_submission_ =
          static_cast<std::uint64_t>(std::clamp(static_cast<double>(rays) / seconds * seconds_per_submission,
                                                static_cast<double>(rays_per_dispatch()), 1e12));
    if (!result.cancelled) progress(static_cast<double>(done_rays) / static_cast<double>(all_rays));
  }
  read_totals({&result, 1}, station_counts, totals, reduction, stride);

  result.points_on_surveyed.assign(station_count, 0);
  if (!options.skip) result.points.assign(station_count, 0);
  for (const TraceStation& each : stations) {
    if (!options.skip) result.points[each.place] = counters[2 * each.place];
    result.points_on_surveyed[each.place] = counters[2 * each.place + 1];
  }
  result.rays = options.skip ? tile_rays : all_rays;
  if (options.field) {
    options.field->count.resize(voxels);
    commands_.download(counts_, options.field->count.data(), voxels * sizeof(std::uint32_t));
    options.field->stations.assign(options.masks ? voxels : 0, 0);
    std::vector<std::uint32_t> word(voxels);
    for (std::uint32_t w = 0; w < mask_words; ++w) {
      commands_.download(masks_, word.data(), voxels * sizeof(std::uint32_t),
                         std::uint64_t{w} * voxels * sizeof(std::uint32_t));
      for (std::uint32_t v = 0; v < voxels; ++v) options.field->stations[v] |= std::uint64_t{word[v]} << (32 * w);
    }
  }
  return result;
}

}  // namespace vantage::vulkan
