// SPDX-License-Identifier: Apache-2.0
// The program's interface to a job whose ranks plan together: rank 0 searches and writes, and all ranks count.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "vantage/error.hpp"
#include "vantage/simulator.hpp"

namespace vantage::ranks {

class Ranks {
 public:
  virtual ~Ranks() = default;  // on rank 0: ends the others; on another: waits for that, and does not return
  virtual bool first() const = 0;
  virtual int size() const = 0;
  // For `SimulatorConfig::shared`: simulators with it span all ranks. On rank 0, making one waits for the others; it
  // throws Error invalid_argument if one has another scene or other settings. `tell` gets the list of ranks,
  // `warn` anything that may make results differ.
  virtual std::shared_ptr<TracerMaker> share(std::function<void(const std::string&)> tell,
                                             std::function<void(const std::string&)> warn) = 0;
  // On other ranks, with a simulator made that way: counts until rank 0 ends this process. Does not return.
  virtual void serve(const Simulator& simulator) = 0;
  // Replaces serve() if there is no simulator: rank 0 reports why, and ends the job. Does not return.
  virtual void fail(Errc code, const std::string& why) = 0;
};

// Null if this process is not part of a job.
std::unique_ptr<Ranks> join();

}  // namespace vantage::ranks
