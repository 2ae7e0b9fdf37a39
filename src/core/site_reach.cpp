// SPDX-License-Identifier: Apache-2.0
#include "core/site_reach.hpp"

#include <string>

#include "core/text.hpp"
#include "vantage/error.hpp"

namespace vantage {

void refuse_position(const Vec3& position, std::string_view what) {
  throw Error(Errc::invalid_argument, std::string(what) + " at (" + number(position.x) + ", " + number(position.y) +
                                          ", " + number(position.z) +
                                          "); a position must be finite and within 1000 km of the scene");
}

}  // namespace vantage
