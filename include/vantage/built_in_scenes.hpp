// SPDX-License-Identifier: Apache-2.0
/// Scenes to try vantage on. They belong to a library of their own, `vantage::built_in_scenes`.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

namespace vantage {

/// Names of the scenes that `write_built_in_scene` can make.
std::span<const std::string> built_in_scene_names() noexcept;

/// Writes a built-in scene as GLB: the method's `three-walls`, `four-walls` and `industrial`, with roles and
/// parameters; or `office`, `house`, `street`, `plant`, `tunnel`, `corridor` and `facade`, unmarked, as modellers
/// deliver them. `triangles` is the wanted number for `industrial` (at least 20 000; met within 2 %); the others ignore
/// it. The same arguments give the same bytes. Throws Error: invalid_argument, io.
void write_built_in_scene(const std::string& name, std::size_t triangles, const std::filesystem::path& file);

}  // namespace vantage
