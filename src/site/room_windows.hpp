// SPDX-License-Identifier: Apache-2.0
// Access windows by the rooms of a model.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "vantage/on_site.hpp"
#include "vantage/scene.hpp"

namespace vantage {

// Throws Error invalid_argument for a window whose pattern no room has.
void check_rooms(std::span<const AccessWindow> windows, std::span<const Room> rooms);

// The windows of a place on the ground, by their indices; none in no room. Copies what it needs.
std::function<std::vector<std::size_t>(const Vec3&)> windows_by_room(std::span<const AccessWindow> windows,
                                                                     std::span<const Room> rooms);

}  // namespace vantage
