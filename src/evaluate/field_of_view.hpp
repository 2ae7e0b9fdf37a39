// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vantage/scanner.hpp"
#include "vantage/types.hpp"

namespace vantage {

// True if an upright scanner has rays in the direction of `line`, which is `range` metres long.
bool in_field_of_view(const Scanner& scanner, const Vec3& line, double range);

}  // namespace vantage
