// SPDX-License-Identifier: Apache-2.0
// Input from users of the program: the command line, configuration files, results of a plan.
#include "cli/options.hpp"

#include "cli/command.hpp"
#include "cli/stations.hpp"
#include "core/read_json.hpp"
#include "fuzz/target.hpp"

namespace vantage::fuzz {
namespace {

// A program that has read nothing yet.
struct Commands {
  Commands() : app("vantage", "vantage"), program{.console = console(), .stop = {}, .abort = {}} {
    cli::add_commands(app, program);
  }
  static cli::Console& console() {
    static cli::Console one;
    spdlog::set_level(spdlog::level::off);
    return one;
  }
  CLI::App app;
  cli::Program program;
};

}  // namespace

void configuration(Bytes bytes) {
  const std::string file = file_of(bytes, "config.json");
  accepts([&] {
    const auto values = read_json(file);
    Commands commands;
    for (const char* name : {"plan", "evaluate", "bound"})
      accepts([&] { cli::apply_layer(*commands.app.get_subcommand(name), values, file); });
  });
}

// Words end at line breaks.
void command_line(Bytes bytes) {
  std::vector<std::string> words{""};
  for (const char c : text_of(bytes))
    if (c == '\n')
      words.emplace_back();
    else if (c != '\0')
      words.back() += c;
  Commands commands;
  std::reverse(words.begin(), words.end());  // the order that CLI11 expects
  accepts([&] {
    try {
      commands.app.parse(words);
    } catch (const CLI::Error&) {
    }
  });
}

void front_json(Bytes bytes) {
  const std::string file = file_of(bytes, "front.json");
  accepts([&] {
    cli::StationOptions options;
    options.file = file;
    for (const cli::StationText& station : options.read(1024)) {
      require(station.position || station.uv, "a station stands somewhere");
      if (station.position)
        for (const double x : {station.position->x, station.position->y, station.position->z})
          require_finite(x, "a head");
      if (station.uv) require_finite(station.uv->u + station.uv->v, "(u, v)");
      require_finite(station.setup.heading.in_degrees() + station.setup.tilt.in_degrees(), "a heading or tilt");
    }
  });
}

}  // namespace vantage::fuzz
