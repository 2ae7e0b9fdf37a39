// SPDX-License-Identifier: Apache-2.0
#include "trace/vulkan/device_scanner.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "trace/noise_reach.hpp"
#include "trace/vulkan/groups.hpp"
#include "trace/vulkan/placed_meshes.hpp"
#include "vantage/error.hpp"

namespace vantage::vulkan {

DeviceScanner::DeviceScanner(Device& device, Commands& commands, VkAccelerationStructureKHR structure,
                             const SceneData& scene, const TraceScanner& scanner)
    : scanner_(scanner),
      block_(device, sizeof(TraceParameters), Buffer::Where::device, "trace parameters",
             VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT),
      set_(device, block_, structure) {
  const RayPattern& pattern = *scanner.pattern;
  if ((!listed() && pattern.rows() > kMostGroups * block_rows) || longest_walk() >= std::uint64_t{1} << 31)
    throw Error(
        Errc::invalid_argument,
        listed()
            ? "most of the scanner's directions have one zenith, and others are spread over its field: this engine "
              "takes no such list; use the engine embree"
            : "the scan pattern has " + std::to_string(pattern.rows()) + " x " + std::to_string(pattern.columns()) +
                  " rays; this engine takes fewer than 2^31 a station: use larger steps");
  const auto to_device = [&](std::span<const float> values, const char* name) {
    return make_device_buffer<float>(device, commands, values, name);
  };
  sin_zenith_ = to_device(pattern.sin_zenith, "sin zenith");
  cos_zenith_ = to_device(pattern.cos_zenith, "cos zenith");
  sin_azimuth_ = to_device(pattern.list ? pattern.list->sin_azimuth : pattern.sin_azimuth, "sin azimuth");
  cos_azimuth_ = to_device(pattern.list ? pattern.list->cos_azimuth : pattern.cos_azimuth, "cos azimuth");
  if (pattern.list) upload_list(device, commands, *pattern.list);
  if (limits()) upload_limits(device, commands, scene);
  if (const NoiseModel* const looked_up = sigma_model()) sigma_ = to_device(looked_up->sigma, "sigma table");
  if (noise()) reaches_ = to_device(noise_reaches(*scanner_.noise)->front(), "reaches of noise");
}

std::uint64_t DeviceScanner::longest_walk() const {
  if (const DirectionList* const list = pattern().list.get())
    return std::uint64_t{list->band_offsets().size() - 1} * list->longest_band();
  return std::uint64_t{pattern().rows()} * pattern().columns();
}

void DeviceScanner::upload_list(Device& device, Commands& commands, const DirectionList& list) {
  const std::vector<float> azimuths(list.sorted_azimuths().begin(), list.sorted_azimuths().end());
  const std::vector<std::uint32_t> offsets(list.band_offsets().begin(), list.band_offsets().end());
  list_rays_ = make_device_buffer<std::uint32_t>(device, commands, list.sorted_rays(), "rays of the list");
  list_azimuths_ = make_device_buffer<float>(device, commands, azimuths, "azimuths of the list");
  list_offsets_ = make_device_buffer<std::uint32_t>(device, commands, offsets, "bands of the list");
}

// Meshes with equal limits share one entry.
void DeviceScanner::upload_limits(Device& device, Commands& commands, const SceneData& scene) {
  std::vector<LimitModel::Limits> distinct;
  std::vector<PointLimits> limits;
  std::vector<std::uint32_t> of_mesh;
  for (std::size_t m = 0; m < scene.ranges.size(); ++m) {
    const LimitModel::Limits& own = scanner_.limits->meshes[m];
    const auto found = std::ranges::find(distinct, own);
    const auto index = static_cast<std::uint32_t>(found - distinct.begin());
    if (found == distinct.end()) {
      distinct.push_back(own);
      limits.push_back(
          {own.least_cosine_square, own.largest_footprint_square, own.largest_sigma, own.largest_reach_square});
    }
    of_mesh.push_back(index);
  }
  limits_ = make_device_buffer<PointLimits>(device, commands, limits, "point limits");
  limits_of_ = make_device_buffer<std::uint32_t>(
      device, commands, per_surface<std::uint32_t>(scene, [&](std::size_t m) { return of_mesh[m]; }),
      "limits of triangles");
}

void DeviceScanner::write(Commands& commands, const TraceParameters& shared) const {
  const RayPattern& pattern = *scanner_.pattern;
  TraceParameters p = shared;
  p.sin_zenith = sin_zenith_.address();
  p.cos_zenith = cos_zenith_.address();
  p.sin_azimuth = sin_azimuth_.address();
  p.cos_azimuth = cos_azimuth_.address();
  p.rows = pattern.rows();
  p.columns = pattern.columns();
  p.min_range = pattern.min_range;
  p.max_range = pattern.max_range;
  p.zenith_step = static_cast<float>(pattern.zenith_step);
  p.azimuth_step = static_cast<float>(pattern.azimuth_step);
  p.first_zenith = static_cast<float>(pattern.first_zenith);
  p.first_azimuth = static_cast<float>(pattern.first_azimuth);
  if (const DirectionList* const list = pattern.list.get()) {
    p.list_rays = list_rays_.address();
    p.list_azimuths = list_azimuths_.address();
    p.list_offsets = list_offsets_.address();
    p.list_bands = static_cast<std::uint32_t>(list->band_offsets().size() - 1);
    p.zenith_step = static_cast<float>(list->band_height());
    p.first_zenith = static_cast<float>(list->first_zenith());
    p.first_azimuth = 0;
  }
  if (noise() || limits()) {
    const std::uint64_t seed = limits() ? scanner_.limits->seed : scanner_.noise->seed;
    p.seed_low = static_cast<std::uint32_t>(seed);
    p.seed_high = static_cast<std::uint32_t>(seed >> 32);
  }
  if (noise()) {
    p.noise_reach = scanner_.noise->reach;
    p.reaches = reaches_.address();
  }
  if (limits()) {
    p.limits = limits_.address();
    p.limits_of = limits_of_.address();
    p.exit_diameter = scanner_.limits->exit_diameter;
    p.divergence = scanner_.limits->divergence;
    p.lost_below = scanner_.limits->lost_below;
  }
  if (!glass()) p.glass_nodes = p.glass_corners = 0;
  if (const NoiseModel* const looked_up = sigma_model()) {
    p.sigma = sigma_.address();
    p.noise_min_range = looked_up->min_range;
    p.noise_inverse_span = looked_up->inverse_span;
  }
  commands.upload(block_, &p, sizeof p);
}

}  // namespace vantage::vulkan
