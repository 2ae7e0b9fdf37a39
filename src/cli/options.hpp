// SPDX-License-Identifier: Apache-2.0
// Options as one table: the same code reads each from the command line, a configuration file or a scene.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/help.hpp"
#include "cli/parse.hpp"
#include "vantage/error.hpp"
#include "vantage/export.hpp"
#include "vantage/settings.hpp"

namespace vantage::cli {

// `set(text, what)` reads the value; `what` is the option's long name, with which error messages begin.
using Setter = std::function<void(const std::string& text, const std::string& what)>;

CLI::Option* add_value(CLI::App& app, const std::string& names, const std::string& unit, const std::string& help,
                       Setter set);
// May be repeated; each time takes one value.
CLI::Option* add_values(CLI::App& app, const std::string& names, const std::string& unit, const std::string& help,
                        Setter set);

// Takes no value, or true or false in a configuration file.
CLI::Option* add_switch(CLI::App& app, const std::string& names, const std::string& help, Setter set);

CLI::Option* add_number(CLI::App& app, const std::string& names, const std::string& unit, const std::string& help,
                        std::optional<double>& target, const Interval& interval);
CLI::Option* add_text(CLI::App& app, const std::string& names, const std::string& unit, const std::string& help,
                      std::optional<std::string>& target);
CLI::Option* add_texts(CLI::App& app, const std::string& names, const std::string& unit, const std::string& help,
                       std::vector<std::string>& target);

// Adds the option for the coordinates of .ply files.
CLI::Option* add_ply_doubles(CLI::App& app, PlyCoordinates& target);

// Adds an option for each row of a table, under the heading `group`, if given.
template <class Options>
void add_settings(CLI::App& app, const SettingTable<Options>& table, Options& options, const std::string& group = "") {
  for (const SettingRow<Options>& row : table) {
    const auto set = [&row, &options](const std::string& text, const std::string& what) {
      row.set(options, text, what);
    };
    const std::string name = "--" + row.name;
    CLI::Option* option = row.unit.empty() ? add_switch(app, name, row.help, set)
                          : row.repeated   ? add_values(app, name, row.unit, row.help, set)
                                           : add_value(app, name, row.unit, row.help, set);
    option->group(group.empty() ? row.group : group);
    if (row.advanced) set_advanced(app, option);
  }
  for (const SettingRow<Options>& row : table)
    for (const std::string& other : row.excludes)
      app.get_option("--" + row.name)->excludes(app.get_option("--" + other));
}

// The message of a refused setting, with the option's name in place of the setting's at its beginning.
std::string by_option(const CLI::App& command, const std::string& message);
// Calls `make`; errors are reworded by by_option().
template <class Make>
auto by_option(const CLI::App& command, const Make& make) -> decltype(make()) {
  try {
    return make();
  } catch (const Error& error) {
    throw Error(error.code(), by_option(command, std::string(error.what())),
                {error.details().begin(), error.details().end()});
  }
}

// Sets the options of `command` that are in `values` and not yet set by a higher layer. Keys are long option names,
// with - or _ between words. An object groups options, for one command alone if its key is that command's name.
// `accepts` filters keys; an accepted key that no command knows is an error. Messages begin with `source`.
void apply_layer(CLI::App& command, const nlohmann::json& values, const std::string& source,
                 const std::function<bool(const std::string& key)>& accepts = {});

}  // namespace vantage::cli
