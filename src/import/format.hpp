// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace vantage::importers {

// A model format, and the program that converts it to GLB.
struct Format {
  const char* name;
  const char* extensions;     // each with its dot, separated by spaces
  const char* importer;       // null: the loader reads it
  const char* settings = "";  // names of the settings that the importer takes, separated by spaces
};

struct Recognised {
  const Format* format;
  std::string note = {};  // if the file's name says something else
};

// Recognises the format of a model by its content, else by its extension. Missing or unreadable files are left to the
// loader's own errors. Throws Error malformed_file, which names the kind of file, for files without surfaces (a zip
// archive, a page, a picture, …).
Recognised recognise(const std::filesystem::path& file);

}  // namespace vantage::importers
