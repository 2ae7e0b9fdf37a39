// SPDX-License-Identifier: Apache-2.0
// A file that appears whole or not at all: written to a temporary beside it, renamed by commit().
#pragma once

#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>

namespace vantage {

class AtomicFile {
 public:
  // Opens a temporary in the folder of `file`, so that the rename stays on one file system. `mode`: its permissions,
  // less the process's mask. Throws Error io, for a device, a pipe or a socket too.
  explicit AtomicFile(std::filesystem::path file, unsigned mode = 0666);
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile();  // Without commit() nothing remains.

  void write(const void* data, std::size_t bytes);
  void write(std::string_view text) { write(text.data(), text.size()); }
  // Overwrites bytes written before; the next write() continues at the end.
  void patch(std::size_t offset, const void* data, std::size_t bytes);
  // Flushes everything to the disk; commit() then only renames. Throws Error io.
  void settle();
  // Flushes everything to the disk and renames the file. Throws Error io.
  void commit();
  const std::filesystem::path& path() const { return file_; }

  // Removes temporaries of `file` left by a killed process. Running processes lock theirs, which stay.
  static void remove_leftovers(const std::filesystem::path& file);
  // Does the same for all files of a folder.
  static void remove_leftovers_in(const std::filesystem::path& folder);

 private:
  [[noreturn]] void fail(const char* what) const;
  void flush();
  std::filesystem::path file_, temporary_;
  std::string buffer_;
  int descriptor_ = -1;
  bool settled_ = false;
};

// Removes files of a folder that an earlier run left and this one may not write again. Files that cannot be removed
// stay.
void remove_earlier(const std::filesystem::path& folder, std::initializer_list<const char*> names);

// Throws Error io.
void write_atomically(const std::filesystem::path& file, std::string_view content);

}  // namespace vantage
