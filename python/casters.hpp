// SPDX-License-Identifier: Apache-2.0
// Form of the library's plain values in Python: points are tuples, angles degrees, enumerators their names.
#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vantage/vantage.hpp>

namespace vantage::python {

namespace py = pybind11;

/// Names of an enumerator's values that the library has no function for.
template <class Enum>
struct Names;
template <>
struct Names<Role> {
  static constexpr const char* kWhat = "role";
  static constexpr std::array<std::pair<Role, const char*>, 4> kAll{
      {{Role::surveyed, "surveyed"}, {Role::blocking, "blocking"}, {Role::search, "search"}, {Role::ignore, "ignore"}}};
};
template <>
struct Names<RegistrationSurfaces> {
  static constexpr const char* kWhat = "choice of surfaces";
  static constexpr std::array<std::pair<RegistrationSurfaces, const char*>, 2> kAll{
      {{RegistrationSurfaces::surveyed, "surveyed"}, {RegistrationSurfaces::all, "all"}}};
};
template <>
struct Names<MoScheme> {
  static constexpr const char* kWhat = "scheme";
  static constexpr std::array<std::pair<MoScheme, const char*>, 2> kAll{
      {{MoScheme::generational, "generational"}, {MoScheme::steady_state, "steady-state"}}};
};
template <>
struct Names<Errc> {
  static constexpr const char* kWhat = "code";
  static constexpr std::array<std::pair<Errc, const char*>, 6> kAll{{{Errc::invalid_argument, "invalid_argument"},
                                                                     {Errc::io, "io"},
                                                                     {Errc::malformed_file, "malformed_file"},
                                                                     {Errc::no_suitable_device, "no_suitable_device"},
                                                                     {Errc::out_of_memory, "out_of_memory"},
                                                                     {Errc::device_failure, "device_failure"}}};
};

template <class Enum>
std::string name_of(Enum value) {
  if constexpr (requires { to_string(value); }) {
    return to_string(value);
  } else {
    return std::ranges::find(Names<Enum>::kAll, value, [](const auto& pair) { return pair.first; })->second;
  }
}

inline void from_name(const std::string& text, Engine& value) { value = engine_from_string(text); }
inline void from_name(const std::string& text, Unit& value) { value = unit_from_string(text); }
inline void from_name(const std::string& text, UpAxis& value) { value = up_axis_from_string(text); }
inline void from_name(const std::string& text, SharedMeshes& value) { value = shared_meshes_from_string(text); }
inline void from_name(const std::string& text, Returns& value) { value = returns_from_string(text); }
template <class Enum>
void from_name(const std::string& text, Enum& value) {
  std::string known;
  for (const auto& [each, name] : Names<Enum>::kAll) {
    if (text == name) return void(value = each);
    known += std::string(known.empty() ? "" : ", ") + name;
  }
  throw Error(Errc::invalid_argument, "'" + text + "' is no " + Names<Enum>::kWhat + "; there are " + known);
}

/// An enumerator as its name.
template <class Enum>
struct NameCaster {
  PYBIND11_TYPE_CASTER(Enum, py::detail::const_name("str"));
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
struct type_caster<vantage::MoScheme> : vantage::python::NameCaster<vantage::MoScheme> {};

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

/// (value, standard error).
template <>
struct type_caster<vantage::Estimate> {
  PYBIND11_TYPE_CASTER(vantage::Estimate, const_name("Tuple[float, float]"));
  static handle cast(const vantage::Estimate& e, return_value_policy, handle) {
    return make_tuple(e.value, e.standard_error).release();
  }
};

}  // namespace pybind11::detail
