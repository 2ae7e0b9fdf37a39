// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

namespace vantage::importers {

// What a child process may reach, prepared before the fork, as only system calls are safe behind it.
class Sandbox {
 public:
  // Files below the system's folders and these can be read and run; none can be written.
  explicit Sandbox(const std::vector<std::filesystem::path>& readable);
  Sandbox(const Sandbox&) = delete;
  Sandbox& operator=(const Sandbox&) = delete;
  ~Sandbox();

  // Holds for the calling process from here on, and for what it starts. Does what the kernel has to offer.
  void enter() const noexcept;

 private:
  int rules_ = -1;  // -1: no Landlock here
};

}  // namespace vantage::importers
