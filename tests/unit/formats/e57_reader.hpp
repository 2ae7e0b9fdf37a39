// SPDX-License-Identifier: Apache-2.0
// Reads E57 files by the standard's text (ASTM E2807), sharing nothing with what writes them: the checksum a bit at a
// time, packets wherever they lie, integers of any number of bits.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace vantage::test {

struct E57ReadScan {
  std::map<std::string, std::string> texts;           // leaves by their path below the scan: "pose/rotation/w"
  std::map<std::string, std::vector<double>> fields;  // values by name
  std::vector<std::string> order;                     // of the fields
  std::uint64_t records = 0;
  // The index: first record of a packet, and how many records lie before that packet by counting.
  std::vector<std::pair<std::uint64_t, std::uint64_t>> index;
  std::uint64_t packets = 0;

  double number(const std::string& path) const;
};

struct E57ReadFile {
  std::map<std::string, std::string> texts;
  std::vector<E57ReadScan> scans;
  std::string xml;
};

// Throws std::runtime_error where the file is against the standard.
E57ReadFile read_e57(const std::string& bytes);

}  // namespace vantage::test
