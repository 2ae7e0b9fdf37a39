// SPDX-License-Identifier: Apache-2.0
// Text of --help: the purpose of a command, examples, its own options, then those of every site.
#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace vantage::cli {

// The formatter of the program's commands. Advanced options are printed by --help-all alone.
class HelpText : public CLI::Formatter {
 public:
  void set_advanced(const CLI::Option* option) { advanced_.insert(option); }
  void set_examples(const CLI::App* command, std::vector<std::string> lines) { examples_[command] = std::move(lines); }

  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override;
  std::string make_option(const CLI::Option* option, bool is_positional) const override;

 private:
  std::set<const CLI::Option*> advanced_;
  std::map<const CLI::App*, std::vector<std::string>> examples_;
};

// Gives a program and the commands that are added to it this formatter.
void use_help_text(CLI::App& app);
// Does nothing to an app without it.
void set_advanced(const CLI::App& command, const CLI::Option* option);
// Command lines, each with what it does after two blanks.
void set_examples(const CLI::App& command, std::vector<std::string> lines);

}  // namespace vantage::cli
