// SPDX-License-Identifier: Apache-2.0
// Converts between the library's arrays and numpy's, without a copy if one outlives the other.
#pragma once

#include <pybind11/numpy.h>

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "casters.hpp"

namespace vantage::python {

static_assert(sizeof(Vec3) == 3 * sizeof(double) && sizeof(Uv) == 2 * sizeof(double));

using Shape = std::vector<py::ssize_t>;

/// Read-only view of numbers that `owner` holds and never changes; the view keeps it alive.
template <class Number, class Value>
py::array_t<Number> view(std::span<const Value> values, const py::object& owner, std::size_t width = 1) {
  static_assert(sizeof(Value) % sizeof(Number) == 0);
  Shape shape{static_cast<py::ssize_t>(values.size() * sizeof(Value) / sizeof(Number) / width)};
  if (width > 1) shape.push_back(static_cast<py::ssize_t>(width));
  py::array_t<Number> array(shape, reinterpret_cast<const Number*>(values.data()), owner);
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

/// An array that takes over a vector.
template <class Number, class Value>
py::array_t<Number> adopt(std::vector<Value>&& values, const Shape& shape) {
  auto kept = std::make_unique<std::vector<Value>>(std::move(values));
  const auto* data = reinterpret_cast<const Number*>(kept->data());
  const py::capsule owner(kept.get(), [](void* vector) { delete static_cast<std::vector<Value>*>(vector); });
  kept.release();
  return py::array_t<Number>(shape, data, owner);
}
inline py::array_t<double> adopt(std::vector<Vec3>&& points) {
  const auto count = static_cast<py::ssize_t>(points.size());
  return adopt<double>(std::move(points), {count, 3});
}

/// Numbers from a caller; converted if they have another type or layout.
using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// Throws TypeError for anything except an array of numbers; the message begins with `what`.
Doubles doubles_of(const py::object& given, const std::string& what);

inline std::string shape_text(const py::array& array) { return py::str(array.attr("shape")); }

/// Rows of two or three numbers. Throws Error invalid_argument for another shape.
template <class Row>
std::span<const Row> rows_of(const Doubles& array, const char* what) {
  constexpr py::ssize_t kWidth = sizeof(Row) / sizeof(double);
  if (array.ndim() == 2 && array.shape(1) == kWidth)
    return {reinterpret_cast<const Row*>(array.data()), static_cast<std::size_t>(array.shape(0))};
  throw Error(Errc::invalid_argument, std::string(what) + ": an array of shape (n, " + std::to_string(kWidth) +
                                          ") is wanted, and this one's is " + shape_text(array));
}

/// Points of (n, 3), or one of (3,).
inline std::span<const Vec3> points_of(const Doubles& array, const char* what) {
  if (array.ndim() == 1 && array.shape(0) == 3) return {reinterpret_cast<const Vec3*>(array.data()), 1};
  return rows_of<Vec3>(array, what);
}

/// Indices of corners. Throws Error invalid_argument for another shape, no integers, or values outside of 0 to 2³² − 1.
std::vector<std::array<std::uint32_t, 3>> triangles_of(const py::array& array);

/// Heads of stations as an array of (n, 3), or `Station`s or `PlacedStation`s; inactive ones keep their place. The
/// ground of the former two is unknown and set to the head.
std::vector<PlacedStation> stations_of(const py::object& stations);
/// The same in the form that simulators take.
Network network_of(const py::object& stations);

/// The heads of stations, one row each.
py::array_t<double> heads_of(std::span<const PlacedStation> stations);

/// The text of a JSON object as Python's own values.
Json from_json(const std::string& text);
/// Settings by their names.
Json to_dict(const Settings& settings);

}  // namespace vantage::python
