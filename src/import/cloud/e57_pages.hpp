// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "import/cloud/byte_file.hpp"

namespace vantage::importer {

// Reads an E57 file (ASTM E2807, 2011) without its pages' checksums. Addresses in the file count the checksums
// ("physical"); lengths do not ("logical").
class E57Pages {
 public:
  explicit E57Pages(const std::filesystem::path& file);

  std::string xml();
  // Throws Refused for a place outside the file or within a checksum.
  std::uint64_t logical(std::uint64_t physical) const;
  std::uint64_t logical_end() const { return pages_ * content_; }
  // Checks every page that it reads. Throws Refused if one is damaged, or the file ends before.
  void read(std::uint64_t logical, char* to, std::size_t bytes);

 private:
  void load(std::uint64_t page);

  ByteFile file_;
  std::uint64_t page_bytes_ = 1024, content_ = 1020, pages_ = 0;
  std::uint64_t xml_offset_ = 0, xml_length_ = 0;
  std::string loaded_;  // content of one page
  std::uint64_t loaded_page_ = UINT64_MAX;
};

}  // namespace vantage::importer
