// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <linux/filter.h>

#include <filesystem>
#include <vector>

namespace vantage::importers {

// Access rights of a child process, prepared before the fork, since only system calls are safe after it.
class Sandbox {
 public:
  // Allows running and reading what lies below `programs` and the system's folders, and reading `readable`, files or
  // folders. `spawns`: the process may start programs by posix_spawn(), which share its sandbox and its process group.
  Sandbox(const std::vector<std::filesystem::path>& programs, const std::vector<std::filesystem::path>& readable,
          bool spawns = false);
  Sandbox(const Sandbox&) = delete;
  Sandbox& operator=(const Sandbox&) = delete;
  ~Sandbox();

  // Restricts the calling process from here on, as far as the kernel supports it. The process gets no new privileges.
  // It keeps system calls for reading files, for its own memory and threads, and for its open descriptors. It can
  // create no process unless it `spawns`, no socket and no shared memory. It can send signals only to itself, and
  // cannot change any file.
  void enter() noexcept;

 private:
  int rules_ = -1;  // -1: no Landlock
  std::vector<sock_filter> filter_;
};

}  // namespace vantage::importers
