// SPDX-License-Identifier: Apache-2.0
#include "cli/help.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <sstream>
#include <utility>

namespace vantage::cli {
namespace {

// Headings of the options that every command on a site has.
constexpr std::array kOfSites{"Scene", "Scanner", "Measure", "Placement", "Run"};
constexpr std::size_t kIndent = 30, kLine = 110;

// Breaks a text at blanks, into lines from column kIndent on.
std::string wrapped(const std::string& text) {
  std::istringstream words(text);
  std::string lines, word;
  std::size_t at = 0;
  while (words >> word) {
    const bool first = lines.empty(), fits = at + 1 + word.size() <= kLine - kIndent;
    if (!first) lines += fits ? std::string(" ") : "\n" + std::string(kIndent, ' ');
    at = first || !fits ? word.size() : at + 1 + word.size();
    lines += word;
  }
  return lines;
}

HelpText* text_of(const CLI::App& app) { return dynamic_cast<HelpText*>(app.get_formatter().get()); }

}  // namespace

std::string HelpText::make_option(const CLI::Option* option, bool is_positional) const {
  const std::string left = "  " + make_option_name(option, is_positional) + make_option_opts(option);
  const std::string gap =
      left.size() + 1 > kIndent ? "\n" + std::string(kIndent, ' ') : std::string(kIndent - left.size(), ' ');
  return left + gap + wrapped(make_option_desc(option)) + "\n";
}

std::string HelpText::make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const {
  if (mode == CLI::AppFormatMode::Sub) return Formatter::make_help(app, std::move(name), mode);
  std::string text = make_description(app) + make_usage(app, std::move(name));
  if (const auto found = examples_.find(app); found != examples_.end() && !found->second.empty()) {
    text += "\nExamples:\n";
    for (const std::string& line : found->second) text += "  " + line + "\n";
  }
  text += make_positionals(app);
  std::vector<std::string> groups = app->get_groups();
  std::ranges::stable_partition(groups,
                                [](const std::string& g) { return std::ranges::find(kOfSites, g) == kOfSites.end(); });
  std::size_t left_out = 0;
  for (const std::string& group : groups) {
    std::vector<const CLI::Option*> shown;
    for (const CLI::Option* option : app->get_options({})) {
      if (group.empty() || option->get_group() != group || !option->nonpositional()) continue;
      if (mode == CLI::AppFormatMode::Normal && advanced_.contains(option))
        ++left_out;
      else
        shown.push_back(option);
    }
    if (!shown.empty()) text += make_group(group, false, shown);
  }
  text += make_subcommands(app, mode) + "\n" + make_footer(app);
  if (left_out > 0)
    text +=
        std::to_string(left_out) + " more options are for special cases: vantage " + app->get_name() + " --help-all\n";
  return text;
}

void use_help_text(CLI::App& app) { app.formatter(std::make_shared<HelpText>()); }

void set_advanced(const CLI::App& command, const CLI::Option* option) {
  if (HelpText* const text = text_of(command)) text->set_advanced(option);
}

void set_examples(const CLI::App& command, std::vector<std::string> lines) {
  if (HelpText* const text = text_of(command)) text->set_examples(&command, std::move(lines));
}

}  // namespace vantage::cli
