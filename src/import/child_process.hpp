// SPDX-License-Identifier: Apache-2.0
// A program that is not trusted: started with little memory, time and access, and listened to until it ends.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace vantage::importers {

struct Limits {
  std::uint64_t memory = 0;  // bytes that it may allocate; 0: any
  unsigned cpu_s = 15 * 60, wall_s = 60 * 60;
  std::uint64_t output = std::uint64_t{1} << 32;  // bytes
};

struct Ended {
  std::vector<std::uint8_t> output;  // its standard output
  std::string errors;                // the first 4 KiB of its standard error, all but printable ASCII as ?
  int exit_code = -1;                // -1 where a signal ended it
  int signal = 0;
  bool timed_out = false, too_large = false;
};

// Runs a program with these words, `words[0]` its path, and waits. It writes no file, opens no socket, dumps no core,
// and, where the kernel has Landlock, reads nothing outside the system's folders and `readable`.
// Throws Error io where it cannot be started.
Ended run_limited(const std::vector<std::string>& words, const std::vector<std::filesystem::path>& readable,
                  const Limits& limits);

}  // namespace vantage::importers
