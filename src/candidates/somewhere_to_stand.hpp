// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "vantage/site.hpp"

namespace vantage {

// Throws Error malformed_file if no place of the search area, out of some thousands spread over its true area, is free
// of clashes: a search there would redraw forever. `heights_m`: heights of the head above the ground; one of them is
// enough.
void require_somewhere_to_stand(Site& site, std::span<const double> heights_m);

}  // namespace vantage
