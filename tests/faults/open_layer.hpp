// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <dlfcn.h>

#include <cstdio>
#include <cstdlib>

#include "faults/fault_layer.hpp"

namespace vantage::test {

// Loads the layer into every Vulkan instance from here on. REQUIRES: none was made yet.
inline const FaultControl& open_layer() {
  setenv("VK_ADD_LAYER_PATH", VANTAGE_FAULT_LAYER_FOLDER, 1);
  setenv("VK_INSTANCE_LAYERS", "VK_LAYER_VANTAGE_faults", 1);
  void* const library = dlopen(VANTAGE_FAULT_LAYER, RTLD_NOW);
  void* const get = library ? dlsym(library, "vantage_fault_layer") : nullptr;
  if (!get) std::fprintf(stderr, "no fault layer: %s\n", dlerror()), std::exit(1);
  return *reinterpret_cast<GetFaultControl>(get)();
}

}  // namespace vantage::test
