// SPDX-License-Identifier: Apache-2.0
#include "import/program.hpp"

#include <cstdio>
#include <exception>
#include <new>

namespace vantage::importer {

int run(const std::function<std::string()>& convert) {
  constexpr int kData = 65, kSystem = 71;
  try {
    const std::string glb = convert();
    return std::fwrite(glb.data(), 1, glb.size(), stdout) == glb.size() && std::fflush(stdout) == 0 ? 0 : kSystem;
  } catch (const std::bad_alloc&) {
    return kSystem;
  } catch (const std::length_error&) {
    std::fprintf(stderr, "as glTF the model would take more than the 4 GiB that a GLB holds; export parts of it\n");
    return kData;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return kData;
  }
}

}  // namespace vantage::importer
