// SPDX-License-Identifier: Apache-2.0
// Opens doors that a modeller left closed: their leaves stop neither rays nor people.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scene/raw_scene.hpp"

namespace vantage {

// Removes the leaves of doors among the meshes that `candidate` marks, one entry for each mesh, and returns their
// names. A leaf is a mesh, or a connected part of a larger one with smaller parts inside it, such as handles. It has
// the size of a door and free space on both sides, unlike a cabinet's. Its name calls it a door in one of several
// languages, or its panel stands in an opening of a thicker wall. `raw`: survey frame, metres.
std::vector<std::string> open_doors(RawScene& raw, const std::vector<std::uint8_t>& candidate);

// Returns up to a few dozen whole meshes that open_doors() would remove, in this unit and with this axis up. `raw`:
// read by glTF's rule.
std::vector<std::size_t> leaves_if(const RawScene& raw, Unit unit, UpAxis up);

}  // namespace vantage
