// SPDX-License-Identifier: Apache-2.0
// What `automatic` stands for.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "vantage/trace.hpp"

namespace vantage {

// A hardware GPU by ray query where one has that, else by our own BVH; else the CPU. Of the engines on one device,
// where that was named, the first usable one. REQUIRES: embree is listed.
std::size_t default_engine(const std::vector<EngineInfo>& engines,
                           std::optional<std::uint32_t> device_index = std::nullopt);

}  // namespace vantage
