// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace vantage::importers {

// A format of models, and the program that turns it into GLB.
struct Format {
  const char* name;
  const char* extensions;  // each with its point, a space after
  const char* importer;    // null: the loader reads it
};

struct Recognised {
  const Format* format;
  std::string note = {};  // where the file's name says something else
};

// Tells the format of a model by its content, else by its extension. A file that is not there, or cannot be read, is
// left to the loader's own errors.
// Throws Error malformed_file for what holds no surfaces (a zip archive, a page, a point cloud, …), by its name.
Recognised recognise(const std::filesystem::path& file);

}  // namespace vantage::importers
