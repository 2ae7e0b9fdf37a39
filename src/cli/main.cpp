// SPDX-License-Identifier: Apache-2.0
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <new>
#include <string>

#include "cli/command.hpp"
#include "cli/console.hpp"
#include "cli/interrupts.hpp"
#include "cli/mistyped.hpp"
#include "vantage/vantage.hpp"

namespace vantage::cli {
namespace {

// As a shell takes it back.
std::string typed(int argc, char** argv) {
  std::string text = "vantage";
  for (int k = 1; k < argc; ++k) {
    const std::string word = argv[k];
    constexpr const char* kPlain = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_=+,./:%@^";
    if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) {
      text += " " + word;
      continue;
    }
    text += " '";
    for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
    text += "'";
  }
  return text;
}

int run(int argc, char** argv) {
  Interrupts interrupts;
  Console console;
  Program program{
      .console = console, .stop = interrupts.stop(), .abort = interrupts.abort(), .command = typed(argc, argv)};
  CLI::App app{"vantage plans terrestrial LiDAR surveys: where should the scanner stand?", "vantage"};
  app.set_version_flag("--version", std::string("vantage ") + version());
  app.require_subcommand(0, 1);
  add_info(app, program);
  add_generate(app, program);
  add_scan(app, program);
  add_panorama(app, program);
  add_evaluate(app, program);
  add_plan(app, program);
  add_edit(app, program);
  add_bound(app, program);
  try {
    app.parse(argc, argv);
    if (!program.selected) throw Error(Errc::invalid_argument, "which command? See vantage --help");
    return program.selected();
  } catch (const CLI::Success& help_or_version) {
    return app.exit(help_or_version);
  } catch (const CLI::ParseError& error) {
    const auto named = app.get_subcommands();
    const bool leftover = dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr;
    const std::string message = leftover ? explain_leftover(app) : error.what();
    spdlog::error("{} vantage {}--help", message + (message.ends_with('?') ? " See" : "; see"),
                  named.empty() ? "" : named.front()->get_name() + " ");
    return exit_usage;
  } catch (const Error& error) {
    std::string message = error.what();
    for (const auto& line : error.details()) message += "\n  - " + line;
    spdlog::error("{}", message);
    return error.code() == Errc::invalid_argument ? exit_usage : exit_failed;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    spdlog::error("{}", error.what());
    return exit_failed;
  }
}

}  // namespace
}  // namespace vantage::cli

int main(int argc, char** argv) {
  try {
    return vantage::cli::run(argc, argv);
  } catch (const std::bad_alloc&) {  // no logger: it would want memory
    std::fputs(
        "vantage: error: this machine has not enough memory for it; coarser voxels (--user-size) or a smaller scene "
        "need less, and a plan goes on from its checkpoint with --resume\n",
        stderr);
    return vantage::cli::exit_failed;
  }
}
