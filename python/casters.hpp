// SPDX-License-Identifier: Apache-2.0
// Form of the library's plain values in Python: points are tuples, angles degrees, enumerators their names.
#pragma once

#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>
#include <vantage/vantage.hpp>

#include "typed.hpp"

namespace vantage::python {

/// Names of an enumerator's values, in its order, for types. Where the library has functions for them, those give and
/// take values; a test compares what they take.
template <class Enum>
struct Names;
template <>
struct Names<Engine> {
  static constexpr std::array kAll{"auto", "ray_query", "compute_bvh", "embree"};
};
template <>
struct Names<Unit> {
  static constexpr std::array kAll{"m", "cm", "mm", "in", "ft"};
};
template <>
struct Names<UpAxis> {
  static constexpr std::array kAll{"x", "y", "z"};
};
template <>
struct Names<SharedMeshes> {
  static constexpr std::array kAll{"auto", "always", "never"};
};
template <>
struct Names<Returns> {
  static constexpr std::array kAll{"first", "strongest", "last", "all"};
};
template <>
struct Names<StationStatus> {
  static constexpr std::array kAll{"ok", "hole", "clash", "inside", "off_ground", "outside"};
};
template <>
struct Names<Role> {
  static constexpr const char* kWhat = "role";
  static constexpr std::array kAll{"surveyed", "blocking", "search", "ignore"};
};
template <>
struct Names<RegistrationSurfaces> {
  static constexpr const char* kWhat = "choice of surfaces";
  static constexpr std::array kAll{"surveyed", "all"};
};
template <>
struct Names<Errc> {
  static constexpr std::array kAll{"invalid_argument", "io", "malformed_file", "no_suitable_device", "out_of_memory",
                                   "device_failure"};
};

template <class Enum>
std::string name_of(Enum value) {
  if constexpr (requires { to_string(value); }) {
    return to_string(value);
  } else {
    return Names<Enum>::kAll.at(static_cast<std::size_t>(value));
  }
}

inline void from_name(const std::string& text, Engine& value) { value = engine_from_string(text); }
inline void from_name(const std::string& text, Unit& value) { value = unit_from_string(text); }
inline void from_name(const std::string& text, UpAxis& value) { value = up_axis_from_string(text); }
inline void from_name(const std::string& text, SharedMeshes& value) { value = shared_meshes_from_string(text); }
inline void from_name(const std::string& text, Returns& value) { value = returns_from_string(text); }
template <class Enum>
void from_name(const std::string& text, Enum& value) {
  const auto found = std::ranges::find(Names<Enum>::kAll, text);
  if (found != Names<Enum>::kAll.end()) return void(value = static_cast<Enum>(found - Names<Enum>::kAll.begin()));
  std::string known;
  for (const std::string name : Names<Enum>::kAll) known += (known.empty() ? "" : ", ") + name;
  throw Error(Errc::invalid_argument, "'" + text + "' is no " + Names<Enum>::kWhat + "; there are " + known);
}

/// "'surveyed', 'all'", from a place on.
template <class Enum, std::size_t at = 0>
constexpr auto quoted_names() {
  using py::detail::const_name;
  constexpr std::string_view name = Names<Enum>::kAll[at];
  char text[name.size() + 1] = {};
  std::ranges::copy(name, text);
  const auto quoted = const_name("'") + const_name(text) + const_name("'");
  if constexpr (at + 1 == Names<Enum>::kAll.size())
    return quoted;
  else
    return quoted + const_name(", ") + quoted_names<Enum, at + 1>();
}

/// An enumerator as its name.
template <class Enum>
struct NameCaster {
  PYBIND11_TYPE_CASTER(Enum, py::detail::const_name("Literal[") + quoted_names<Enum>() + py::detail::const_name("]"));
  bool load(py::handle source, bool) {
    if (!PyUnicode_Check(source.ptr())) return false;
    from_name(source.cast<std::string>(), value);
    return true;
  }
  static py::handle cast(Enum value, py::return_value_policy, py::handle) { return py::str(name_of(value)).release(); }
};

}  // namespace vantage::python

