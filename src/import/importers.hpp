// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "import/format.hpp"

namespace vantage::importers {

// How to start the importer of a format, and the files that it must be able to read besides the model.
struct Importer {
  std::filesystem::path program;   // its file, links followed
  std::vector<std::string> words;  // the model's path follows them
  std::vector<std::filesystem::path> readable;
  bool spawns = false;  // it starts a program of its own (Limits::spawns)
};

// Looks only in the folder named by the environment variable VANTAGE_IMPORTERS, if set. Otherwise it looks beside the
// program or library with this code, and where `cmake --install` puts importers. Throws Error io, with how to install
// it, if there is none.
Importer find_importer(const Format& format);

}  // namespace vantage::importers
