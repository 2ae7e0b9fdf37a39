// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace vantage::cli {

// One run at a time writes into a folder. The lock is on the folder itself: it ends with the process, and leaves
// nothing behind. On file systems without locks it does nothing.
class FolderLock {
 public:
  // Throws Error io where another process has it.
  explicit FolderLock(const std::filesystem::path& folder);
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;
  ~FolderLock();

 private:
  int descriptor_;
};

}  // namespace vantage::cli
