// SPDX-License-Identifier: Apache-2.0
#include "import/import.hpp"

#include <spdlog/spdlog.h>

#include "cli/command.hpp"
#include "cli/options.hpp"
#include "core/atomic_file.hpp"
#include "core/text.hpp"
#include "scene/importer_settings.hpp"
#include "vantage/error.hpp"
#include "vantage/scene.hpp"
#include "vantage/site.hpp"

namespace vantage::cli {
namespace {

const SettingTable<SiteOptions>& floor_plan_settings() {
  static const SettingTable<SiteOptions> table = [] {
    SettingTable<SiteOptions> rows;
    for (const auto& row : site_settings())
      if (row.name == "unit" || row.name == "wall-layer" || row.name == "wall-height") rows.push_back(row);
    return rows;
  }();
  return table;
}

struct ImportOptions {
  std::string file;
  std::optional<std::string> output;
  SiteOptions site;              // as far as an importer takes them
  std::optional<double> cell_m;  // of a point cloud
  bool json = false;

  void add(CLI::App& command) {
    command
        .add_option("file", file,
                    "A model: IFC, OBJ, STL, PLY, FBX, COLLADA, 3DS, X3D or DXF; a floor plan in DXF; or points: E57, "
                    "LAS, PLY, XYZ, PTS, PTX or PCD; or a folder of scans, or of floor plans, a file for each storey")
        ->type_name("FILE");
    add_text(command, "-o,--output", "FILE", "File to write: .glb", output);
    add_settings(command, floor_plan_settings(), site, "Floor plan");
    add_number(command, "--cell", "M", "Size of the cells of a point cloud, in metres; chosen by its density otherwise",
               cell_m, {.low = 0.005, .high = 10})
        ->group("Point cloud");
    command.add_flag("--json", json, "Print one JSON object");
  }
};

int import_model(CLI::App&, ImportOptions& options, Program& program) {
  if (options.file.empty()) throw Error(Errc::invalid_argument, "import: no model given; see vantage import --help");
  if (!options.output) throw Error(Errc::invalid_argument, "import: no file to write; give one with -o site.glb");
  SceneOptions read = options.site.scene;
  read.doors = {"closed"};
  const importers::Format& format = *importers::recognise(options.file).format;
  std::vector<std::string> settings = importer_settings(read, format, options.file);
  if (options.cell_m && !takes_setting(format, "cell"))
    throw Error(Errc::invalid_argument, options.file + ": --cell is for point clouds, and this is " + format.name);
  if (options.cell_m) settings.push_back("cell=" + number(*options.cell_m));
  if (!format.importer) {
    Scene::load(options.file, read);  // reports what is wrong with it
    throw Error(Errc::invalid_argument, "import: " + options.file + " is glTF already; the other commands read it");
  }
  ProgressLine line(program.console, "reading " + options.file);
  const auto glb = importers::as_glb(options.file, format, {}, settings,
                                     {.report = [&](double done) { line.update(done); }, .stop = program.stop});
  if (glb.empty()) throw Stopped{};
  const auto write = [&] {
    write_atomically(*options.output, {reinterpret_cast<const char*>(glb.data()), glb.size()});
  };
  // It is read to report what is wrong with it, mostly from the cache; the cache of a site has no cells by hand.
  if (options.cell_m) write();
  const Scene scene = options.cell_m ? Scene::load(*options.output) : Scene::load(options.file, read);
  if (!options.cell_m) write();
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
  add_command<ImportOptions>(app, program, "import", "Convert a model of another format to glTF", import_model);
}

}  // namespace vantage::cli
