// SPDX-License-Identifier: Apache-2.0
// Finds and reads the files that a scene refers to.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "scene/load_budget.hpp"

namespace vantage::gltf {

// Resolves `name` from `folder`, following all links. A scene may come from anywhere, so it may only refer to files
// below its own folder, unless `allow_outside`. Throws Error malformed_file if the file lies elsewhere; messages begin
// with `what`.
std::filesystem::path locate(const std::filesystem::path& folder, const std::string& name, bool allow_outside,
                             const std::string& what);

// Returns all bytes of a regular file, kept in the budget. Throws Error: io, with messages that begin with `what`;
// out_of_memory.
std::vector<std::uint8_t> read_file(const std::filesystem::path& path, const std::string& what, LoadBudget& budget);

}  // namespace vantage::gltf
