// SPDX-License-Identifier: Apache-2.0
// Attacks of other users on a port: the server goes on for others, and takes no memory for them.
#include "edit/local_server.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <fstream>
#include <thread>
#include <utility>
#include <vector>

namespace vantage {
namespace {

// A server that says what it was asked, until the end of the test.
class LocalServerTest : public testing::Test {
 protected:
  LocalServerTest() {
    thread_ = std::jthread([this](std::stop_token stop) {
      server_.serve(
          [this](const HttpRequest& request) {
            ++answered_;
            return HttpResponse{200, "text/plain", request.method + " " + request.target + " " + request.body, "p"};
          },
          stop);
    });
  }

  // A connection; closed with this.
  struct Client {
    int socket = -1;
    explicit Client(std::uint16_t port) : socket(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
      sockaddr_in address{};
      address.sin_family = AF_INET;
      address.sin_port = htons(port);
      address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
      EXPECT_EQ(::connect(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    }
    Client(Client&& other) noexcept : socket(std::exchange(other.socket, -1)) {}
    ~Client() {
      if (socket >= 0) ::close(socket);
    }
    // Returns true if all of the text was sent.
    bool send(const std::string& text) const {
      for (std::size_t sent = 0; sent < text.size();) {
        const ssize_t n = ::send(socket, text.data() + sent, text.size() - sent, MSG_NOSIGNAL);
        if (n <= 0) return false;
        sent += static_cast<std::size_t>(n);
      }
      return true;
    }
    std::string all() const {
      std::string text;
      char piece[4096];
      for (ssize_t n = 0; (n = ::recv(socket, piece, sizeof piece, 0)) > 0;)
        text.append(piece, static_cast<std::size_t>(n));
      return text;
    }
  };
  Client client() const { return Client(server_.port()); }
  std::string ask(const std::string& request) const {
    const Client asks = client();
    asks.send(request);
    return asks.all();
  }
  void expect_served() const {
    const std::string response = ask("GET /a?b=1 HTTP/1.1\r\nHost: x\r\n\r\n");
    EXPECT_TRUE(response.starts_with("HTTP/1.1 200")) << response;
    EXPECT_TRUE(response.ends_with("\r\n\r\nGET /a?b=1 ")) << response;
  }

  LocalServer server_;
  std::atomic<int> answered_ = 0;
  std::jthread thread_;  // ends before what it uses
};

std::uint64_t resident_bytes() {
  std::ifstream in("/proc/self/statm");
  std::uint64_t size = 0, resident = 0;
  in >> size >> resident;
  return resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

TEST_F(LocalServerTest, AnswersOneRequestAConnection) {
  expect_served();
  const std::string response =
      ask("POST /c HTTP/1.1\r\nHost: x\r\nContent-Length: 4\r\nRange: bytes=0-1\r\n\r\nbodyGET / HTTP/1.1\r\n\r\n");
  EXPECT_TRUE(response.ends_with("\r\n\r\nPOST /c body")) << response;
  EXPECT_NE(response.find("Connection: close\r\n"), std::string::npos) << response;
  EXPECT_NE(response.find("Content-Security-Policy: p\r\n"), std::string::npos) << response;
  EXPECT_NE(response.find("Cache-Control: no-store\r\n"), std::string::npos) << response;
  EXPECT_EQ(answered_, 2);
}

TEST_F(LocalServerTest, RefusesWhatIsTooLargeOrNoRequest) {
  const std::string body(LocalServer::kBodyBytes, 'x'), post = "POST / HTTP/1.1\r\nHost: x\r\n";
  const auto with_length = [&](const std::string& text) {
    return post + "Content-Length: " + std::to_string(text.size()) + "\r\n\r\n" + text;
  };
  EXPECT_TRUE(ask(with_length(body)).starts_with("HTTP/1.1 200"));
  for (const auto& [request, status] :
       {std::pair{with_length(body + "x"), "413"},
        {with_length(std::string(100'000, 'x')), "413"},
        {post + "Transfer-Encoding: chunked\r\n\r\n5\r\nhello\r\n0\r\n\r\n", "411"},
        {post + "A: " + std::string(LocalServer::kHeaderBytes, 'x') + "\r\n\r\n", "431"},
        {"GET /" + std::string(LocalServer::kHeaderBytes, 'x') + " HTTP/1.1\r\n\r\n", "431"},
        {std::string("no request at all\r\n\r\n"), "400"},
        {post + "Content-Length: -1\r\n\r\n", "400"},
        {post + "Content-Length: 1\r\nContent-Length: 2\r\n\r\nab", "400"}})
    EXPECT_TRUE(ask(request).starts_with(std::string("HTTP/1.1 ") + status)) << request.substr(0, 100);
  EXPECT_EQ(answered_, 1);
  expect_served();
}

TEST_F(LocalServerTest, AFloodOfHeadersTakesNoMemory) {
  const std::uint64_t before = resident_bytes();
  std::vector<Client> clients;
  const std::string field = "A: " + std::string(1 << 20, 'x') + "\r\n";
  for (int k = 0; k < 4; ++k) {
    clients.push_back(client());
    clients.back().send("GET / HTTP/1.1\r\n");
    for (int sent = 0; sent < 50 && clients.back().send(field); ++sent) {
    }
  }
  expect_served();
  EXPECT_LT(resident_bytes(), before + (std::uint64_t{16} << 20));
}

// More of them than it has threads, or room.
TEST_F(LocalServerTest, HalfRequestsStopNobodyElse) {
  std::vector<Client> clients;
  for (std::size_t k = 0; k < 3 * LocalServer::kConnections; ++k) {
    clients.push_back(client());
    clients.back().send(k % 3 == 0 ? "" : k % 3 == 1 ? "GET / HT" : "POST / HTTP/1.1\r\nContent-Length: 9\r\n\r\nhalf");
    if (k % 16 == 0) expect_served();
  }
  expect_served();
}

TEST_F(LocalServerTest, ARequestThatComesInDripsIsGivenUp) {
  LocalServer hasty(std::chrono::milliseconds(200));
  const std::jthread serving(
      [&](std::stop_token stop) { hasty.serve([](const HttpRequest&) { return HttpResponse{}; }, stop); });
  const Client slow(hasty.port());
  slow.send("GET / HTTP/1.1\r\n");
  bool open = true;
  for (int k = 0; k < 600 && open; ++k) {  // a minute, of which it gives it a fifth of a second
    open = slow.send("A: b\r\n");
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  EXPECT_FALSE(open);
}

}  // namespace
}  // namespace vantage
