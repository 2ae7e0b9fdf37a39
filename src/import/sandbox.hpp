// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <linux/filter.h>

#include <filesystem>
#include <vector>

namespace vantage::importers {

// Access of a child process, prepared before the fork, since only system calls are safe after it.
class Sandbox {
 public:
  // Allows running what lies below `programs`, and below the system's folders, and reading these and `readable`, files
  // or folders. `spawns`: the process may start programs by posix_spawn(), which share its sandbox and its group.
  Sandbox(const std::vector<std::filesystem::path>& programs, const std::vector<std::filesystem::path>& readable,
          bool spawns = false);
  Sandbox(const Sandbox&) = delete;
  Sandbox& operator=(const Sandbox&) = delete;
  ~Sandbox();

  // Applies to the calling process from here on, as far as the kernel supports it. It gets no new privileges. Of system
  // calls it has those that reading files, memory of its own, threads and its open descriptors take: it makes no
  // process unless it `spawns`, no socket and no shared memory, sends signals to itself alone, and changes nothing of
  // any file.
  void enter() noexcept;

 private:
  int rules_ = -1;  // -1: no Landlock
  std::vector<sock_filter> filter_;
};

}  // namespace vantage::importers
