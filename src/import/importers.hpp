// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "import/format.hpp"

namespace vantage::importers {

// Command that starts the importer of a format, and the files that it must read besides the model.
struct Importer {
  std::filesystem::path program;   // its file, links followed
  std::vector<std::string> words;  // the model's path follows them
  std::vector<std::filesystem::path> readable;
  bool spawns = false;  // it starts a program of its own (Limits::spawns)
};

// Finds the importer of a format. If the environment variable VANTAGE_IMPORTERS is set, looks only in its folder; else
// looks beside the program or library with this code, and where `cmake --install` puts importers. Throws Error io, with
// how to install the importer, if there is none.
Importer find_importer(const Format& format);

}  // namespace vantage::importers
