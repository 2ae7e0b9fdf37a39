// SPDX-License-Identifier: Apache-2.0
#include <spdlog/spdlog.h>

#include <filesystem>

#include "cli/command.hpp"
#include "cli/options.hpp"
#include "vantage/built_in_scenes.hpp"
#include "vantage/error.hpp"
#include "vantage/scene.hpp"

namespace vantage::cli {
namespace {

struct GenerateOptions {
  std::string name;
  std::uint64_t triangles = 20'000;
  std::optional<std::string> output;
  bool json = false;

  void add(CLI::App& command) {
    std::string names;
    for (const auto& scene : built_in_scene_names()) names += (names.empty() ? "" : ", ") + scene;
    command.add_option("name", name, names)->type_name("NAME");
    add_value(command, "--triangles", "N", "Wanted number of triangles of industrial, 20000 and up; 20000 otherwise",
              [this](const std::string& text, const std::string& what) {
                triangles = parse_count(text, what, 1, 1'000'000'000);
              });
    add_text(command, "-o,--output", "FILE", "File to write: .glb", output);
    command.add_flag("--json", json, "Print one JSON object");
  }
};

int generate(CLI::App&, GenerateOptions& options, Program& program) {
  if (options.name.empty())
    throw Error(Errc::invalid_argument, "generate: no scene given; see vantage generate --help");
  if (!options.output) throw Error(Errc::invalid_argument, "generate: no file to write; give one with -o scene.glb");
  write_built_in_scene(options.name, options.triangles, *options.output);
  const Scene scene = Scene::load(*options.output);
  const auto bytes = std::filesystem::file_size(*options.output);
  if (options.json)
    program.console.print(nlohmann::json{{"name", options.name},
                                         {"file", *options.output},
                                         {"triangles", scene.triangle_count()},
                                         {"meshes", scene.meshes().size()},
                                         {"bytes", bytes}});
  else
    program.console.print(fmt::format("{}: {} triangles in {} meshes, {:.1f} MB\n", *options.output,
                                      scene.triangle_count(), scene.meshes().size(),
                                      static_cast<double>(bytes) * 1e-6));
  return exit_ok;
}

}  // namespace

void add_generate(CLI::App& app, Program& program) {
  add_command<GenerateOptions>(app, program, "generate", "Write a built-in scene", generate,
                               {"vantage generate office -o office.glb"});
}

}  // namespace vantage::cli
