// SPDX-License-Identifier: Apache-2.0
// A Vulkan device that traces: scene, the engine's Traversal, and buffers kept from call to call. Engines differ only
// in the Traversal.
//
//   device_scene.hpp     uploads that are made once
//   scan_station.cpp     points of one station
//   count_network.cpp    every ray of a network
//   sample_networks.cpp  rays of sampled voxels, for many networks
//   reduction.cpp        counts and masks to the sums for coverage and overlap
//   registration.cpp     masks to the sums for the registration error
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/lru_cache.hpp"
#include "shared/trace_types.h"
#include "trace/registration_sums.hpp"
#include "trace/tracer.hpp"
#include "trace/vulkan/commands.hpp"
#include "trace/vulkan/device_scanner.hpp"
#include "trace/vulkan/device_scene.hpp"
#include "trace/vulkan/dispatch_sizer.hpp"
#include "trace/vulkan/groups.hpp"
#include "trace/vulkan/kernels.hpp"
#include "trace/vulkan/pair_schedule.hpp"
#include "trace/vulkan/traversal.hpp"

namespace vantage::vulkan {

// Chosen so that a dispatch takes a fraction of a watchdog's limit even on a slow device of its kind.
inline constexpr std::uint64_t kHardwareRaysPerDispatch = std::uint64_t{1} << 26,
                               kSoftwareRaysPerDispatch = std::uint64_t{1} << 19;

// A sample in the kernels' format.
struct DeviceSample {
  std::vector<std::uint32_t> voxel_indices;
  Buffer voxels, in_order_of_chunks;
  DeviceDemands demands;
};

// Counts and masks of voxels, and the sums that they are reduced to.
struct SumBuffers {
  Buffer counts, masks, station_counters, totals, station_counts;
};

// Tiles of directions that an exact count with skipping visits.
struct TileBuffers {
  Buffer far, list, dispatch, rays, starts;
};

// Lists of a sampled count.
struct SampleBuffers {
  Buffer stations, pairs, rays, sights, items, control, slot_rays;
};

// Inputs of registration sums, and the sums.
struct RegistrationBuffers {
  std::shared_ptr<const Patches> uploaded_patches;
  std::shared_ptr<const NoiseModel> uploaded_noise;
  Buffer patches, sigma, heads, sums;
};

class VulkanTracer final : public Tracer {
 public:
  // Throws Error invalid_argument if a pattern has 2^31 rays or more.
  VulkanTracer(const VulkanEngine& engine, const EngineInfo& info, std::shared_ptr<Instance> instance,
               VkPhysicalDevice physical, const DeviceAbilities& abilities, const TraceScene& scene);

  const EngineInfo& info() const override { return info_; }
  std::uint64_t uploaded_bytes() const override { return commands_.uploaded_bytes(); }
  std::uint64_t preferred_scan_rays(std::uint32_t scanner) const override {
    const std::uint64_t columns = scanners_[scanner].pattern().columns();
    return std::max<std::uint64_t>(std::min(rays_per_dispatch(), std::uint64_t{1} << 22) / columns, 1) * columns;
  }

  void scan(const TraceStation& station, std::uint64_t first_ray, std::uint64_t ray_count, std::uint32_t outputs,
            RawChunk& chunk) override;
  NetworkCounts count(std::span<const TraceStation> stations, std::uint32_t station_count, const CountOptions& options,
                      const Progress& progress) override;
  std::vector<NetworkCounts> count_sampled(std::span<const std::vector<TraceStation>> networks,
                                           std::span<const std::uint32_t> station_counts, const SampleJob& job,
                                           const Progress& progress) override;
  // Takes a scene in which meshes have moved. After an error the tracer must not be used.
  bool take(const TraceScene& later, const SceneDifference& difference) override;

 private:
  // State of one call of count() or of count_sampled().
  class ExactCount;
  class SampledCount;

