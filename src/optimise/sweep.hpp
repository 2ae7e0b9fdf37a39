// SPDX-License-Identifier: Apache-2.0
// Sweeps in two and three dimensions, the basis of hypervolumes of any dimension.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace vantage::optimise {

using Point3 = std::array<double, 3>;

// These expect points strictly inside the reference; dominated points and duplicates are allowed. O(k log k).
double area(std::span<const std::array<double, 2>> points, const std::array<double, 2>& reference);
double volume3(std::span<const Point3> points, const Point3& reference);
std::vector<double> contributions2(std::span<const std::array<double, 2>> points,
                                   const std::array<double, 2>& reference);
// O(k log k) for mutually non-dominated points.
std::vector<double> contributions3(std::span<const Point3> points, const Point3& reference);

}  // namespace vantage::optimise
