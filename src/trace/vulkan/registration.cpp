// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "shared/registration_types.h"
#include "trace/vulkan/vulkan_tracer.hpp"

namespace vantage::vulkan {

void VulkanTracer::upload_patches(const RegistrationJob& job) {
  if (registration_.uploaded_patches != job.patches)
    registration_.patches =
        make_device_buffer<RegistrationPatch>(device_, commands_, job.patches->patches, "registration patches");
  const std::shared_ptr<const NoiseModel>& noise = job.scanners.front().noise;
  if (registration_.uploaded_noise != noise && noise->enabled())
    registration_.sigma = make_device_buffer<float>(device_, commands_, noise->sigma, "registration sigma table");
  registration_.uploaded_patches = job.patches, registration_.uploaded_noise = noise;
}

std::vector<RegistrationSums> VulkanTracer::sum_registration(const RegistrationJob& job, const RegisteredNetworks& of) {
  upload_patches(job);
  const auto networks = static_cast<std::uint32_t>(of.networks.size());
  const std::uint32_t most = *std::ranges::max_element(of.station_counts), pairs = most * (most - 1) / 2;
  // The heads of all networks, then the directions in which scans begin.
  std::vector<vec3> heads(std::size_t{networks + start_draws} * most);
  for (std::size_t n = 0; n < networks; ++n)
    for (const TraceStation& s : of.networks[n]) heads[n * most + s.place] = {s.origin.x, s.origin.y, s.origin.z};
  for (std::uint32_t draw = 0; draw < start_draws; ++draw)
    for (std::uint32_t place = 0; place < most; ++place) {
      const Float3 start = scan_start(place, draw);
      heads[std::size_t{networks + draw} * most + place] = {start.x, start.y, start.z};
    }
  const double deviation = deviation_unit(job.scanners);
  const std::uint32_t stride = pairs * pair_sums + most * (station_sums + (deviation > 0 ? instrument_sums : 0));
  std::vector<std::int64_t> sums(std::size_t{networks} * stride);
  ensure(registration_.heads, heads.size() * sizeof(vec3), "registration heads");
  ensure(registration_.sums, sums.size() * sizeof(std::int64_t), "registration sums");
  ensure(sums_.station_counts, networks * sizeof(std::uint32_t), "station counts");
  commands_.upload(registration_.heads, heads.data(), heads.size() * sizeof(vec3));
  commands_.upload(sums_.station_counts, of.station_counts.data(), of.station_counts.size_bytes());
  RegisterPush push{};
  push.patches = registration_.patches.address();
  push.masks = sums_.masks.address();
  push.heads = registration_.heads.address();
  push.starts = registration_.heads.address() + std::uint64_t{networks} * most * sizeof(vec3);
  push.station_counts = sums_.station_counts.address();
  push.sums = registration_.sums.address();
  push.sigma = registration_.uploaded_noise->enabled() ? registration_.sigma.address() : 0;
  push.voxel_count = of.voxels;
  push.mask_words = of.mask_words;
  push.heads_stride = most;
  push.sums_stride = stride;
  push.units = static_cast<float>(kPatchWeightUnits / job.patches->largest);
  push.noise_min_range = registration_.uploaded_noise->min_range;
  push.noise_inverse_span = registration_.uploaded_noise->inverse_span;
  const DeviationErrors errors = deviation_errors(job.scanners.front(), deviation);
  push.angle = errors.angle, push.offset = errors.offset, push.scale = errors.scale;
  // The same threads take a pair each, and an error of a station each.
  const std::uint32_t threads = std::max({pairs, deviation > 0 ? most * instrument_errors : 0, 1u});
  const auto record = [&](const Recorder& r) {
    r.zero(registration_.sums, 0, sums.size() * sizeof(std::int64_t));
    r.shader_after_transfer();
    r.dispatch(kernels_.get(Kernel::registration), push, groups_of(of.voxels, register_voxels * register_rounds),
               groups_of(threads, register_pairs), networks);
  };
  const Commands::Download wanted{registration_.sums, sums.data(), sums.size() * sizeof(std::int64_t)};
  commands_.run_and_download(record, {&wanted, 1});
  std::vector<RegistrationSums> result;
  for (std::size_t n = 0; n < networks; ++n)
    result.push_back(registration_sums(*job.patches, of.networks[n], of.station_counts[n],
                                       std::span(sums).subspan(n * stride, stride), deviation));
  return result;
}

}  // namespace vantage::vulkan
