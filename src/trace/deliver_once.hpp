// SPDX-License-Identifier: Apache-2.0
// Delivers each network's result once when a sampled count is made in pieces and some are repeated.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "trace/tracer.hpp"

namespace vantage {

class DeliverOnce {
 public:
  // Borrows the job.
  DeliverOnce(const Tracer::SampleJob& job, std::size_t networks)
      : job_(job), points_(job.points ? networks : 0), masks_(job.station_masks ? networks : 0) {}

  // Returns the job for the networks from `first` on. It delivers by `ask`, which calls on the caller's thread.
  using OnCaller = std::function<void(const std::function<void()>&)>;
  Tracer::SampleJob chunk(std::size_t first, const OnCaller& ask) {
    Tracer::SampleJob part = job_;
    if (job_.points)
      part.points = [this, first, &ask](std::size_t k, std::span<const std::uint32_t> points) {
        ask([&] {
          if (points_[first + k]) return;
          job_.points(first + k, points);
          points_[first + k] = true;
        });
      };
    if (job_.station_masks)
      part.station_masks = [this, first, &ask](std::size_t k, std::span<const std::uint64_t> masks) {
        ask([&] { deliver_masks(first + k, masks); });
      };
    return part;
  }

 private:
  void deliver_masks(std::size_t first, std::span<const std::uint64_t> masks) {
    const std::size_t voxels = job_.sample.size(), end = masks.size() / voxels;
    for (std::size_t k = 0; k < end;) {
      std::size_t run = k;
      while (run < end && !masks_[first + run]) masks_[first + run++] = true;
      if (run > k) job_.station_masks(first + k, masks.subspan(k * voxels, (run - k) * voxels));
      k = run + 1;
    }
  }

  const Tracer::SampleJob& job_;
  std::vector<bool> points_, masks_;
};

}  // namespace vantage
