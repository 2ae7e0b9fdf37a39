// SPDX-License-Identifier: Apache-2.0
// E57 files that vantage's own writer never makes: fields of any width, packets whose streams are out of step.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace vantage::test {

// Values of a field, packed as the format does: from the lowest bit on, without gaps.
std::string packed_bits(const std::vector<std::uint64_t>& values, unsigned bits);

struct E57TestScan {
  std::string head;       // elements before `points`, such as a pose
  std::string prototype;  // elements
  std::uint64_t count = 0;
  // For each packet the bytes of each field's stream.
  std::vector<std::vector<std::string>> packets = {};
};

void write_e57(const std::filesystem::path& file, const std::vector<E57TestScan>& scans, const std::string& root = {});

}  // namespace vantage::test
