// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace vantage::cli {

// Lets one run at a time write into a folder. The lock is on the folder itself: it ends with the process, and leaves
// nothing behind. Without effect on file systems without locks.
class FolderLock {
 public:
  // Throws Error io if another process holds it.
  explicit FolderLock(const std::filesystem::path& folder);
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;
  ~FolderLock();

 private:
  int descriptor_;
};

}  // namespace vantage::cli
