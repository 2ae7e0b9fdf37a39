// SPDX-License-Identifier: Apache-2.0
// Cost of the `embree` engine beyond Embree itself: its counting against a loop that traces the same rays and does
// nothing with them.
#pragma once

#include <span>

#include "bench_site.hpp"
#include "core/embree.hpp"
#include "scene/scene_data.hpp"

namespace vantage::bench {

struct BareEmbreeOptions {
  SiteOptions site;
  void add(CLI::App& command);
};

// Embree's structure over these triangles, robust as the engine's. Throws Error as `embree::check`.
embree::Scene tree_of(RTCDevice device, std::span<const Float3> positions, std::span<const Triangle> triangles);

// Prints million rays a second of each, and the engine's share of the faster bare loop.
void run_bare_embree(const BareEmbreeOptions& options);

}  // namespace vantage::bench
