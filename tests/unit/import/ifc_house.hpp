// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "vantage/types.hpp"

namespace vantage::test {

enum class IfcVersion { ifc2x3, ifc4 };
enum class IfcUnit { metre, millimetre, foot };

struct IfcHouse {
  IfcVersion version = IfcVersion::ifc4;
  IfcUnit unit = IfcUnit::millimetre;
  Vec3 site_m = {0, 0, 0};  // where the site's placement puts the house
};

// The house as STEP text: two rooms of 4 x 4 x 2.5 m, "Kitchen" at x = 0.2 and "Hall" at x = 4.4, y = 0.2, in walls of
// 0.2 m; a front door into the kitchen and one between the rooms; a window of frame and glass in the hall; two
// cupboards of one shape in the kitchen; a stair of one flight in the hall; slabs below and above. Outside 8.6 x 4.4 m,
// from z = -0.2 to 2.7.
std::string ifc_house(const IfcHouse& house = {});

}  // namespace vantage::test
