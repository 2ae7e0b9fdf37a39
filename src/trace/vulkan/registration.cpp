// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "shared/registration_types.h"
#include "trace/vulkan/vulkan_tracer.hpp"

namespace vantage::vulkan {

void VulkanTracer::upload_patches(const RegistrationJob& job) {
  if (patches_ != job.patches)
    registration_patches_ = to_device<RegistrationPatch>(job.patches->patches, "registration patches");
  const std::shared_ptr<const NoiseModel>& noise = job.scanners.front().noise;
  if (patch_noise_ != noise && noise->enabled())
    registration_sigma_ = to_device<float>(noise->sigma, "registration sigma table");
  patches_ = job.patches, patch_noise_ = noise;
}

std::vector<RegistrationSums> VulkanTracer::sum_registration(const RegistrationJob& job, const RegisteredNetworks& of) {
  upload_patches(job);
  const auto networks = static_cast<std::uint32_t>(of.networks.size());
  const std::uint32_t most = *std::ranges::max_element(of.station_counts), pairs = most * (most - 1) / 2;
  std::vector<vec3> heads(std::size_t{networks} * most);
  for (std::size_t n = 0; n < networks; ++n)
    for (const TraceStation& s : of.networks[n]) heads[n * most + s.place] = {s.origin.x, s.origin.y, s.origin.z};
  const std::uint32_t stride = pairs * pair_sums + most * station_sums;
  std::vector<std::int64_t> sums(std::size_t{networks} * stride);
  ensure(registration_heads_, heads.size() * sizeof(vec3), "registration heads");
  ensure(registration_sums_, sums.size() * sizeof(std::int64_t), "registration sums");
  ensure(station_counts_, networks * sizeof(std::uint32_t), "station counts");
  commands_.upload(registration_heads_, heads.data(), heads.size() * sizeof(vec3));
  commands_.upload(station_counts_, of.station_counts.data(), of.station_counts.size_bytes());
  RegisterPush push{};
  push.patches = registration_patches_.address();
  push.masks = masks_.address();
  push.heads = registration_heads_.address();
  push.station_counts = station_counts_.address();
  push.sums = registration_sums_.address();
  push.sigma = patch_noise_->enabled() ? registration_sigma_.address() : 0;
  push.voxel_count = of.voxels;
  push.mask_words = of.mask_words;
  push.heads_stride = most;
  push.sums_stride = stride;
  push.units = static_cast<float>(patch_weight_units / job.patches->largest);
  push.noise_min_range = patch_noise_->min_range;
  push.noise_inverse_span = patch_noise_->inverse_span;
  const auto record = [&](const Recorder& r) {
    r.zero(registration_sums_, 0, sums.size() * sizeof(std::int64_t));
    r.shader_after_transfer();
    r.dispatch(kernels_.get(Kernel::registration), push, groups_of(of.voxels, register_voxels * register_rounds),
               groups_of(std::max(pairs, 1u), register_pairs), networks);
  };
  const Commands::Download wanted{registration_sums_, sums.data(), sums.size() * sizeof(std::int64_t)};
  commands_.run_and_download(record, {&wanted, 1});
  std::vector<RegistrationSums> result;
  for (std::size_t n = 0; n < networks; ++n)
    result.push_back(registration_sums(*job.patches, of.networks[n], of.station_counts[n],
                                       std::span(sums).subspan(n * stride, stride)));
  return result;
}

}  // namespace vantage::vulkan
