// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "import/cloud/e57_pages.hpp"
#include "import/cloud/xml_tree.hpp"

namespace vantage::importer {

// One field of the records of a CompressedVector (ASTM E2807, 6.3.4 and 8.3).
struct E57RecordField {
  enum class Type { single_precision, double_precision, integer, text };
  std::string name;
  Type type = Type::double_precision;
  std::int64_t minimum = 0;  // of an integer
  unsigned bits = 64;        // bits of a value in the stream; 0: always `minimum`
  double scale = 1, offset = 0;
};

// Returns the fields of a prototype. Throws Refused.
std::vector<E57RecordField> e57_fields(const XmlElement& prototype);

// Decodes the numbers of one field from a stream that packets bring in pieces.
class E57Column {
 public:
  explicit E57Column(const E57RecordField& field) : field_(field) {}

  void append(const char* bytes, std::size_t count);
  std::uint64_t available() const;  // values that are complete
  double take();                    // REQUIRES: available() > 0
  void compact();                   // drops bytes that were taken

 private:
  E57RecordField field_;
  std::string bytes_;
  std::uint64_t bit_ = 0;  // where the next value begins
};

// Reads the records of a section, and calls `record` for each with one value for each wanted field. `wanted`: indices
// of fields. Throws Refused if there are fewer than `count` records.
void read_e57_records(E57Pages& pages, std::uint64_t section, std::uint64_t count,
                      std::span<const E57RecordField> fields, std::span<const std::size_t> wanted,
                      const std::function<void(std::span<const double>)>& record);

}  // namespace vantage::importer
