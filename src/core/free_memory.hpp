// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace vantage {

// Returns the bytes that this process can still allocate without swapping: the system's available memory, limited by
// the control group. Empty if neither can be read.
std::optional<std::uint64_t> free_memory();

// Returns the memory that a process may take: `max_memory_bytes`, or, if that is 0, half of the free memory.
std::uint64_t memory_limit(std::uint64_t max_memory_bytes);

// "850 MiB", "12.3 GiB"
std::string bytes_text(std::uint64_t bytes);

}  // namespace vantage
