// SPDX-License-Identifier: Apache-2.0
#include "trace/shared_tracing.hpp"

namespace vantage {
namespace {

thread_local TracerMaker* shared_by = nullptr;

}  // namespace

SharedTracing::SharedTracing(TracerMaker& maker) { shared_by = &maker; }
SharedTracing::~SharedTracing() { shared_by = nullptr; }
TracerMaker* SharedTracing::maker() { return shared_by; }

}  // namespace vantage
