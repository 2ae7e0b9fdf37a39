// SPDX-License-Identifier: Apache-2.0
// Keyword arguments from the library's setting tables: names, values and docstrings come from the rows.
#pragma once

#include <algorithm>
#include <string>

#include "options.hpp"

namespace vantage::python {

/// "user_size" of "user-size"; "for_" of "for", which is a word of Python's.
inline std::string keyword(const std::string& name) {
  std::string word = name;
  std::ranges::replace(word, '-', '_');
  return word == "for" ? word + "_" : word;
}

/// A value as the text that a setting's row reads: numbers, texts, truth values, and sequences of them with commas.
inline std::string setting_text(const py::handle& value, const std::string& what) {
  if (py::isinstance<py::bool_>(value)) return value.cast<bool>() ? "true" : "false";
  if (py::isinstance<py::str>(value)) return value.cast<std::string>();
  if (py::hasattr(value, "__fspath__")) return py::str(value.attr("__fspath__")());
  if (py::isinstance<py::sequence>(value) || py::hasattr(value, "__array__")) {
    std::string joined;
    for (const py::handle item : value) joined += (joined.empty() ? "" : ",") + setting_text(item, what);
    return joined;
  }
  if (py::hasattr(value, "__float__") || py::hasattr(value, "__index__")) return py::str(value.attr("__str__")());
  throw py::type_error(what + ": " + std::string(py::repr(value)) + " is no number, text, truth value or sequence");
}

/// Sets the settings of `given` that are in the table; returns their number. None leaves a setting open.
template <class Options>
std::size_t read_settings(const SettingTable<Options>& table, Options& options, const py::kwargs& given) {
  std::size_t taken = 0;
  for (const SettingRow<Options>& row : table) {
    const std::string word = keyword(row.name);
    if (!given.contains(word)) continue;
    ++taken;
    const py::object value = given[word.c_str()];
    if (value.is_none()) continue;
    const bool one_point = py::isinstance<py::sequence>(value) && !py::isinstance<py::str>(value) &&
                           py::len(value) > 0 && py::hasattr(value[py::int_(0)], "__float__");
    if (row.repeated && !one_point && !py::isinstance<py::str>(value))
      for (const py::handle item : value) row.set(options, setting_text(item, word), word);
    else
      row.set(options, setting_text(value, word), word);
  }
  return taken;
}

/// Throws TypeError with the first name that is in no table.
template <class... Options>
void refuse_unknown(const py::kwargs& given, const std::string& call, const SettingTable<Options>&... tables) {
  for (const auto& item : given) {
    const auto name = item.first.cast<std::string>();
    const auto in = [&](const auto& table) {
      return std::ranges::any_of(table, [&](const auto& row) { return keyword(row.name) == name; });
    };
    if (!(in(tables) || ...)) throw py::type_error(call + ": there is no setting '" + name + "'");
  }
}

/// A line for each row with the form of its value, for the end of a docstring, and the rows' names for the stub.
template <class... Options>
std::string settings_doc(const std::string& call, const SettingTable<Options>&... tables) {
  std::string text = "\n\nSettings, each with the form of its value (text, number or sequence); None leaves it open:\n";
  py::dict options;
  const py::tuple setting = py::make_tuple("Union[None, bool, float, os.PathLike, Sequence[Any]]", py::none());
  const auto add = [&](const auto& table) {
    for (const auto& row : table) {
      if (row.name == "problem") continue;  // a separate parameter
      text += "    " + keyword(row.name) + (row.unit.empty() ? "" : " (" + row.unit + ")") + ": " + row.help + ".\n";
      options[py::str(keyword(row.name))] = setting;
    }
  };
  (add(tables), ...);
  all_options().emplace_back(call, options);
  return text;
}

}  // namespace vantage::python
