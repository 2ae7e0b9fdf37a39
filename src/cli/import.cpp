// SPDX-License-Identifier: Apache-2.0
#include "import/import.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <filesystem>
#include <initializer_list>
#include <map>
#include <nlohmann/json.hpp>
#include <string_view>

#include "cli/command.hpp"
#include "cli/options.hpp"
#include "cli/site.hpp"
#include "core/atomic_file.hpp"
#include "core/text.hpp"
#include "scene/importer_settings.hpp"
#include "vantage/error.hpp"
#include "vantage/scene.hpp"
#include "vantage/site.hpp"

namespace vantage::cli {
namespace {

const SettingTable<SiteOptions>& settings_of(std::initializer_list<std::string_view> names) {
  static std::map<std::string_view, SettingTable<SiteOptions>> tables;
  SettingTable<SiteOptions>& table = tables[*names.begin()];
  if (table.empty())
    for (const auto& row : site_settings())
      if (std::ranges::find(names, row.name) != names.end()) table.push_back(row);
  return table;
}

// A GLB of another unit or axis as one in metres with Y up, which says so: a node around all others changes them.
std::vector<std::uint8_t> in_metres(const std::vector<std::uint8_t>& glb, Unit unit, UpAxis up) {
  using nlohmann::json;
  constexpr std::size_t kText = 20;  // behind the file's header and the chunk's
  const auto word = [&](std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t b = 0; b < 4; ++b) value |= static_cast<std::uint32_t>(glb[at + b]) << (8 * b);
    return value;
  };
  const auto text_end = glb.begin() + static_cast<std::ptrdiff_t>(kText + word(12));
  json document = json::parse(glb.begin() + static_cast<std::ptrdiff_t>(kText), text_end);
  const double m = metres_in(unit);
  const json matrix = up == UpAxis::x   ? json{0, m, 0, 0, -m, 0, 0, 0, 0, 0, m, 0, 0, 0, 0, 1}
                      : up == UpAxis::z ? json{m, 0, 0, 0, 0, 0, -m, 0, 0, m, 0, 0, 0, 0, 0, 1}
                                        : json{m, 0, 0, 0, 0, m, 0, 0, 0, 0, m, 0, 0, 0, 0, 1};
  for (json& scene : document["scenes"]) {
    document["nodes"].push_back({{"matrix", matrix}, {"children", scene["nodes"]}});
    scene["nodes"] = {document["nodes"].size() - 1};
  }
  document["asset"]["extras"]["vantage"].update({{"unit", "m"}, {"up", "y"}});
  std::string text = document.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  std::vector<std::uint8_t> out(glb.begin(), glb.begin() + kText);
  out.insert(out.end(), text.begin(), text.end());
  out.insert(out.end(), text_end, glb.end());
  const auto set_word = [&](std::size_t at, std::size_t value) {
    for (std::size_t b = 0; b < 4; ++b) out[at + b] = static_cast<std::uint8_t>(value >> (8 * b));
  };
  set_word(8, out.size()), set_word(12, text.size());
  return out;
}

struct ImportOptions {
  std::string file;
  std::optional<std::string> output;
  SiteOptions site;                    // as far as an importer takes them
  std::optional<double> cell_m;        // of a point cloud
  std::optional<std::string> columns;  // of a point cloud in text
  bool json = false;

