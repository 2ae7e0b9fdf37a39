// SPDX-License-Identifier: Apache-2.0
#include "cli/options.hpp"

#include <algorithm>

#include "cli/mistyped.hpp"
#include "core/closest_name.hpp"
#include "core/read_json.hpp"
#include "vantage/error.hpp"

namespace vantage::cli {
namespace {

std::string long_name(const std::string& names) { return names.substr(names.find("--")); }

bool takes_many(const CLI::Option& option) { return option.get_items_expected_max() > 1; }

CLI::Option* find_option(CLI::App& command, const std::string& key) { return command.get_option_no_throw("--" + key); }

std::vector<CLI::App*> all_commands(CLI::App& command) {
  return command.get_parent()->get_subcommands([](const CLI::App*) { return true; });
}

bool known_to_any_command(CLI::App& command, const std::string& key) {
  const auto all = all_commands(command);
  return std::any_of(all.begin(), all.end(), [&](CLI::App* other) { return find_option(*other, key) != nullptr; });
}

bool names_another_command(CLI::App& command, const std::string& key) {
  const auto all = all_commands(command);
  return key != command.get_name() &&
         std::any_of(all.begin(), all.end(), [&](CLI::App* other) { return other->get_name() == key; });
}

// True if a higher layer excludes this option: --exact against a configured sample.
bool excluded(const CLI::Option& option) {
  const auto& others = option.get_excludes();
  return std::any_of(others.begin(), others.end(), [](const CLI::Option* other) { return other->count() > 0; });
}

}  // namespace

CLI::Option* add_value(CLI::App& app, const std::string& names, const std::string& unit, const std::string& help,
                       Setter set) {
  return app
      .add_option_function<std::string>(
          names, [set = std::move(set), what = long_name(names)](const std::string& text) { set(text, what); }, help)
      ->type_name(unit);
}

CLI::Option* add_values(CLI::App& app, const std::string& names, const std::string& unit, const std::string& help,
                        Setter set) {
  return app
      .add_option_function<std::vector<std::string>>(
          names,
          [set = std::move(set), what = long_name(names)](const std::vector<std::string>& texts) {
            for (const auto& text : texts) set(text, what);
          },
          help)
      ->type_name(unit)
      ->allow_extra_args(false);
}

CLI::Option* add_switch(CLI::App& app, const std::string& names, const std::string& help, Setter set) {
  return app.add_flag_function(
      names,
      [set = std::move(set), what = long_name(names)](std::int64_t given) { set(given > 0 ? "true" : "false", what); },
      help);
}

std::string by_option(const CLI::App& command, const std::string& message) {
  const std::string option = "--" + message.substr(0, message.find(':'));
  return command.get_option_no_throw(option) ? "--" + message : message;
}

CLI::Option* add_number(CLI::App& app, const std::string& names, const std::string& unit, const std::string& help,
                        std::optional<double>& target, const Interval& interval) {
  return add_value(app, names, unit, help, [&target, interval](const std::string& text, const std::string& what) {
    target = parse_number(text, what, interval);
  });
}

CLI::Option* add_text(CLI::App& app, const std::string& names, const std::string& unit, const std::string& help,
                      std::optional<std::string>& target) {
  return add_value(app, names, unit, help, [&target](const std::string& text, const std::string&) { target = text; });
}

CLI::Option* add_texts(CLI::App& app, const std::string& names, const std::string& unit, const std::string& help,
                       std::vector<std::string>& target) {
  return add_values(app, names, unit, help,
                    [&target](const std::string& text, const std::string&) { target.push_back(text); });
}

CLI::Option* add_ply_doubles(CLI::App& app, PlyCoordinates& target) {
  CLI::Option* option = app.add_flag_function(
      "--ply-doubles",
      [&target](std::int64_t given) { target = given > 0 ? PlyCoordinates::doubles : PlyCoordinates::floats; },
      "Write coordinates of .ply files as doubles; otherwise as floats about an origin that a comment tells");
  set_advanced(app, option);
  return option;
}

void apply_layer(CLI::App& command, const nlohmann::json& values, const std::string& source,
                 const std::function<bool(const std::string&)>& accepts) {
  for (const auto& [written_key, value] : values.items()) {
    if (value.is_object()) {
      if (!names_another_command(command, written_key)) apply_layer(command, value, source, accepts);
      continue;
    }
    std::string key = written_key;
    std::replace(key.begin(), key.end(), '_', '-');
    if (accepts && !accepts(key)) continue;
    CLI::Option* option = find_option(command, key);
    if (key == "config" || key == "help" || (!option && !known_to_any_command(command, key)))
      throw Error(Errc::invalid_argument, source + ": there is no option '" + written_key + "'" +
                                              did_you_mean("--" + key, option_names(command)));
    if (!option || option->count() > 0 || excluded(*option) || value.is_null()) continue;

    const bool one_point = value.is_array() && !value.empty() && value[0].is_number();
    if (takes_many(*option) && value.is_array() && !one_point) {
      for (const auto& item : value) option->add_result(setting_text(item, source + ": " + written_key));
    } else {
      option->add_result(setting_text(value, source + ": " + written_key));
    }
    try {
      if (option->count() > 0) option->run_callback();
    } catch (const Error& error) {
      throw Error(error.code(), source + ": " + error.what());
    } catch (const CLI::Error& error) {
      throw Error(Errc::invalid_argument, source + ": " + written_key + ": " + error.what());
    }
  }
}

}  // namespace vantage::cli
