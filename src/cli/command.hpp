// SPDX-License-Identifier: Apache-2.0
// The program's commands: one file each, one function each.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "cli/console.hpp"
#include "cli/help.hpp"
#include "ranks/ranks.hpp"

namespace vantage::cli {

// exit_unmet: there are results, but not what was asked: no network meets the requirements, floor as large as a room is
// not entered, the ground is a plane laid below the model, a room has no session in its hours, or `next` finds stations
// that are still to come.
enum ExitCode : int { exit_ok = 0, exit_failed = 1, exit_usage = 2, exit_unmet = 3 };

// Surroundings of a command.
struct Program {
  Console& console;
  std::stop_token stop, abort;
  std::string command = {};            // as it was typed
  ranks::Ranks* ranks = nullptr;       // if this process is one of several
  std::function<int()> selected = {};  // set by the command that the user named
};

// Thrown if a command was stopped before it had a result.
struct Stopped {};

// A subcommand whose options live as long as the program; `run` is called after parsing and returns the exit code.
template <class Options>
void add_command(CLI::App& app, Program& program, const char* name, const char* help,
                 int (*run)(CLI::App&, Options&, Program&), std::vector<std::string> examples = {}) {
  CLI::App* command = app.add_subcommand(name, help);
  command->set_help_all_flag("--help-all", "Print this help message with all options and exit");
  set_examples(*command, std::move(examples));
  auto options = std::make_shared<Options>();
  options->add(*command);
  command->callback([command, options, run, &program] {
    program.selected = [command, options, run, &program] { return run(*command, *options, program); };
  });
}

void add_info(CLI::App& app, Program& program);
void add_generate(CLI::App& app, Program& program);
void add_import(CLI::App& app, Program& program);
void add_scan(CLI::App& app, Program& program);
void add_evaluate(CLI::App& app, Program& program);
void add_plan(CLI::App& app, Program& program);
void add_edit(CLI::App& app, Program& program);
void add_bound(CLI::App& app, Program& program);
void add_next(CLI::App& app, Program& program);

// All commands, with every option.
void add_commands(CLI::App& app, Program& program);

// The program: reads the command line, runs the command, reports errors. Returns the exit code.
int run(int argc, char** argv);
void add_panorama(CLI::App& app, Program& program);

}  // namespace vantage::cli
