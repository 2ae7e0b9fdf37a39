// SPDX-License-Identifier: Apache-2.0
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <new>
#include <string>

#include "cli/command.hpp"
#include "cli/console.hpp"
#include "cli/interrupts.hpp"
#include "cli/join.hpp"
#include "cli/mistyped.hpp"
#include "vantage/vantage.hpp"

namespace vantage::cli {
namespace {

// The command line in a form that a shell accepts.
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

}  // namespace

void add_commands(CLI::App& app, Program& program) {
  use_help_text(app);
  app.set_version_flag("--version", std::string("vantage ") + version());
  app.require_subcommand(0, 1);
  add_info(app, program);
  add_generate(app, program);
  add_import(app, program);
  add_scan(app, program);
  add_panorama(app, program);
  add_evaluate(app, program);
  add_plan(app, program);
  add_next(app, program);
  add_edit(app, program);
  add_bound(app, program);
}

int run(int argc, char** argv) {
  Interrupts interrupts;
  Console console;
  Program program{
      .console = console, .stop = interrupts.stop(), .abort = interrupts.abort(), .command = typed(argc, argv)};
  CLI::App app{"vantage plans terrestrial LiDAR surveys: where should the scanner stand?", "vantage"};
  add_commands(app, program);
  std::unique_ptr<ranks::Ranks> ranks;
  // Only the first rank reports.
  const auto refuse = [&](int exit_code, Errc code, const std::string& why) {
    if (ranks && !ranks->first()) ranks->fail(code, why);
    spdlog::error("{}", why);
    return exit_code;
  };
  try {
    ranks = join_ranks();
    program.ranks = ranks.get();
    if (ranks) interrupts.one_of_several();
    if (ranks && !ranks->first()) spdlog::set_level(spdlog::level::off);
    app.parse(argc, argv);
    if (ranks && program.selected && !app.got_subcommand("plan"))
      throw Error(Errc::invalid_argument,
                  "only `vantage plan` shares its work among ranks; start this command without a launcher");
    if (!program.selected) throw Error(Errc::invalid_argument, "no command given; see vantage --help");
    return program.selected();
  } catch (const CLI::Success& help_or_version) {
    return ranks && !ranks->first() ? exit_ok : app.exit(help_or_version);
  } catch (const CLI::ParseError& error) {
    const auto named = app.get_subcommands();
    const bool leftover = dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr;
    const std::string message = leftover ? explain_leftover(app) : error.what();
    return refuse(exit_usage, Errc::invalid_argument,
                  message + (message.ends_with('?') ? " See" : "; see") + " vantage " +
                      (named.empty() ? "" : named.front()->get_name() + " ") + "--help");
  } catch (const Error& error) {
    std::string message = error.what();
    for (const auto& line : error.details()) message += "\n  - " + line;
    return refuse(error.code() == Errc::invalid_argument ? exit_usage : exit_failed, error.code(), message);
  } catch (const Stopped&) {
    return refuse(exit_failed, Errc::io, "stopped before the end; nothing was written");
  } catch (const std::bad_alloc&) {
    if (!ranks) throw;  // main() handles it without ranks
    return refuse(exit_failed, Errc::out_of_memory, "this machine has not enough memory for it");
  } catch (const std::exception& error) {
    return refuse(exit_failed, Errc::device_failure, error.what());
  }
}

}  // namespace vantage::cli
