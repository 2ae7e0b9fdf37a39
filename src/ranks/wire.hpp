// SPDX-License-Identifier: Apache-2.0
// Messages between processes of one program, on machines of one byte order.
#pragma once

#include <string>
#include <string_view>

#include "core/archive.hpp"

namespace vantage::ranks {

using Message = std::string;
using Writer = ArchiveWriter;

// Borrows the message. Throws Error device_failure if it is too short.
class Reader : public ArchiveReader {
 public:
  explicit Reader(std::string_view message)
      : ArchiveReader(message, Errc::device_failure, "a message from another rank is cut short") {}
};

}  // namespace vantage::ranks
