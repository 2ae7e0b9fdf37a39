// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

namespace vantage {

// A regular file open for reading. Others are rejected: a device has no end, and a pipe may never begin.
class RegularFile {
 public:
  // Throws Error io; messages begin with `what`.
  explicit RegularFile(const std::filesystem::path& file, const std::string& what = "");

  std::uint64_t size() const { return size_; }
  // Reads the next bytes, at most `most`, and returns their number; 0 at the end. Throws Error io.
  std::size_t read_next(void* bytes, std::size_t most);
  // Reads all size() bytes. Called once. Throws Error io.
  void read(void* bytes);

 private:
  [[noreturn]] void fail(const char* action) const;

  struct Descriptor {
    int number = -1;
    Descriptor() = default;
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    ~Descriptor();
  };

  std::string name_, prefix_;
  Descriptor descriptor_;
  std::uint64_t size_ = 0;
};

// Returns all bytes of a table, a configuration or another small file. Throws Error: io if it is no regular file or
// cannot be read; malformed_file if it is larger than 1 GiB.
std::string read_file(const std::filesystem::path& file);

}  // namespace vantage
