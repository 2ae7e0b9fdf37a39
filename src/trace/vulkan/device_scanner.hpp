// SPDX-License-Identifier: Apache-2.0
// A scanner on the device: tables of its pattern, noise and limits, and its parameter block for kernels.
#pragma once

#include "shared/trace_types.h"
#include "trace/direction_list.hpp"
#include "trace/tracer.hpp"
#include "trace/vulkan/buffer.hpp"
#include "trace/vulkan/commands.hpp"
#include "trace/vulkan/trace_set.hpp"

namespace vantage::vulkan {

class DeviceScanner {
 public:
  // Throws Error invalid_argument if the pattern has 2^31 rays or more, or a walk as many places. `structure`:
  // acceleration structure for ray queries, or null; it must outlive this object.
  DeviceScanner(Device& device, Commands& commands, VkAccelerationStructureKHR structure, const SceneData& scene,
                const TraceScanner& scanner);

  const RayPattern& pattern() const { return *scanner_.pattern; }
  bool noise() const { return scanner_.noise && scanner_.noise->enabled(); }
  bool limits() const { return scanner_.limits && scanner_.limits->enabled(); }
  bool listed() const { return pattern().list != nullptr; }
  // Returns most places of a walk through rays near a voxel; each band of a list counts as long as the longest.
  std::uint64_t longest_walk() const;
  // Returns the rows of a workgroup that scans or counts without tiles.
  std::uint32_t rows_of_group() const { return listed() ? group_size : block_rows; }
  bool glass() const { return limits() && scanner_.limits->glass; }
  const TraceSet& set() const { return set_; }

  // Writes the block: the part about scene and voxels that all scanners share, and this scanner's own.
  void write(Commands& commands, const TraceParameters& shared) const;

 private:
  // Returns the noise model that displaces ranges, or, if ranges are exact, limits them; null without both.
  const NoiseModel* sigma_model() const {
    return noise() ? scanner_.noise.get() : limits() ? scanner_.limits->noise.get() : nullptr;
  }
  void upload_list(Device& device, Commands& commands, const DirectionList& list);
  void upload_limits(Device& device, Commands& commands, const SceneData& scene);

  TraceScanner scanner_;
  Buffer block_;
  TraceSet set_;
  Buffer sin_zenith_, cos_zenith_, sin_azimuth_, cos_azimuth_, sigma_, reaches_, limits_, limits_of_, list_rays_,
      list_azimuths_, list_offsets_;
};

}  // namespace vantage::vulkan
