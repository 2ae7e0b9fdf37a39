// SPDX-License-Identifier: Apache-2.0
// Failure of a device; the same work may succeed on a device that is set up anew. Never an error in the work itself.
#pragma once

#include "vantage/error.hpp"

namespace vantage {

class DeviceFault : public Error {
 public:
  using Error::Error;
};

}  // namespace vantage
