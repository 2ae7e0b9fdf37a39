// SPDX-License-Identifier: Apache-2.0
#include "import/importers.hpp"

#include <dlfcn.h>
#include <unistd.h>

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

// The folder of the executable or shared library with this function; empty if unknown.
fs::path own_folder() {
  Dl_info info{};
  if (dladdr(reinterpret_cast<const void*>(&can_run), &info) == 0 || !info.dli_fname) return {};
  std::error_code failure;
  // The name of an executable may be the one by which it was called.
  fs::path file = fs::canonical(info.dli_fname, failure);
  if (failure) file = fs::read_symlink("/proc/self/exe", failure);
  return failure ? fs::path() : file.parent_path();
}

std::vector<fs::path> folders() {
  if (const char* given = std::getenv("VANTAGE_IMPORTERS"); given && *given) return {given};
  std::vector<fs::path> out;
  if (const fs::path own = own_folder(); !own.empty())
    for (const fs::path& folder :
         {own, own / "../libexec/vantage", own / "../../libexec/vantage"})  // lib may have a folder an architecture
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

}  // namespace

Importer find_importer(const Format& format) {
  const bool ifc = std::string_view(format.importer) == "vantage-import-ifc";
  const bool gltf = std::string_view(format.importer) == "vantage-import-gltf";
  const bool cloud = std::string_view(format.importer) == "vantage-import-cloud";
  const bool plan = std::string_view(format.importer) == "vantage-import-plan";
  const std::string remedy = ifc ? "install node and web-ifc with setup.sh --ifc"
                                 : std::string("install ") +
                                       (gltf    ? "libdraco-dev and libmeshoptimizer-dev"
                                        : cloud ? "libexpat1-dev"
                                        : plan  ? "libdxflib-dev and libgeos-dev"
                                                : "libassimp-dev") +
                                       " and build vantage again (setup.sh does both)";
  for (const fs::path& folder : folders()) {
    std::error_code failure;
    // A program, or a folder with a script for node.
    fs::path program = fs::canonical(folder / format.importer, failure);
    if (failure) continue;
    const bool script = fs::is_directory(program, failure);
    if (script) program /= "import.mjs";
    if (!fs::is_regular_file(program, failure)) continue;
    Importer found{program, {program.string()}, {program.parent_path()}};
    if (!script) {
      const std::string_view extensions = format.extensions;
      found.words.emplace_back(extensions.substr(1, extensions.find(' ') - 1));
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
