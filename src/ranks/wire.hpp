// SPDX-License-Identifier: Apache-2.0
// Letters between processes of one program on machines of one byte order.
#pragma once

#include <string>
#include <string_view>

#include "core/archive.hpp"

namespace vantage::ranks {

using Letter = std::string;
using Writer = ArchiveWriter;

// Borrows the letter. Throws Error device_failure where it is too short.
class Reader : public ArchiveReader {
 public:
  explicit Reader(std::string_view letter)
      : ArchiveReader(letter, Errc::device_failure, "a letter from another rank is cut short") {}
};

}  // namespace vantage::ranks
