// SPDX-License-Identifier: Apache-2.0
#include "core/free_memory.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <limits>

namespace vantage {
namespace {

std::optional<std::uint64_t> number_in(const char* file) {
  std::ifstream in(file);
  std::uint64_t bytes = 0;
  if (in >> bytes) return bytes;
  return std::nullopt;  // missing, or "max"
}

std::optional<std::uint64_t> available() {
  std::ifstream in("/proc/meminfo");
  std::string key, unit;
  for (std::uint64_t kib = 0; in >> key >> kib; std::getline(in, unit))
    if (key == "MemAvailable:") return kib * 1024;
  return std::nullopt;
}

}  // namespace

std::optional<std::uint64_t> free_memory() {
  std::optional<std::uint64_t> free = available();
  const auto limit = number_in("/sys/fs/cgroup/memory.max"), used = number_in("/sys/fs/cgroup/memory.current");
  if (limit && used) {
    const std::uint64_t left = *limit > *used ? *limit - *used : 0;
    free = free ? std::min(*free, left) : left;
  }
  return free;
}

std::uint64_t memory_limit(std::uint64_t max_memory_bytes) {
  if (max_memory_bytes > 0) return max_memory_bytes;
  const auto free = free_memory();
  return free ? *free / 2 : std::numeric_limits<std::uint64_t>::max();
}

std::string bytes_text(std::uint64_t bytes) {
  const double mib = static_cast<double>(bytes) / 1048576;
  std::array<char, 32> text{};
  if (mib < 1000)
    std::snprintf(text.data(), text.size(), "%.0f MiB", mib);
  else
    std::snprintf(text.data(), text.size(), "%.1f GiB", mib / 1024);
  return text.data();
}

}  // namespace vantage
