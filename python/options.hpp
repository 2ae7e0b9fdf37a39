// SPDX-License-Identifier: Apache-2.0
// Members of an option struct as keyword arguments: named once, for calls, attributes and docstrings alike.
#pragma once

#include <concepts>
#include <functional>
#include <string>
#include <vector>

#include "casters.hpp"

namespace vantage::python {

/// Options of every call or class by its name: (type, default) by the name of each, for the stub.
inline std::vector<std::pair<std::string, py::dict>>& all_options() {
  static auto* options = new std::vector<std::pair<std::string, py::dict>>;
  return *options;
}

template <class Struct>
class Options {
 public:
  /// `name`: the call or class, with which messages begin.
  explicit Options(std::string name) : name_(std::move(name)) {}

  template <class Value>
  Options& add(const char* name, Value Struct::*member, const char* doc) {
    return add<Value>(
        name, [member](const Struct& s) { return s.*member; },
        [member](Struct& s, Value value) { s.*member = std::move(value); }, doc);
  }
  /// `set` takes a Value; what `get` returns may be of another type.
  template <class Value, class Get, class Set>
  Options& add(const char* name, Get get, Set set, const char* doc) {
    const auto take = [set, where = name_ + ": " + name](Struct& s, const Given<Value>& given) {
      set(s, value_of<Value>(given.object, where));
    };
    members_.push_back({.name = name,
                        .doc = doc,
                        .type = &type_text<Value>,
                        .get = [get](const Struct& s) -> py::object { return py::cast(get(s)); },
                        .set = [take](Struct& s, const py::object& given) { take(s, {given}); },
                        .getter = [get] { return py::cpp_function([get](const Struct& s) { return get(s); }); },
                        .setter = [take] { return py::cpp_function(take); }});
    return *this;
  }

  /// Struct from keyword arguments, set in the order of the table. Throws TypeError for unknown names.
  Struct read(const py::kwargs& given) const {
    Struct made{};
    std::size_t taken = 0;
    for (const Member& member : members_) {
      if (!given.contains(member.name)) continue;
      member.set(made, given[member.name.c_str()]);
      ++taken;
    }
    if (taken < given.size()) {
      for (const auto& item : given) {
        const auto name = item.first.cast<std::string>();
        if (std::ranges::find(members_, name, &Member::name) == members_.end())
          throw py::type_error(name_ + ": no option '" + name + "'; there are " + names());
      }
    }
    return made;
  }

  /// "Options:" and a line for each, for the end of a docstring.
  std::string doc() const {
    const Struct usual{};
    std::string text = "\n\nOptions:\n";
    py::dict options;
    for (const Member& member : members_) {
      const py::object value = member.get(usual);
      options[py::str(member.name)] = py::make_tuple(member.type(), value);
      text += "    " + member.name + ": " + member.doc + " Default: " + std::string(py::repr(value)) + ".\n";
    }
    all_options().emplace_back(name_, options);
    return text;
  }

  /// The members as attributes.
  template <class... Extra>
  void attributes(py::class_<Struct, Extra...>& type) const {
    for (const Member& member : members_)
      type.def_property(member.name.c_str(), member.getter(), member.setter(), member.doc.c_str());
  }

  /// The members' values by their names.
  py::dict values(const Struct& s) const {
    py::dict values;
    for (const Member& member : members_) values[py::str(member.name)] = member.get(s);
    return values;
  }

  /// Makes values picklable, by the names of their members.
  template <class... Extra>
  void pickles(py::class_<Struct, Extra...>& type) const {
    type.def(py::pickle([options = *this](const Struct& s) { return options.values(s); },
                        [options = *this](const py::dict& values) {
                          return options.read(py::reinterpret_borrow<py::kwargs>(values));
                        }));
  }

  std::string repr(const Struct& s) const {
    std::string text;
    for (const Member& member : members_)
      text += (text.empty() ? "" : ", ") + member.name + "=" + std::string(py::repr(member.get(s)));
    return name_ + "(" + text + ")";
  }

 private:
  struct Member {
    std::string name, doc;
    std::string (*type)();
    std::function<py::object(const Struct&)> get;
    std::function<void(Struct&, const py::object&)> set;
    std::function<py::cpp_function()> getter, setter;
  };

  template <class Value>
  static Value value_of(const py::object& given, const std::string& where) {
    py::detail::make_caster<Value> caster;
    if (!caster.load(given, true))
      throw py::type_error(where + ": " + std::string(py::repr(given)) + " is no " + type_text<Value>() +
                           (std::unsigned_integral<Value> ? " of 0 or more" : ""));
    return py::detail::cast_op<Value>(std::move(caster));
  }
  std::string names() const {
    std::string all;
    for (const Member& member : members_) all += (all.empty() ? "" : ", ") + member.name;
    return all;
  }

  std::string name_;
  std::vector<Member> members_;
};

}  // namespace vantage::python
