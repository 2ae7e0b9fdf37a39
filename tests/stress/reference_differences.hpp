// SPDX-License-Identifier: Apache-2.0
// An engine's hits, σ, coverage and overlap on a whole site, held against double precision by brute force.
#pragma once

#include "conformance/sites.hpp"
#include "stress/comparison.hpp"

namespace vantage::test {

struct ReferenceDifferences {
  Comparison rays;                                   // of all stations; sigma_m filled
  double coverage = 0, overlap = 0, clustering = 0;  // largest absolute differences, noise on
};
ReferenceDifferences compare_with_reference(const EngineInfo& engine, const TestSite& site);

}  // namespace vantage::test