  std::unique_ptr<Traversal> build_traversal(const VulkanEngine& engine);
  std::vector<DeviceScanner> make_scanners();
  const DeviceSample& upload_sample(std::span<const std::uint32_t> sample);
  DeviceSample device_sample(std::span<const std::uint32_t> sample);
  // Returns the kernels for an exact count of stations of one scanner.
  std::vector<KernelVariant> count_kernels(const DeviceScanner& scanner, bool turned,
                                           const CountOptions& options) const;
  SampleRoom room_for_sample() const { return sample_room(info_.software, scene_.max_rays_per_dispatch); }
  bool limited() const { return scanners_.front().limits(); }  // either all scanners are limited or none
  std::uint64_t rays_per_dispatch() const {
    if (scene_.max_rays_per_dispatch > 0) return scene_.max_rays_per_dispatch;
    return info_.software ? kSoftwareRaysPerDispatch : kHardwareRaysPerDispatch;
  }
  // Returns the sum of point weights that fills a voxel.
  std::uint64_t goal_point_weight() const {
    const double least = scene_.grid->demands().least_point_weight();
    return static_cast<std::uint64_t>(std::min(std::ceil(goal_density_ * least), count_limit * least));
  }
  // Returns a shift that lets `voxels` squares of nearly the goal fit in 64 bits; 0 for goals in scanners' reach.
  std::uint32_t difference_shift(std::uint32_t voxels) const {
    const int bits =
        2 * static_cast<int>(std::bit_width(goal_point_weight())) + static_cast<int>(std::bit_width(voxels));
    return static_cast<std::uint32_t>(std::max(0, bits - 62) / 2);
  }
  // Directions of a list form no tiles to skip.
  CountOptions skipping_grids(CountOptions options) const {
    options.skip = options.skip && std::ranges::none_of(scanners_, &DeviceScanner::listed);
    return options;
  }
  std::uint32_t rows_per_dispatch(const RayPattern& pattern) const {
    const std::uint64_t rows = rays_per_dispatch() / pattern.columns() / tile_side * tile_side;
    return static_cast<std::uint32_t>(
        std::clamp<std::uint64_t>(rows, tile_side, std::uint64_t{kMostGroups} * block_rows));
  }

  // Sets rows in the kernels' format; upright stations need none.
  static void set_turn(vec3 (&rows)[3], const TraceStation& station) {
    if (!station.turn) return;
    const Float3* const own[3] = {&station.turn->x, &station.turn->y, &station.turn->z};
    for (std::size_t k = 0; k < 3; ++k) rows[k] = {own[k]->x, own[k]->y, own[k]->z};
  }

  // Grows a buffer that is kept from call to call.
  void ensure(Buffer& buffer, VkDeviceSize bytes, const char* name, VkBufferUsageFlags extra = 0) {
    if (!buffer || buffer.size() < bytes) {
      buffer = Buffer();  // frees the old one first, so that both never coexist
      buffer = Buffer(device_, bytes, Buffer::Where::device, name, extra);
    }
  }

  // Records the reduction of `networks` blocks of counts and masks, and reads totals back into counts.
  struct Reduction {
    std::uint64_t counts, masks;  // addresses
    std::uint32_t voxels, groups, mask_words;
    bool differences;
    DemandAddresses demands = {};
    std::vector<std::uint64_t> weight = {};  // per group, if voxels have weights
  };
  void record_reduction(const Recorder& r, const Reduction& reduction, std::uint32_t first_network,
                        std::uint32_t networks, std::uint32_t stride);
  void read_totals(std::span<NetworkCounts> counts, std::span<const std::uint32_t> station_counts,
                   std::span<const std::uint32_t> totals, const Reduction& reduction, std::uint32_t stride) const;
  void ensure_totals(std::size_t networks, std::uint32_t groups, std::uint32_t stride);
  void record_totals_start(const Recorder& r, std::span<const std::uint32_t> station_counts);

  // Sums of consecutive networks whose masks are on the device.
  struct RegisteredNetworks {
    std::span<const std::vector<TraceStation>> networks;
    std::span<const std::uint32_t> station_counts;
    std::uint32_t voxels, mask_words;
  };
  void upload_patches(const RegistrationJob& job);
  std::vector<RegistrationSums> sum_registration(const RegistrationJob& job, const RegisteredNetworks& of);

  EngineInfo info_;
  TraceScene scene_;
  Device device_;
  Commands commands_;
  std::unique_ptr<Traversal> traversal_;
  std::vector<DeviceScanner> scanners_;
  DeviceScene device_scene_;
  Kernels kernels_;
  DispatchSizer exact_sizer_, sampled_sizer_;
  PairsSeen pairs_seen_{.rays = 8, .open = 1};  // sizes chunks, never affects results

  // Kept from call to call, grown by ensure().
  SumBuffers sums_;
  TileBuffers tiles_;
  SampleBuffers sample_;
  LruCache<DeviceSample> samples_;
  RegistrationBuffers registration_;
};

}  // namespace vantage::vulkan
