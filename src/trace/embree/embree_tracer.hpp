// SPDX-License-Identifier: Apache-2.0
// The CPU engine.
#pragma once

#include <memory>

#include "trace/tracer.hpp"

namespace vantage {

EngineInfo embree_engine_info();

// Throws Error: out_of_memory, device_failure.
std::unique_ptr<Tracer> make_embree_tracer(const TraceScene& scene);

}  // namespace vantage