namespace pybind11::detail {

template <>
struct type_caster<vantage::Engine> : vantage::python::NameCaster<vantage::Engine> {};
template <>
struct type_caster<vantage::Role> : vantage::python::NameCaster<vantage::Role> {};
template <>
struct type_caster<vantage::Unit> : vantage::python::NameCaster<vantage::Unit> {};
template <>
struct type_caster<vantage::UpAxis> : vantage::python::NameCaster<vantage::UpAxis> {};
template <>
struct type_caster<vantage::SharedMeshes> : vantage::python::NameCaster<vantage::SharedMeshes> {};
template <>
struct type_caster<vantage::Returns> : vantage::python::NameCaster<vantage::Returns> {};
template <>
struct type_caster<vantage::RegistrationSurfaces> : vantage::python::NameCaster<vantage::RegistrationSurfaces> {};
template <>
struct type_caster<vantage::StationStatus> : vantage::python::NameCaster<vantage::StationStatus> {};
template <>
struct type_caster<vantage::Errc> : vantage::python::NameCaster<vantage::Errc> {};

/// Two numbers; any sequence of two is accepted.
template <>
struct type_caster<std::array<double, 2>> {
  using Two = std::array<double, 2>;
  PYBIND11_TYPE_CASTER(Two, const_name("Tuple[float, float]"));
  bool load(handle source, bool convert) {
    make_caster<std::pair<double, double>> two;
    if (!two.load(source, convert)) return false;
    const auto& [a, b] = cast_op<std::pair<double, double>>(two);
    value = {a, b};
    return true;
  }
  static handle cast(const Two& two, return_value_policy, handle) { return make_tuple(two[0], two[1]).release(); }
};

/// (x, y, z); any sequence of three numbers is accepted.
template <>
struct type_caster<vantage::Vec3> {
  PYBIND11_TYPE_CASTER(vantage::Vec3, const_name("Tuple[float, float, float]"));
  bool load(handle source, bool convert) {
    make_caster<std::array<double, 3>> three;
    if (!three.load(source, convert)) return false;
    const auto& [x, y, z] = cast_op<std::array<double, 3>&>(three);
    value = {x, y, z};
    return true;
  }
  static handle cast(const vantage::Vec3& v, return_value_policy, handle) {
    return make_tuple(v.x, v.y, v.z).release();
  }
};

/// (u, v).
template <>
struct type_caster<vantage::Uv> {
  PYBIND11_TYPE_CASTER(vantage::Uv, const_name("Tuple[float, float]"));
  bool load(handle source, bool convert) {
    make_caster<std::array<double, 2>> two;
    if (!two.load(source, convert)) return false;
    const auto& [u, v] = cast_op<std::array<double, 2>&>(two);
    value = {u, v};
    return true;
  }
  static handle cast(const vantage::Uv& uv, return_value_policy, handle) { return make_tuple(uv.u, uv.v).release(); }
};

/// Degrees: names of angles end in `_deg`.
template <>
struct type_caster<vantage::Angle> {
  PYBIND11_TYPE_CASTER(vantage::Angle, const_name("float"));
  bool load(handle source, bool convert) {
    make_caster<double> degrees;
    if (!degrees.load(source, convert)) return false;
    value = vantage::Angle::degrees(cast_op<double>(degrees));
    return true;
  }
  static handle cast(const vantage::Angle& angle, return_value_policy, handle) {
    // The typed value comes back: 0.2, not 0.19999999999999998.
    return PyFloat_FromDouble(std::round(angle.in_degrees() * 1e12) / 1e12);
  }
};

/// Rings of corners (x, y).
template <>
struct type_caster<vantage::PlanRegion> {
  using Rings = decltype(vantage::PlanRegion::rings);
  PYBIND11_TYPE_CASTER(vantage::PlanRegion, make_caster<Rings>::name);
  bool load(handle source, bool convert) {
    make_caster<Rings> rings;
    if (!rings.load(source, convert)) return false;
    value.rings = cast_op<Rings&&>(std::move(rings));
    return true;
  }
  static handle cast(const vantage::PlanRegion& region, return_value_policy policy, handle parent) {
    return make_caster<Rings>::cast(region.rings, policy, parent);
  }
};

/// (value, standard error).
template <>
struct type_caster<vantage::Estimate> {
  PYBIND11_TYPE_CASTER(vantage::Estimate, const_name("Tuple[float, float]"));
  static handle cast(const vantage::Estimate& e, return_value_policy, handle) {
    return make_tuple(e.value, e.standard_error).release();
  }
};

}  // namespace pybind11::detail
