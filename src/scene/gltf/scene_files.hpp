// SPDX-License-Identifier: Apache-2.0
// The files that a scene consists of: which of them it may name, and their bytes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "scene/load_budget.hpp"

namespace vantage::gltf {

// The file that `name` leads to from `folder`, all links followed. A scene comes from anywhere, so it may name none but
// those below its own folder, unless `allow_outside`. Throws Error malformed_file where it leads elsewhere; `what`
// opens the message.
std::filesystem::path locate(const std::filesystem::path& folder, const std::string& name, bool allow_outside,
                             const std::string& what);

// All bytes of a regular file, kept in the budget. Throws Error: io, where `what` opens the message; out_of_memory.
std::vector<std::uint8_t> read_file(const std::filesystem::path& path, const std::string& what, LoadBudget& budget);

}  // namespace vantage::gltf
