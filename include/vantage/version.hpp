// SPDX-License-Identifier: Apache-2.0
/// The version of the library.
#pragma once

namespace vantage {

/// Version of the library, "major.minor.patch".
const char* version() noexcept;

}  // namespace vantage
