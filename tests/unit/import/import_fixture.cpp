// SPDX-License-Identifier: Apache-2.0
#include "import_fixture.hpp"

#include <cstdlib>
#include <fstream>

#include "import/import.hpp"

namespace vantage::test {

ImportTest::ImportTest() {
  setenv("VANTAGE_IMPORTERS", VANTAGE_IMPORTERS_FOLDER, 1);
  setenv("XDG_CACHE_HOME", (folder_ / "cache").c_str(), 1);
}

ImportTest::~ImportTest() {
  unsetenv("VANTAGE_IMPORTERS");
  unsetenv("XDG_CACHE_HOME");
}

std::filesystem::path ImportTest::write(const std::string& name, std::string_view content) const {
  const std::filesystem::path file = folder_.path() / name;
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << content;
  return file;
}

void ImportTest::use_script(const std::string& body) const {
  const auto script = write("importers/vantage-import-mesh", "#!/bin/sh\n" + body + "\n");
  std::filesystem::permissions(script, std::filesystem::perms::owner_all);
  setenv("VANTAGE_IMPORTERS", script.parent_path().c_str(), 1);
}

Scene load_within(const std::filesystem::path& file, unsigned cpu_s) {
  // The GLB is in the cache then.
  if (const importers::Format& format = *importers::recognise(file).format; format.importer)
    importers::as_glb(file, format, {.cpu_s = cpu_s});
  return Scene::load(file);
}

}  // namespace vantage::test
