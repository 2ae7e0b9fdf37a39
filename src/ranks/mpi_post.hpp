// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "ranks/post.hpp"

namespace vantage::ranks {

class MpiPost : public Post {
 public:
  // Ends the process with this exit code, once all that was sent is on its way and every rank has come to its end. From
  // any thread, that of `deliver_to` included; returns at once.
  virtual void leave(int exit_code) = 0;
};

// Whether this process is one of several that a launcher started as one job.
bool started_as_job();
// Joins the job; its destructor leaves it, and waits until every rank does. Once in a process.
std::unique_ptr<MpiPost> join_job();

}  // namespace vantage::ranks
