// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "long_call.hpp"

namespace vantage::python {

/// A simulator, and who is using it: see `Busy`.
struct GuardedSimulator {
  Simulator simulator;
  std::mutex mutex = {};
};

}  // namespace vantage::python
