// SPDX-License-Identifier: Apache-2.0
#include "import/program.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <new>

namespace vantage::importer {

void tell_progress(double done) {
  using Clock = std::chrono::steady_clock;
  static Clock::time_point last = Clock::now();
  if (Clock::now() - last < std::chrono::milliseconds(200)) return;
  last = Clock::now();
  std::fprintf(stderr, "progress %.3f\n", std::clamp(done, 0.0, 1.0));
}

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
