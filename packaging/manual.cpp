// SPDX-License-Identifier: Apache-2.0
// vantage-manual FOLDER: writes the manual pages, the completions of bash and zsh, and the JSON schema of configuration
// files, from the tables of options that the program itself reads by. FOLDER gets man1/*.1, bash/vantage, zsh/_vantage
// and schemas/config.schema.json.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cli/command.hpp"
#include "core/atomic_file.hpp"
#include "vantage/objective.hpp"
#include "vantage/planner.hpp"
#include "vantage/scanner.hpp"
#include "vantage/version.hpp"

namespace vantage::cli {
namespace {

// Values that an option's text is one of; none: they are no list.
std::vector<std::string> words_of(const std::string& option) {
  const auto all = [](std::span<const std::string> names) {
    return std::vector<std::string>(names.begin(), names.end());
  };
  if (option == "engine") return {"auto", "ray_query", "compute_bvh", "embree"};
  if (option == "objectives") return all(objective_names());
  if (option == "problem") {
    std::vector<std::string> names = all(problem_names());
    names.insert(names.begin(), "survey");
    return names;
  }
  std::vector<std::string> keys;
  if (option == "scanner")
    for (const ScannerPreset& preset : list_scanners()) keys.push_back(preset.key);
  return keys;
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

// What a shell completes a value with. The units that options are listed with say it.
enum class Value { none, text, file, folder };

Value value_of(const CLI::Option& option) {
  if (option.get_items_expected_max() == 0) return Value::none;
  const std::string unit = option.get_type_name();
  if (unit == "DIR") return Value::folder;
  for (const char* file : {"FILE", "SCENE", "TABLE"})
    if (unit.find(file) != std::string::npos) return Value::file;
  return Value::text;
}

struct Row {
  std::vector<std::string> names;  // with their dashes; short ones first
  std::string unit, help;
  Value value = Value::none;
  bool repeated = false;
  std::vector<std::string> words = {};
};

struct Group {
  std::string title;
  std::vector<Row> rows;
};

// An option as one reads it: for a positional argument, its name alone.
Row row_of(const CLI::Option& option) {
  Row row{.names = {}, .unit = option.get_type_name(), .help = option.get_description(), .value = value_of(option)};
  for (const std::string& name : option.get_snames()) row.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) row.names.push_back("--" + name);
  if (row.names.empty()) row.names.push_back(option.get_name());
  if (row.value == Value::none) row.unit.clear();
  row.repeated = option.get_items_expected_max() > 1;
  if (!option.get_lnames().empty()) row.words = words_of(option.get_lnames().front());
  return row;
}

// In the order in which --help has them; what takes no dash apart.
std::vector<Group> groups_of(const CLI::App& app, bool positional) {
  std::vector<Group> groups;
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_positional() != positional || option->get_group().empty()) continue;
    const std::string& title = option->get_group();
    auto group = std::ranges::find(groups, title, &Group::title);
    if (group == groups.end()) group = groups.insert(groups.end(), {title, {}});
    group->rows.push_back(row_of(*option));
  }
  return groups;
}

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

std::string with(std::string text, std::string_view what, std::string_view instead) {
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += instead.size())
    text.replace(at, what.size(), instead);
  return text;
}

// As a line of a manual page (man(7)).
std::string roff(const std::string& text) {
  const std::string escaped = with(with(text, "\\", "\\e"), "-", "\\-");
  return escaped.starts_with('.') || escaped.starts_with('\'') ? "\\&" + escaped : escaped;
}

std::string bold(const std::string& text) { return "\\fB" + roff(text) + "\\fR"; }
std::string italic(const std::string& text) { return "\\fI" + roff(text) + "\\fR"; }

std::string head(const std::string& page, const std::string& what) {
  std::string title = page;
  for (char& c : title)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return ".TH " + title + " 1 \"\" \"vantage " + version() + "\" \"User Commands\"\n" + ".SH NAME\n" + roff(page) +
         " \\- " + roff(what) + "\n";
}

std::string entries(const Group& group) {
  std::string text;
  for (const Row& row : group.rows) {
    text += ".TP\n";
    for (const std::string& name : row.names) text += (name == row.names.front() ? "" : ", ") + bold(name);
    if (!row.unit.empty()) text += " " + italic(row.unit);
    text += "\n" + roff(row.help) + ".\n";
  }
  return text;
}

