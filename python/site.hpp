// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>

#include "casters.hpp"

namespace vantage::python {

/// A site, which serves one call at a time. Results of its plans keep it alive.
struct GuardedSite {
  Site site;
  std::mutex mutex = {};
};

}  // namespace vantage::python
