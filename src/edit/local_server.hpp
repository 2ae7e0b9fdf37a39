// SPDX-License-Identifier: Apache-2.0
// HTTP on this machine, for this machine, with limits in front of it: anybody here may connect, whoever they are.
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

// A connection carries one request and its response. A request has so many bytes and so much time, all in all; chunked
// bodies are refused, and ranges not served. Where too many are connected, who has been sending its request for longest
// goes.
class LocalServer {
 public:
  static constexpr std::size_t kHeaderBytes = 8192, kBodyBytes = 4096, kConnections = 64;

  // Listens on a port of 127.0.0.1 that the system chooses. `request_time`: of a request, from connecting to its last
  // byte. Throws Error io where no port can be had.
  explicit LocalServer(std::chrono::milliseconds request_time = std::chrono::seconds(5));
  ~LocalServer();

  std::uint16_t port() const;
  // Until a stop is asked for. `answer` is called from several threads at once.
  void serve(const std::function<HttpResponse(const HttpRequest&)>& answer, std::stop_token stop);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vantage