constexpr const char* kEnds = R"(.SH EXIT STATUS
.TP
0
Results are there.
.TP
1
Something failed; the message says what, and what to do.
.TP
2
The command line, a configuration or a setting is wrong.
.TP
3
There are results, but no network keeps what was required.
.SH ENVIRONMENT
.TP
.B VANTAGE_DATA
A folder whose scanners.json adds to the scanners that are built in.
.TP
.B VANTAGE_IMPORTERS
The folder of the programs that read other formats than glTF.
.TP
.B XDG_CACHE_HOME
Below it lie models that importers have read, in vantage/imports.
)";

std::string page_of(const CLI::App& command) {
  const std::string name = command.get_name(), page = "vantage-" + name;
  std::string text = head(page, command.get_description()) + ".SH SYNOPSIS\n" + bold("vantage " + name) + " [" +
                     italic("OPTIONS") + "]";
  for (const Group& group : groups_of(command, true))
    for (const Row& row : group.rows) text += " [" + italic(row.names.front()) + "]";
  text += "\n";
  const std::vector<Group> arguments = groups_of(command, true);
  if (!arguments.empty()) text += ".SH ARGUMENTS\n";
  for (const Group& group : arguments) text += entries(group);
  text += ".SH OPTIONS\n";
  for (const Group& group : groups_of(command, false))
    text += (group.title == "Options" ? "" : ".SS " + roff(group.title) + "\n") + entries(group);
  return text + kEnds + ".SH SEE ALSO\n" + bold("vantage") + "(1)\n";
}

std::string main_page(const CLI::App& app) {
  std::string text = head("vantage", "plans terrestrial LiDAR surveys") + ".SH SYNOPSIS\n" + bold("vantage") + " " +
                     italic("COMMAND") + " [" + italic("OPTIONS") + "] [" + italic("SCENE") + "]\n.SH DESCRIPTION\n" +
                     roff(app.get_description()) + "\n.SH COMMANDS\n";
  for (const CLI::App* command : commands_of(app))
    text += ".TP\n" + bold(command->get_name()) + "\n" + roff(command->get_description()) + ".\n";
  text += ".SH OPTIONS\n";
  for (const Group& group : groups_of(app, false)) text += entries(group);
  text += std::string(kEnds) + ".SH SEE ALSO\n";
  for (const CLI::App* command : commands_of(app))
    text += (command == commands_of(app).front() ? "" : ", ") + bold("vantage-" + command->get_name()) + "(1)";
  return text + "\n";
}

std::string bash_of(const CLI::App& app) {
  std::string commands, options, files, folders, others, chosen, choices;
  for (const CLI::App* command : commands_of(app)) {
    commands += " " + command->get_name();
    options += "    " + command->get_name() + ") options='";
    for (const Group& group : groups_of(*command, false))
      for (const Row& row : group.rows)
        for (const std::string& name : row.names) {
          options += name + " ";
          std::string& list = row.value == Value::file ? files : row.value == Value::folder ? folders : others;
          // An option means the same in all commands, but for -o: what completes files completes folders, too.
          const std::string each = name + "|";
          if (!row.words.empty()) {
            if (("|" + chosen).find("|" + each) == std::string::npos)
              chosen += each, choices += "    " + name + ") COMPREPLY=($(compgen -W '" + joined(row.words) +
                                         "' -- \"$cur\")); return ;;\n";
            continue;
          }
          const auto listed = [&](const std::string& in) { return ("|" + in).find("|" + each) != std::string::npos; };
          if (row.value != Value::none && !listed(files) && !listed(folders) && !listed(others)) list += each;
        }
    options += "' ;;\n";
  }
  const auto cases = [](const std::string& list, const std::string& words) {
    return list.empty() ? std::string() : "    " + list.substr(0, list.size() - 1) + ") " + words + "return ;;\n";
  };
  return "# bash completion of vantage, made from its tables of options.\n"
         "_vantage() {\n"
         "  local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD-1]} command=${COMP_WORDS[1]} options=\n"
         "  COMPREPLY=()\n"
         "  if [ \"$COMP_CWORD\" -eq 1 ]; then\n"
         "    COMPREPLY=($(compgen -W '" +
         commands.substr(1) +
         " --help --version' -- \"$cur\"))\n"
         "    return\n"
         "  fi\n"
         "  compopt -o filenames 2>/dev/null\n"
         "  case $prev in\n" +
         choices + cases(files, "COMPREPLY=($(compgen -f -- \"$cur\")); ") +
         cases(folders, "COMPREPLY=($(compgen -d -- \"$cur\")); ") + cases(others, "") +
         "  esac\n"
         "  case $command in\n" +
         options +
         "  esac\n"
         "  if [[ $cur == -* ]]; then\n"
         "    compopt +o filenames 2>/dev/null\n"
         "    COMPREPLY=($(compgen -W \"$options\" -- \"$cur\"))\n"
         "  else\n"
         "    COMPREPLY=($(compgen -f -- \"$cur\"))\n"
         "  fi\n"
         "}\n"
         "complete -F _vantage vantage\n";
}

