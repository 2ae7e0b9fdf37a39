// SPDX-License-Identifier: Apache-2.0
#include "import/importers.hpp"

#include <dlfcn.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <sstream>
#include <string_view>

#include "vantage/error.hpp"

namespace vantage::importers {
namespace {

namespace fs = std::filesystem;

bool can_run(const fs::path& file) {
  std::error_code failure;
  return fs::is_regular_file(file, failure) && access(file.c_str(), X_OK) == 0;
}

// Returns the folder of the executable or shared library with this function; empty if unknown.
fs::path own_folder() {
  Dl_info info{};
  if (dladdr(reinterpret_cast<const void*>(&can_run), &info) == 0 || !info.dli_fname) return {};
  std::error_code failure;
  // An executable's name may be only the one by which it was called.
  fs::path file = fs::canonical(info.dli_fname, failure);
  if (failure) file = fs::read_symlink("/proc/self/exe", failure);
  return failure ? fs::path() : file.parent_path();
}

std::vector<fs::path> folders() {
  if (const char* given = std::getenv("VANTAGE_IMPORTERS"); given && *given) return {given};
  std::vector<fs::path> out;
  if (const fs::path own = own_folder(); !own.empty())
    for (const fs::path& folder :
         {own, own / "../libexec/vantage", own / "../../libexec/vantage"})  // an architecture may have its own lib
      out.push_back(folder.lexically_normal());
  out.emplace_back(VANTAGE_LIBEXEC_FOLDER);
  return out;
}

fs::path in_path(const char* name) {
  const char* path = std::getenv("PATH");
  std::istringstream folders_of_path(path ? path : "");
  for (std::string folder; std::getline(folders_of_path, folder, ':');)
    if (const fs::path file = fs::path(folder) / name; !folder.empty() && can_run(file)) return file;
  return {};
}

std::string missing(const Format& format, const std::string& why, const std::string& remedy) {
  return std::string("this is ") + format.name + ", which " + format.importer + " turns into glTF, and " + why + "; " +
         remedy + ", or export glTF";
}

// Adds the other files of the importer of clouds: node, the script that decompresses LAZ, and the registry of PROJ.
void add_helpers(Importer& importer, const Format& format) {
  std::error_code failure;
  const fs::path script = fs::canonical(importer.program.parent_path() / "vantage-import-laz", failure);
  const fs::path node = failure ? fs::path() : fs::canonical(in_path("node"), failure);
  if (!failure) {
    importer.readable.insert(importer.readable.end(), {script, node.parent_path().parent_path()});
    importer.spawns = std::string_view(format.name) == "LAS";
  }
  for (const char* name : {"PROJ_DATA", "PROJ_LIB"})
    if (const char* folder = std::getenv(name); folder && *folder) importer.readable.emplace_back(folder);
}

// Returns advice if an importer is missing. REQUIRES: an importer of a format.
std::string remedy_for(std::string_view importer) {
  if (importer == "vantage-import-ifc") return "install node and web-ifc with setup.sh --ifc";
  struct Needs {
    std::string_view importer, packages;
  };
  constexpr std::array kNeeds{Needs{"vantage-import-mesh", "libassimp-dev and libexpat1-dev"},
                              Needs{"vantage-import-gltf", "libdraco-dev and libmeshoptimizer-dev"},
                              Needs{"vantage-import-cloud", "libexpat1-dev"},
                              Needs{"vantage-import-plan", "libgeos-dev"}};
  const auto needs = std::ranges::find(kNeeds, importer, &Needs::importer);
  return "install " + std::string(needs->packages) + " and build vantage again (setup.sh does both)";
}

}  // namespace

Importer find_importer(const Format& format) {
  const std::string remedy = remedy_for(format.importer);
  for (const fs::path& folder : folders()) {
    std::error_code failure;
    // The importer is a program, or a folder with a script for node.
    fs::path program = fs::canonical(folder / format.importer, failure);
    if (failure) continue;
    const bool script = fs::is_directory(program, failure);
    if (script) program /= "import.mjs";
    if (!fs::is_regular_file(program, failure)) continue;
    Importer found{program, {program.string()}, {program.parent_path()}};
    if (!script) {
      const std::string_view extensions = format.extensions;
      found.words.emplace_back(extensions.substr(1, extensions.find(' ') - 1));
      if (std::string_view(format.importer) == "vantage-import-cloud") add_helpers(found, format);
      return found;
    }
    const fs::path node = fs::canonical(in_path("node"), failure);
    if (failure) throw Error(Errc::io, missing(format, "node, which runs it, is not installed", remedy));
    found.words.insert(found.words.begin(), node.string());
    found.readable.push_back(node.parent_path().parent_path());
    return found;
  }
  throw Error(Errc::io, missing(format, "that is not installed", remedy));
}

}  // namespace vantage::importers
