// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "import/format.hpp"

namespace vantage::importers {

// How the importer of a format is started, and what it must be able to read besides the model.
struct Importer {
  std::filesystem::path program;   // its file, links followed
  std::vector<std::string> words;  // the model's path comes behind them
  std::vector<std::filesystem::path> readable;
};

// Looks in the folder that the environment variable VANTAGE_IMPORTERS names and nowhere else; without it beside the
// program or library that this code is in, and where `cmake --install` puts importers. Throws Error io where there is
// none, with what brings it.
Importer find_importer(const Format& format);

}  // namespace vantage::importers
