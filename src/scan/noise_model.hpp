// SPDX-License-Identifier: Apache-2.0
// Algorithm 1's pre-computation: a maker's noise table becomes the regular 101 × 101 table that engines look up.
#pragma once

#include "trace/tracer.hpp"
#include "vantage/scanner.hpp"

namespace vantage {

// σ of the constructor's table at any distance and reflectivity: linear between its values and, along the outermost
// ones, beyond them; never below zero. A table of one row or column is constant along it. 0 for an empty table.
double table_sigma(const NoiseTable& table, double distance_m, double reflectivity);

// `table_sigma` at 101 × 101 steps of normalised distance and reflectivity. Not enabled where the scanner has no table.
// REQUIRES: scanner.check() passes.
NoiseModel make_noise_model(const Scanner& scanner, std::uint64_t seed);

// Bilinear look-up in double, as engines do in float: what tests hold them against.
double model_sigma(const NoiseModel& model, double range_m, double reflectivity);

}  // namespace vantage
