// SPDX-License-Identifier: Apache-2.0
// Models of other formats, turned into GLB by programs of their own: parsers of foreign formats crash.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "import/child_process.hpp"
#include "import/format.hpp"

namespace vantage::importers {

// The model as a self-contained GLB. Made once for a content and kept in the user's cache folder (XDG_CACHE_HOME,
// else ~/.cache, in vantage/imports), which may be emptied at any time; safe with several processes.
// `limits.memory`: 0 for half of what is free.
// REQUIRES: a format with an importer. Throws Error: io (no importer, the file cannot be read), malformed_file (the
// importer refused it, crashed on it or took too long), out_of_memory.
std::vector<std::uint8_t> as_glb(const std::filesystem::path& file, const Format& format, Limits limits = {});

}  // namespace vantage::importers
