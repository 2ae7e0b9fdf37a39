// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace vantage {

// Returns all bytes of a file. Throws Error io if it is a folder, or cannot be opened or read.
std::string read_file(const std::filesystem::path& file);

}  // namespace vantage
