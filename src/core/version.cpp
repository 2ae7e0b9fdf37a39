// SPDX-License-Identifier: Apache-2.0
#include "vantage/version.hpp"

namespace vantage {

const char* version() noexcept { return VANTAGE_VERSION; }

}  // namespace vantage
