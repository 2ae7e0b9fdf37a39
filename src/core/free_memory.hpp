// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace vantage {

// Bytes that this process can still take without swapping: what the system calls available, and no more than its
// control group leaves. Empty where neither can be read.
std::optional<std::uint64_t> free_memory();

// What a process may take: `max_memory_bytes`, or where that is 0 half of what is free.
std::uint64_t memory_limit(std::uint64_t max_memory_bytes);

// "850 MiB", "12.3 GiB"
std::string bytes_text(std::uint64_t bytes);

}  // namespace vantage
