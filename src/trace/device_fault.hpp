// SPDX-License-Identifier: Apache-2.0
// What fails because a device does, and may do on one that is set up anew; never what was wrong with the work.
#pragma once

#include "vantage/error.hpp"

namespace vantage {

class DeviceFault : public Error {
 public:
  using Error::Error;
};

}  // namespace vantage
