// SPDX-License-Identifier: Apache-2.0
// Algorithm 1's pre-computation: turns a maker's noise table into the regular 101 × 101 table that engines look up.
#pragma once

#include "trace/tracer.hpp"
#include "vantage/scanner.hpp"

namespace vantage {

// Returns σ of the maker's table at any distance and reflectivity: linear between its values, extrapolated along the
// outermost ones, never below zero. Below its lowest reflectivity σ grows from that row as R^−½, as a detector's noise
// does while the echo fades; below R = 0.01 it stays. A table of one row or column is constant along it. 0 for an empty
// table.
double table_sigma(const NoiseTable& table, double distance_m, double reflectivity);

// Evaluates `table_sigma` at 101 × 101 steps of normalised distance and reflectivity. Surfaces darker than the scanner
// detects at a distance have about the σ of the darkest that it detects. Not enabled if the scanner has no table.
// REQUIRES: scanner.check() passes.
NoiseModel make_noise_model(const Scanner& scanner, std::uint64_t seed);

// Interpolates bilinearly in double, as engines do in float; tests compare engines with it.
double model_sigma(const NoiseModel& model, double range_m, double reflectivity);

}  // namespace vantage
