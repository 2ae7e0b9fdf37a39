// SPDX-License-Identifier: Apache-2.0
// The ranks of a job that plan together: rank 0 searches and writes, and all of them count. The program's side of it.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "vantage/error.hpp"
#include "vantage/simulator.hpp"

namespace vantage::ranks {

class Ranks {
 public:
  virtual ~Ranks() = default;  // of rank 0: sends the others home; of another: waits for that, and does not return
  virtual bool first() const = 0;
  virtual int size() const = 0;
  // While what this returns lives, simulators made on this thread are of all ranks. On rank 0, making one waits for the
  // others, and throws Error invalid_argument where one has another scene or other settings; `tell` is told who they
  // are, `warn` what may make results differ.
  virtual std::shared_ptr<void> share(std::function<void(const std::string&)> tell,
                                      std::function<void(const std::string&)> warn) = 0;
  // On the others, with the simulator that was made so: counts until rank 0 ends this process. Does not return.
  virtual void serve(const Simulator& simulator) = 0;
  // In its place, where there is none: rank 0 says why, and ends the job. Does not return.
  virtual void fail(Errc code, const std::string& why) = 0;
};

// Null where this process is not one of several.
std::unique_ptr<Ranks> join();

}  // namespace vantage::ranks
