// SPDX-License-Identifier: Apache-2.0
// Counts the members of an aggregate, so that a table of them in a test fails to compile where one is added.
#pragma once

#include <cstddef>
#include <cstdlib>

namespace vantage::test {

struct Anything {
  template <class T>
  operator T() const {  // never called: only asked whether it would do
    std::abort();
  }
};

template <class T, class... Members>
constexpr std::size_t member_count() {
  if constexpr (requires { T{Members{}..., Anything{}}; })
    return member_count<T, Members..., Anything>();
  else
    return sizeof...(Members);
}

}  // namespace vantage::test
