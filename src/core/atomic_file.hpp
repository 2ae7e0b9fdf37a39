// SPDX-License-Identifier: Apache-2.0
// A file that appears whole or not at all: written beside its name, renamed at commit().
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace vantage {

class AtomicFile {
 public:
  // Opens a temporary in the folder of `file`, so that the rename stays on one file system. Throws Error io.
  explicit AtomicFile(std::filesystem::path file);
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile();  // Without commit() nothing is left.

  void write(const void* data, std::size_t bytes);
  void write(std::string_view text) { write(text.data(), text.size()); }
  // Overwrites bytes that were written before; the next write() goes on at the end.
  void patch(std::size_t offset, const void* data, std::size_t bytes);
  // Brings all to the disk: of commit() only the new name is left to do. Throws Error io.
  void settle();
  // Brings all to the disk and gives the file its name. Throws Error io.
  void commit();
  const std::filesystem::path& path() const { return file_; }

  // Removes temporaries of `file` that a killed process left behind; those of a process at work are locked, and stay.
  static void remove_leftovers(const std::filesystem::path& file);
  // The same of all files in a folder.
  static void remove_leftovers_in(const std::filesystem::path& folder);

 private:
  [[noreturn]] void fail(const char* what) const;
  void flush();
  std::filesystem::path file_, temporary_;
  std::string buffer_;
  int descriptor_ = -1;
  bool settled_ = false;
};

// Throws Error io.
void write_atomically(const std::filesystem::path& file, std::string_view content);

}  // namespace vantage
