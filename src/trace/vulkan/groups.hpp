// SPDX-License-Identifier: Apache-2.0
// How many workgroups a dispatch takes.
#pragma once

#include <cstdint>

#include "shared/trace_types.h"

namespace vantage::vulkan {

inline constexpr std::uint32_t most_groups = 0xFFFF;  // along a dimension, on every device

inline std::uint32_t groups_of(std::uint64_t threads, std::uint32_t size = group_size) {
  return static_cast<std::uint32_t>((threads + size - 1) / size);
}

}  // namespace vantage::vulkan
