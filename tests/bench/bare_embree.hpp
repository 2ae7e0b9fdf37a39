// SPDX-License-Identifier: Apache-2.0
// Cost of the `embree` engine beyond Embree itself: its counting against a loop that traces the same rays and does
// nothing with them.
#pragma once

#include "bench_site.hpp"

namespace vantage::bench {

struct BareEmbreeOptions {
  SiteOptions site;
  void add(CLI::App& command);
};

// Prints million rays a second of each, and the engine's share of the faster bare loop.
void run_bare_embree(const BareEmbreeOptions& options);

}  // namespace vantage::bench
