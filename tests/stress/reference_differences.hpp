// SPDX-License-Identifier: Apache-2.0
// Compares an engine's hits, σ, coverage and overlap on a whole site with double-precision brute force.
#pragma once

#include "conformance/sites.hpp"
#include "stress/comparison.hpp"

namespace vantage::test {

struct ReferenceDifferences {
  Comparison rays;                                   // of all stations; sigma_m filled
  double coverage = 0, overlap = 0, clustering = 0;  // largest absolute differences, with noise
};
ReferenceDifferences compare_with_reference(const EngineInfo& engine, const TestSite& site);

}  // namespace vantage::test
