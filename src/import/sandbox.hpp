// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

namespace vantage::importers {

// Access of a child process, prepared before the fork, since only system calls are safe after it.
class Sandbox {
 public:
  // Allows reading and running files below the system's folders and these; allows no writing.
  explicit Sandbox(const std::vector<std::filesystem::path>& readable);
  Sandbox(const Sandbox&) = delete;
  Sandbox& operator=(const Sandbox&) = delete;
  ~Sandbox();

  // Applies to the calling process from here on, and to its children, as far as the kernel supports it.
  void enter() const noexcept;

 private:
  int rules_ = -1;  // -1: no Landlock
};

}  // namespace vantage::importers
