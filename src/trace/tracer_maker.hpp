// SPDX-License-Identifier: Apache-2.0
// Lets other processes share the work: builds a simulator's tracer from its own and theirs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "trace/tracer.hpp"

namespace vantage {

class TracerMaker {
 public:
  virtual ~TracerMaker() = default;
  // `own`: over the devices of this process. `fingerprint`: of the traced scene.
  virtual std::unique_ptr<Tracer> make(std::unique_ptr<Tracer> own, const TraceScene& scene,
                                       std::uint64_t fingerprint) = 0;
  // Returns the number of networks, of every ray, that keeps all processes busy.
  virtual std::size_t networks_at_once() const = 0;
};

}  // namespace vantage
