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
  bool several = false;       // whether a folder of its files is one site
};

struct Recognised {
  const Format* format;
  std::string note = {};  // if the file's name says something else
};

// The files of a site: a file is its own; those of a folder are the ones that are named as a format of which several
// are one site, by their names; those `beside` follow. Throws Error: io (a folder cannot be read), malformed_file (it
// holds no such file).
std::vector<std::filesystem::path> files_of(const std::filesystem::path& file,
                                            const std::vector<std::string>& beside = {});

// Recognises the format of a model by its content, else by its extension. Missing or unreadable files are left to the
// loader's own errors. Throws Error malformed_file, which names the kind of file, for files without surfaces (a zip
// archive, a page, a picture, …), and for several files that are of several formats, or of one whose files are sites of
// their own.
Recognised recognise(const std::filesystem::path& file, const std::vector<std::string>& beside = {});

}  // namespace vantage::importers
