// SPDX-License-Identifier: Apache-2.0
// Number of workgroups of a dispatch.
#pragma once

#include <cstdint>

#include "shared/trace_types.h"

namespace vantage::vulkan {

inline constexpr std::uint32_t kMostGroups = 0xFFFF;  // per dimension, on every device

inline std::uint32_t groups_of(std::uint64_t threads, std::uint32_t size = group_size) {
  return static_cast<std::uint32_t>((threads + size - 1) / size);
}

}  // namespace vantage::vulkan
