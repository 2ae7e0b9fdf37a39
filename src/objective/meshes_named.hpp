// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "vantage/scene.hpp"

namespace vantage {

// Whether a pattern means a mesh of this name: shell globs with "|" between them, or "!" before them for all others.
bool names_mesh(std::string_view pattern, std::string_view name);
// 1 for each surveyed mesh that a pattern means, 0 for others. Throws Error invalid_argument if there is none.
std::vector<std::uint8_t> meshes_named(const Scene& scene, std::string_view pattern);

}  // namespace vantage
