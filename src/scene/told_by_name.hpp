// SPDX-License-Identifier: Apache-2.0
// What the name of a mesh says it is, in a dozen languages.
#pragma once

#include <string>

namespace vantage {

// Whether a name is that of a door or a gate, and no part of furniture.
bool names_a_door(const std::string& name);
// Whether it is that, or the name of a leaf, which may be a plant's, too.
bool names_a_leaf(const std::string& name);
bool names_water(const std::string& name);

}  // namespace vantage
