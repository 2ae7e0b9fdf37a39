// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "vantage/scene.hpp"

namespace vantage {

// Returns true if a pattern matches the name: shell globs with "|" between them, or "!" before them for all others.
bool names_mesh(std::string_view pattern, std::string_view name);
// Returns 1 for each surveyed mesh that matches, 0 for others. Throws Error invalid_argument if none matches.
std::vector<std::uint8_t> meshes_named(const Scene& scene, std::string_view pattern);

}  // namespace vantage