// Within a specification of _arguments (zshcompsys(1)), which stands in single quotes.
std::string zsh(const std::string& text) {
  return with(with(with(with(with(text, "\\", "\\\\"), "[", "\\["), "]", "\\]"), ":", "\\:"), "'", "'\\''");
}

std::string zsh_of(const CLI::App& app) {
  std::string text =
      "#compdef vantage\n# zsh completion of vantage, made from its tables of options.\n"
      "_vantage() {\n"
      "  local line state\n"
      "  _arguments -C '1: :->command' '*:: :->rest' && return\n"
      "  case $state in\n"
      "    command)\n"
      "      local -a commands=(\n";
  for (const CLI::App* command : commands_of(app))
    text += "        '" + command->get_name() + ":" + zsh(command->get_description()) + "'\n";
  text +=
      "      )\n"
      "      _describe -t commands 'vantage command' commands ;;\n"
      "    rest)\n"
      "      case $words[1] in\n";
  for (const CLI::App* command : commands_of(app)) {
    text += "        " + command->get_name() + ")\n          _arguments -S \\\n";
    for (const Group& group : groups_of(*command, false))
      for (const Row& row : group.rows) {
        // One that is there need not be offered again.
        std::string others;
        for (const std::string& name : row.names) others += (others.empty() ? "" : " ") + name;
        const std::string before = row.repeated ? "*" : "(" + others + ")";
        const std::string action = !row.words.empty()           ? "(" + joined(row.words) + ")"
                                   : row.value == Value::file   ? "_files"
                                   : row.value == Value::folder ? "_files -/"
                                                                : " ";
        for (const std::string& name : row.names)
          text += "            '" + before + name + "[" + zsh(row.help) + "]" +
                  (row.value == Value::none ? "" : ":" + zsh(row.unit) + ":" + action) + "' \\\n";
      }
    text += "            '*:scene:_files' ;;\n";
  }
  return text +
         "      esac ;;\n"
         "  esac\n"
         "}\n"
         "_vantage \"$@\"\n";
}

nlohmann::ordered_json schema_of(const CLI::App& app) {
  using json = nlohmann::ordered_json;
  json properties = json::object();
  for (const CLI::App* command : commands_of(app))
    for (const Group& group : groups_of(*command, false))
      for (const Row& row : group.rows) {
        const std::string& name = row.names.back();
        if (!name.starts_with("--") || name == "--help" || name == "--config") continue;
        json& property = properties[name.substr(2)];
        if (!property.is_null()) continue;  // as another command has it
        property["description"] = row.unit.empty() ? row.help : row.unit + ": " + row.help;
        if (row.value == Value::none)
          property["type"] = {"boolean", "null"};
        else
          property["type"] = {"string", "number", "array", "null"};
      }
  return {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
          {"title", "config.json of vantage, and what --config takes"},
          {"description",
           "Options by their long names; null where the built-in value holds. An array is a list of numbers, or the "
           "values of an option that may be repeated. An object groups options, for one command alone where its key is "
           "that command's name."},
          {"type", "object"},
          {"properties", properties},
          {"additionalProperties", {{"type", "object"}, {"$ref", "#"}}}};
}

void write(const std::filesystem::path& file, const std::string& text) {
  std::filesystem::create_directories(file.parent_path());
  write_atomically(file, text);
}

}  // namespace
}  // namespace vantage::cli

int main(int argc, char** argv) try {
  using namespace vantage::cli;
  if (argc != 2) return std::fprintf(stderr, "usage: vantage-manual FOLDER\n"), exit_usage;
  Console console;
  Program program{.console = console, .stop = {}, .abort = {}};
  CLI::App app{"vantage plans terrestrial LiDAR surveys: where should the scanner stand?", "vantage"};
  add_commands(app, program);
  const std::filesystem::path folder = argv[1];
  write(folder / "man1/vantage.1", main_page(app));
  for (const CLI::App* command : commands_of(app))
    write(folder / "man1" / ("vantage-" + command->get_name() + ".1"), page_of(*command));
  write(folder / "bash/vantage", bash_of(app));
  write(folder / "zsh/_vantage", zsh_of(app));
  write(folder / "schemas/config.schema.json", schema_of(app).dump(2) + "\n");
  return exit_ok;
} catch (const std::exception& error) {
  return std::fprintf(stderr, "vantage-manual: %s\n", error.what()), 1;
}
