// SPDX-License-Identifier: Apache-2.0
// Processes many rays with a finder, batch by batch: while the device has one batch, the processor reads the previous
// and fills the next. A device that fails is set up anew, once for each batch. A batch that does not fit into its
// memory is halved.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <mutex>
#include <span>
#include <thread>

#include "trace/rays/ray_finder.hpp"
#include "vantage/progress.hpp"

namespace vantage {

// Calls from several threads take turns.
class RayBatches {
 public:
  using Make = std::function<std::unique_ptr<RayFinder>()>;
  // Calls `make` at once, and again after a DeviceFault; a second fault is thrown.
  explicit RayBatches(Make make);

  bool on_device() const { return on_device_; }  // false: `make` gave none
  const EngineInfo& info() const { return info_; }

  struct Job {
    RayQuestion question;
    std::uint32_t end;
    // Fills rays from number `first` on; takes the answers to them. A batch may be filled and taken again.
    std::function<void(std::size_t first, std::span<OwnRay> rays)> fill;
    std::function<void(std::size_t first, std::span<const std::uint32_t> answers)> take;
  };
  // Returns false if stopped. Throws Error: invalid_argument if `progress` calls it, out_of_memory, device_failure.
  bool run(std::size_t rays, const Job& job, const Progress& progress);

 private:
  std::unique_ptr<RayFinder> made() const;
  bool run_from(std::size_t& done, std::size_t rays, const Job& job, const Progress& progress);
  bool run_alone(std::size_t rays, const Job& job, const Progress& progress);

  Make make_;
  std::unique_ptr<RayFinder> finder_;  // null after a failure
  bool on_device_ = false;
  EngineInfo info_;
  std::size_t at_once_ = std::numeric_limits<std::size_t>::max();
  std::mutex alone_;
  std::atomic<std::thread::id> caller_{};
};

}  // namespace vantage
