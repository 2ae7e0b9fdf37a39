// SPDX-License-Identifier: Apache-2.0
// The meaning of the names of meshes and materials, in a dozen languages.
#pragma once

#include <string>

namespace vantage {

// Returns true for the name of a door or a gate, but not of a part of furniture.
bool names_a_door(const std::string& name);
// Returns true also for the name of a leaf, which may be a plant's.
bool names_a_leaf(const std::string& name);
// Returns true for the name of a ceiling that hangs below a roof or a slab: nobody walks on it.
bool names_a_ceiling(const std::string& name);
bool names_water(const std::string& name);
// Returns true for the name of a material that is nothing but water.
bool is_water(const std::string& material);

}  // namespace vantage
