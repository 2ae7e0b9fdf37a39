// SPDX-License-Identifier: Apache-2.0
// The editor's page on this machine, for this machine.
#pragma once

#include <functional>
#include <stop_token>
#include <string>

#include "edit/session.hpp"

namespace vantage {

// Serves the page on 127.0.0.1 until a stop is asked for, on a port of the system's choice and below a random token,
// and nothing else: requests that name another host, come from another origin, are too large or lack the token are
// refused. `ready` is told the address. Throws Error io where no port can be had.
void serve_editor(EditSession& session, const std::string& title, const std::function<void(const std::string&)>& ready,
                  std::stop_token stop);

}  // namespace vantage
