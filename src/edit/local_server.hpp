// SPDX-License-Identifier: Apache-2.0
// HTTP server for this machine alone, with limits, since any user of the machine may connect.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>

namespace vantage {

struct HttpRequest {
  std::string method, target, host, origin, body;
};
struct HttpResponse {
  int status = 200;
  std::string type, body;
  std::string policy = {};  // content security policy
};

// A connection carries one request and its response. The size and the duration of a request are limited; chunked bodies
// are refused, and ranges are not served. If there are too many connections, the one that has been sending its request
// for longest is closed.
class LocalServer {
 public:
  static constexpr std::size_t kHeaderBytes = 8192, kBodyBytes = 4096, kConnections = 64;

  // Listens on a port of 127.0.0.1 that the system chooses. `request_time`: from connecting to the last byte of a
  // request. Throws Error io if no port is available.
  explicit LocalServer(std::chrono::milliseconds request_time = std::chrono::seconds(5));
  ~LocalServer();

  std::uint16_t port() const;
  // Serves until stopped. `answer` is called from several threads at once.
  void serve(const std::function<HttpResponse(const HttpRequest&)>& answer, std::stop_token stop);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vantage
