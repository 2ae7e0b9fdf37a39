// SPDX-License-Identifier: Apache-2.0
// Converts models of other formats to GLB in separate programs, since parsers of foreign formats crash.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "import/child_process.hpp"
#include "import/format.hpp"

namespace vantage::importers {

// Returns the model as a self-contained GLB. Each content is converted once and kept in the user's cache folder
// (XDG_CACHE_HOME, else ~/.cache, in vantage/imports), which may be emptied at any time. Safe with several processes.
// A folder, and files `beside`, are converted as one model, of all the files (files_of()). `limits.memory`: 0 for half
// of the free memory. `settings`: words NAME=VALUE for the importer (Format::settings); each choice of them is
// converted and kept apart. REQUIRES: a format with an importer. Throws Error: io (no importer, the file cannot be
// read), malformed_file (the importer refused it, crashed on it or took too long), out_of_memory. Empty if stopped.
std::vector<std::uint8_t> as_glb(const std::filesystem::path& file, const Format& format, Limits limits = {},
                                 const std::vector<std::string>& settings = {}, const Progress& progress = {},
                                 const std::vector<std::string>& beside = {});

}  // namespace vantage::importers
