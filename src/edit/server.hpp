// SPDX-License-Identifier: Apache-2.0
// Serves the editor's page to this machine alone.
#pragma once

#include <functional>
#include <stop_token>
#include <string>

#include "edit/session.hpp"

namespace vantage {

// Serves the page, and nothing else, on 127.0.0.1 until stopped, on a port of the system's choice and below a random
// token. Refuses requests that name another host, come from another origin, are too large or lack the token. `ready`
// gets the address. Throws Error io if no port is available.
void serve_editor(EditSession& session, const std::string& title, const std::function<void(const std::string&)>& ready,
                  std::stop_token stop);

}  // namespace vantage
