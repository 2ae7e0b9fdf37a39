// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace vantage::importer {

// Layout of compressed points, from the file's header and the record of LASzip (Isenburg: LASzip: lossless compression
// of LiDAR data, 2013).
struct LazLayout {
  std::uint64_t first = 0, count = 0;  // byte of the points, and their number
  std::size_t format = 0, record = 0;
  std::uint32_t chunk = 0;  // points of a chunk; UINT32_MAX: the chunk table tells each chunk's
};

// Reads records of LAZ, which laz-perf uncompresses in a process of node (src/import/laz). That process holds a few
// chunks at a time.
class LazRecords {
 public:
  // Throws Refused if node, the script or laz-perf is missing.
  LazRecords(const std::filesystem::path& file, const LazLayout& layout);
  LazRecords(const LazRecords&) = delete;
  LazRecords& operator=(const LazRecords&) = delete;
  ~LazRecords();

  // Returns the bytes of a record of next(). Records of late formats (6 to 10) end with the fields of format 6.
  std::size_t record_bytes() const { return record_; }
  // Returns the next record, valid until the next call. Throws Refused with the reason if there is none.
  const char* next();

 private:
  [[noreturn]] void fail();

  std::size_t record_;
  pid_t process_ = -1;
  int records_ = -1, errors_ = -1;  // ends of pipes
  std::vector<char> buffer_;
  std::size_t at_ = 0, end_ = 0;
};

}  // namespace vantage::importer
