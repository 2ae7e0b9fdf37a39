// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace vantage::importer {

// A glTF as read: its JSON, and the bytes of its buffers.
struct Source {
  nlohmann::json document;
  std::vector<std::string> buffers;
  std::filesystem::path folder;
};

// Throws Refused.
Source read_source(const std::filesystem::path& file);

// Returns the bytes of a URI, which is either data or a file below the folder. Throws Refused.
std::string read_uri(const Source& source, const std::string& uri);

// Returns a part of some bytes. Throws Refused if it is incomplete.
std::string_view part_of(std::string_view bytes, std::size_t offset, std::size_t length);

}  // namespace vantage::importer
