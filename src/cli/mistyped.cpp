// SPDX-License-Identifier: Apache-2.0
#include "cli/mistyped.hpp"

#include "core/closest_name.hpp"

namespace vantage::cli {

std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

std::string explain_leftover(const CLI::App& app) {
  const auto named = app.get_subcommands();
  const CLI::App& command = named.empty() ? app : *named.front();
  std::string word = app.remaining(true).front();
  if (word.size() > 1 && word.front() == '-') {
    word = word.substr(0, word.find('='));
    return "there is no option " + word + did_you_mean(word, option_names(command));
  }
  if (!named.empty())
    return "'" + word + "' is one word too many: " + command.get_name() + " takes no second argument without an option";
  std::vector<std::string> commands;
  for (const CLI::App* known : app.get_subcommands([](const CLI::App*) { return true; }))
    commands.push_back(known->get_name());
  return "there is no command " + word + did_you_mean(word, commands);
}

}  // namespace vantage::cli
