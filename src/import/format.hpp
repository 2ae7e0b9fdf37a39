// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace vantage::importers {

// A model format, and the program that converts it to GLB.
struct Format {
  const char* name;
  const char* extensions;     // each with its dot, separated by spaces
  const char* importer;       // null: the loader reads it
  const char* settings = "";  // names of the settings that the importer takes, separated by spaces
  bool several = false;       // true: files of a folder form one site
};

struct Recognised {
  const Format* format;
  std::string note = {};  // set if the file's extension contradicts its content
};

// Returns the files of a site. A file is its own site; a folder's site is all files with the extension of a format that
// allows several, sorted by name. Those `beside` follow. Throws Error: io (a folder cannot be read), malformed_file (it
// holds no such file).
std::vector<std::filesystem::path> files_of(const std::filesystem::path& file,
                                            const std::vector<std::string>& beside = {});

// Recognises the format of a model by its content, else by its extension. Missing or unreadable files are left to the
// loader's own errors. Throws Error malformed_file, which names the kind of file, for files without surfaces (a zip
// archive, a page, a picture, …). Throws it also for several files of different formats, or of a format that takes one
// file; for the latter, invalid_argument if some are `beside`.
Recognised recognise(const std::filesystem::path& file, const std::vector<std::string>& beside = {});

}  // namespace vantage::importers
