// SPDX-License-Identifier: Apache-2.0
// Errors of a plan about impossible requests.
#pragma once

#include <string>

#include "vantage/error.hpp"

namespace vantage {

[[noreturn]] inline void refuse(const std::string& what) { throw Error(Errc::invalid_argument, "plan: " + what); }

}  // namespace vantage
