// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vantage::importer {

// Returns the value at a place in memory, little-endian by default.
template <class T>
T value_at(const char* bytes, bool big_endian = false) {
  char copy[sizeof(T)];
  std::memcpy(copy, bytes, sizeof(T));
  if (big_endian != (std::endian::native == std::endian::big))
    for (std::size_t k = 0; k < sizeof(T) / 2; ++k) std::swap(copy[k], copy[sizeof(T) - 1 - k]);
  T value;
  std::memcpy(&value, copy, sizeof(T));
  return value;
}

// Parses a whole text as a number; empty if it is none.
std::optional<double> number_of(std::string_view text);

// Reads a file forwards, in large blocks. A folder may hold thousands of files, so only the last few that were read are
// open and have a buffer.
class ByteFile {
 public:
  // Throws Refused.
  explicit ByteFile(const std::filesystem::path& file);
  ByteFile(const ByteFile&) = delete;
  ByteFile& operator=(const ByteFile&) = delete;
  ~ByteFile();

  std::uint64_t size() const { return size_; }
  std::uint64_t place() const { return begin_ + at_; }
  void seek(std::uint64_t place);
  // Returns the number of bytes up to the file's end.
  std::uint64_t left() const { return size_ - std::min(size_, place()); }
  // Returns the next bytes, valid until the next call. Throws Refused if the file ends before.
  const char* take(std::size_t bytes);
  // Returns the next line without its end, valid until the next call; empty at the end. Throws Refused if too long.
  std::optional<std::string_view> line();

 private:
  bool fill(std::size_t bytes);
  void open();
  void rest();  // gives up the buffer and the descriptor until the next read

  std::filesystem::path path_;
  std::ifstream stream_;
  std::uint64_t size_ = 0, begin_ = 0;  // place of the buffer
  std::vector<char> buffer_;
  std::size_t at_ = 0, end_ = 0;
};

}  // namespace vantage::importer
