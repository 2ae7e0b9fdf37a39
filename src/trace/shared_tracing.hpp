// SPDX-License-Identifier: Apache-2.0
// Where other processes share the work: what makes a simulator's tracer of its own and of theirs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "trace/tracer.hpp"

namespace vantage {

class TracerMaker {
 public:
  virtual ~TracerMaker() = default;
  // `own`: over the devices of this process. `fingerprint`: of the scene that is traced.
  virtual std::unique_ptr<Tracer> make(std::unique_ptr<Tracer> own, const TraceScene& scene,
                                       std::uint64_t fingerprint) = 0;
  // How many networks of every ray keep all of them busy.
  virtual std::size_t networks_at_once() const = 0;
};

// While it lives, simulators that are made on this thread trace with what `maker` makes. Not in another's life.
class SharedTracing {
 public:
  explicit SharedTracing(TracerMaker& maker);
  SharedTracing(const SharedTracing&) = delete;
  SharedTracing& operator=(const SharedTracing&) = delete;
  ~SharedTracing();
  // Of the one that lives on this thread; null: none does.
  static TracerMaker* maker();
};

}  // namespace vantage