  void add(CLI::App& command) {
    command
        .add_option_function<std::vector<std::string>>(
            "file", [this](const std::vector<std::string>& files) { take_files(files, file, site.scene); },
            "A model: IFC, OBJ, STL, PLY, FBX, COLLADA, 3DS, X3D or DXF; a floor plan in DXF; or points: E57, LAS, "
            "LAZ, PLY, XYZ, PTS, CSV, PTX or PCD; or a folder or several files of scans, IFC models, or floor plans, a "
            "file for each storey")
        ->type_name("FILE");
    add_text(command, "-o,--output", "FILE", "File to write: .glb", output);
    add_settings(command, settings_of({"unit", "up"}), site, "Axes of a model or floor plan");
    add_settings(command, settings_of({"wall-layer", "wall-height"}), site, "Floor plan");
    add_settings(command, settings_of({"memory"}), site);
    add_number(command, "--cell", "M", "Size of the cells of a point cloud, in metres; chosen by its density otherwise",
               cell_m, {.low = 0.005, .high = 10})
        ->group("Point cloud");
    add_text(command, "--columns", "LIST",
             "Columns of a point cloud in text: x, y, z, and - for others, e.g. -,x,y,z; recognised by default",
             columns)
        ->group("Point cloud");
    command.add_flag("--json", json, "Print one JSON object");
  }
};

int import_model(CLI::App&, ImportOptions& options, Program& program) {
  if (options.file.empty()) throw Error(Errc::invalid_argument, "import: no model given; see vantage import --help");
  if (!options.output) throw Error(Errc::invalid_argument, "import: no file to write; give one with -o site.glb");
  SceneOptions read = options.site.scene;
  read.doors = {"closed"};
  read.max_memory_bytes = options.site.memory_bytes;
  const importers::Format& format = *importers::recognise(options.file, read.beside).format;
  std::vector<std::string> settings = importer_settings(read, format, options.file);
  if (options.cell_m && !takes_setting(format, "cell"))
    throw Error(Errc::invalid_argument, options.file + ": --cell is for point clouds, and this is " + format.name);
  if (options.cell_m) settings.push_back("cell=" + number(*options.cell_m));
  if (options.columns && !takes_setting(format, "columns"))
    throw Error(Errc::invalid_argument,
                options.file + ": --columns is for points as lines of text, and this is " + format.name);
  if (options.columns) settings.push_back("columns=" + *options.columns);
  const bool by_hand = options.cell_m || options.columns;
  if (!format.importer) {
    Scene::load(options.file, read);  // reports what is wrong with it
    throw Error(Errc::invalid_argument, "import: " + options.file + " is glTF already; the other commands read it");
  }
  ProgressLine line(program.console, "reading " + options.file);
  auto glb = importers::as_glb(options.file, format, {.memory = options.site.memory_bytes}, settings,
                               {.report = [&](double done) { line.update(done); }, .stop = program.stop}, read.beside);
  if (glb.empty()) throw Stopped{};
  if ((read.unit || read.up) && !takes_setting(format, "unit"))
    glb = in_metres(glb, read.unit.value_or(Unit::metre), read.up.value_or(UpAxis::y));
  const auto write = [&] {
    write_atomically(*options.output, {reinterpret_cast<const char*>(glb.data()), glb.size()});
  };
  // It is read to report what is wrong with it, mostly from the cache; the cache of a site has nothing by hand.
  if (by_hand) write();
  const Scene scene = [&] {
    if (!by_hand) return Scene::load(options.file, read);
    try {
      return Scene::load(*options.output, {.max_memory_bytes = read.max_memory_bytes});
    } catch (const Error& error) {
      std::error_code failure;
      std::filesystem::remove(*options.output, failure);
      // It is named as what was given: the other is gone.
      std::string text = error.what();
      if (text.starts_with(*options.output)) text.replace(0, options.output->size(), options.file);
      throw Error(error.code(), text, {error.details().begin(), error.details().end()});
    }
  }();
  if (!by_hand) write();
  for (const auto& note : scene.notes()) spdlog::info("{}: {}", options.file, note);
  if (options.json)
    program.console.print(nlohmann::json{{"format", format.name},
                                         {"file", *options.output},
                                         {"triangles", scene.triangle_count()},
                                         {"meshes", scene.meshes().size()},
                                         {"bytes", glb.size()}});
  else
    program.console.print(fmt::format("{}: {} triangles in {} meshes, {:.1f} MB\n", *options.output,
                                      scene.triangle_count(), scene.meshes().size(),
                                      static_cast<double>(glb.size()) * 1e-6));
  return exit_ok;
}

}  // namespace

void add_import(CLI::App& app, Program& program) {
  add_command<ImportOptions>(app, program, "import", "Convert a model of another format to glTF", import_model,
                             {"vantage import site.ifc -o site.glb"});
}

}  // namespace vantage::cli
