// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "ranks/transport.hpp"

namespace vantage::ranks {

class MpiTransport : public Transport {
 public:
  // Ends the process with this exit code once all messages were sent and every rank has finished. Callable from any
  // thread, including that of `deliver_to`; returns at once.
  virtual void leave(int exit_code) = 0;
};

// True if a launcher started this process as one of a job.
bool started_as_job();
// Joins the job. The destructor leaves it, and waits until every rank does. Once per process.
std::unique_ptr<MpiTransport> join_job();

}  // namespace vantage::ranks
