// SPDX-License-Identifier: Apache-2.0
// Doors that a modeller left closed are open: their leaves stop neither rays nor people.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scene/raw_scene.hpp"

namespace vantage {

// Takes out the leaves of doors among the meshes that `candidate` marks, one of them for each mesh, and returns their
// names. A leaf is a mesh, or a connected part of a larger one with what lies in it, such as handles. It has the size
// of a door, with free space on both sides, so a cabinet's is none; and a name calls it a door in one of several
// languages, or its panel stands in an opening of a thicker wall. `raw`: survey frame, metres.
std::vector<std::string> open_doors(RawScene& raw, const std::vector<std::uint8_t>& candidate);

// Whole meshes that open_doors() would take out, up to a few dozen, in this unit and with this axis up. `raw`: read by
// glTF's rule.
std::vector<std::size_t> leaves_if(const RawScene& raw, Unit unit, UpAxis up);

}  // namespace vantage
