// SPDX-License-Identifier: Apache-2.0
// Runs an untrusted program with little memory, time and access, and reads its output until it ends.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "vantage/progress.hpp"

namespace vantage::importers {

struct Limits {
  std::uint64_t memory = 0;  // that the program may allocate; 0: any amount
  unsigned cpu_s = 15 * 60, wall_s = 60 * 60;
  std::uint64_t output = std::uint64_t{1} << 32;  // bytes
  // The program starts another one by posix_spawn(), in the same sandbox and with the same limits each. Both get the
  // variables PATH and VANTAGE_IMPORTERS.
  bool spawns = false;
};

// Exit code of a program that cannot be started, or whose libraries cannot be loaded.
inline constexpr int kCannotStart = 127;

struct Ended {
  std::vector<std::uint8_t> output;  // its standard output
  // The first 4 KiB of its standard error, with ? for bytes that are not printable ASCII, without lines of progress.
  std::string errors;
  int exit_code = -1;  // -1 if a signal ended it
  int signal = 0;
  bool timed_out = false, too_large = false, stopped = false;
};

// Runs a program with these words, `words[0]` its path, in a sandbox (sandbox.hpp), and waits. The program has no
// environment unless it `spawns`, and dumps no core. If the kernel has Landlock, the program reads only the system's
// folders, `programs` and `readable`. Lines "progress SHARE" of its standard error are reported. Throws Error io if it
// cannot be started.
Ended run_limited(const std::vector<std::string>& words, const std::vector<std::filesystem::path>& programs,
                  const std::vector<std::filesystem::path>& readable, const Limits& limits,
                  const Progress& progress = {});

}  // namespace vantage::importers
