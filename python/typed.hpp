// SPDX-License-Identifier: Apache-2.0
// Types of values as signatures tell them, and with these the stub: from the C++ types, or else from a text at the
// binding.
#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace vantage::python {

namespace py = pybind11;

/// A text as the argument of a template.
template <std::size_t size>
struct Text {
  char text[size];
  constexpr Text(const char (&from)[size]) { std::ranges::copy(from, text); }
};

/// An object of Python's whose type is this text; types of the module are in it as `vantage.Scene`.
template <Text type, class Base = py::object>
struct Typed : Base {
  using Base::Base;
  Typed(Base object) : Base(std::move(object)) {}
  static bool check_(py::handle given) { return py::isinstance<Base>(given); }
};

/// Called with the share done, in [0, 1]; None: no one is.
using Listener = Typed<"Optional[Callable[[float], Any]]">;
/// Anything that numpy makes an array of.
using ArrayLike = Typed<"numpy.typing.ArrayLike">;
/// Heads or stations, for `stations_of`.
using Stations = Typed<"Union[numpy.typing.ArrayLike, Sequence[vantage.Station], Sequence[vantage.PlacedStation]]">;
/// Plain values by their names.
using Json = Typed<"Dict[str, Any]", py::dict>;

/// A list that is a tuple in Python, since appending to a copy would be lost silently; taken from any iterable.
template <class Value>
struct Tuple {
  std::vector<Value> values;
};

/// An object given for a value, before it is converted.
template <class Value>
struct Given {
  py::object object;
};

/// The type of a value, as a signature has it.
template <class Value>
std::string type_text() {
  constexpr auto name = py::detail::make_caster<Value>::name;
  const auto types = name.types();
  std::string text;
  for (auto [letter, type] = std::pair(name.text, types.begin()); *letter != '\0'; ++letter) {
    if (*letter != '%') {
      text += *letter;
      continue;
    }
    const py::handle bound = py::detail::get_type_handle(**type++, true);
    text += py::str("{}.{}").format(bound.attr("__module__"), bound.attr("__qualname__"));
  }
  return text;
}

}  // namespace vantage::python

namespace pybind11::detail {

template <vantage::python::Text type, class Base>
struct handle_type_name<vantage::python::Typed<type, Base>> {
  static constexpr auto name = const_name(type.text);
};

template <class Value>
struct type_caster<vantage::python::Tuple<Value>> {
  PYBIND11_TYPE_CASTER(vantage::python::Tuple<Value>,
                       const_name("Tuple[") + make_caster<Value>::name + const_name(", ...]"));
  bool load(handle source, bool convert) {
    if (!isinstance<iterable>(source)) return false;
    make_caster<std::vector<Value>> list_caster;
    if (!list_caster.load(list(reinterpret_borrow<object>(source)), convert)) return false;
    value.values = cast_op<std::vector<Value>&&>(std::move(list_caster));
    return true;
  }
  static handle cast(const vantage::python::Tuple<Value>& from, return_value_policy, handle) {
    return tuple(pybind11::cast(from.values)).release();
  }
};

template <class Value>
struct type_caster<vantage::python::Given<Value>> {
  PYBIND11_TYPE_CASTER(vantage::python::Given<Value>, make_caster<Value>::name);
  bool load(handle source, bool) {
    value.object = reinterpret_borrow<object>(source);
    return true;
  }
};

}  // namespace pybind11::detail
