// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "long_call.hpp"

namespace vantage::python {

/// A site, and who is using it: see `Busy`. Results of its plans keep it.
struct GuardedSite {
  Site site;
  std::mutex mutex = {};
};

}  // namespace vantage::python
