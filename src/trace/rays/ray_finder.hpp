// SPDX-License-Identifier: Apache-2.0
// A caller's own rays on a device. It answers a ray if float arithmetic certainly agrees with double precision, and
// leaves other rays open.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "scene/scene_data.hpp"
#include "shared/own_ray_types.h"
#include "vantage/trace.hpp"

namespace vantage {

enum class RayQuestion : std::uint32_t {
  nearest = own_rays_nearest,
  blocked = own_rays_blocked,
  count = own_rays_count
};

// Two slots of memory hold rays and answers, so that one can be filled and read while the other is at work.
class RayFinder {
 public:
  static constexpr std::size_t kSlots = 2;

  virtual ~RayFinder() = default;
  virtual const EngineInfo& info() const = 0;
  virtual std::size_t most_rays() const = 0;  // of a slot
  // Makes room in all slots, whose content is lost. REQUIRES: at most most_rays().
  virtual void reserve(std::size_t rays) = 0;
  virtual std::span<OwnRay> rays(std::size_t slot) = 0;
  // Finds answers to the first `count` rays of a slot; rays pass triangles from `end` on. One call at a time.
  virtual void find(std::size_t slot, std::size_t count, RayQuestion question, std::uint32_t end) = 0;
  // Returns answers as described in shared/own_ray_types.h.
  virtual std::span<const std::uint32_t> answers(std::size_t slot) const = 0;
  // Returns the device's seconds for all calls of find() so far, without transfers.
  virtual double device_seconds() const = 0;
};

// Returns null for the processor. Throws Error: no_suitable_device with every refusal, out_of_memory, device_failure.
std::unique_ptr<RayFinder> make_ray_finder(const DeviceChoice& device, const std::shared_ptr<const SceneData>& scene);

}  // namespace vantage
