// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

namespace vantage {

// A regular file that is open for reading. Others are refused: a device has no end, and a pipe may never begin.
class RegularFile {
 public:
  // Throws Error io; `what` opens its message.
  explicit RegularFile(const std::filesystem::path& file, const std::string& what = "");

  std::uint64_t size() const { return size_; }
  // All of it, size() bytes. Called once. Throws Error io.
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

// All bytes of a table, a configuration or another small file. Throws Error: io where it is no regular file or cannot
// be read; malformed_file where it is larger than 1 GiB.
std::string read_file(const std::filesystem::path& file);

}  // namespace vantage
