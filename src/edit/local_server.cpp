// SPDX-License-Identifier: Apache-2.0
#include "edit/local_server.hpp"

#include <algorithm>
#include <array>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/thread_pool.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <chrono>
#include <list>
#include <optional>
#include <utility>

#include "vantage/error.hpp"

namespace vantage {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using asio::ip::tcp;
using ErrorCode = beast::error_code;

constexpr std::chrono::seconds kResponseTime{60}, kFarewellTime{1};
constexpr std::size_t kThreads = 4;               // for answers
constexpr std::size_t kUnreadBytes = 256 * 1024;  // of a refused request, read and dropped so that the refusal arrives

using Answer = std::function<HttpResponse(const HttpRequest&)>;

int status_of(ErrorCode error) {
  if (error == http::error::header_limit || error == http::error::buffer_overflow) return 431;
  return error == http::error::body_limit ? 413 : 400;
}

// All members except `answer` run on the thread that serves.
class Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(tcp::socket socket, asio::thread_pool& workers, const Answer& answer)
      : stream_(std::move(socket)), workers_(workers), answer_(answer), buffer_(kBuffer) {
    parser_->header_limit(LocalServer::kHeaderBytes);
    parser_->body_limit(LocalServer::kBodyBytes);
  }

  void start(std::chrono::milliseconds request_time) {
    stream_.expires_after(request_time);  // for the whole request, however slowly it arrives
    http::async_read_header(stream_, buffer_, *parser_, [self = shared_from_this()](ErrorCode error, std::size_t) {
      if (error) return self->refuse(error);
      if (self->parser_->chunked()) return self->respond({411, "text/plain", "the length of the body is missing"});
      self->read_body();
    });
  }
  // True if the other side delays the connection, so that a newer one may replace it.
  bool waiting() const { return waiting_; }
  void close() { stream_.close(); }

 private:
  static constexpr std::size_t kBuffer = LocalServer::kHeaderBytes + LocalServer::kBodyBytes;

  void read_body() {
    http::async_read(stream_, buffer_, *parser_, [self = shared_from_this()](ErrorCode error, std::size_t) {
      if (error) return self->refuse(error);
      self->answer();
    });
  }

  void refuse(ErrorCode error) {
    const bool sent_wrong = error.category() == http::make_error_code(http::error::bad_method).category() &&
                            error != http::error::end_of_stream && error != http::error::partial_message;
    if (sent_wrong) return respond({status_of(error), "text/plain", "the request is not one: " + error.message()});
    stream_.close();  // gone, or too slow
  }

  void answer() {
    waiting_ = false;
    const auto& request = parser_->get();
    const auto header = [&](http::field name) { return std::string(request[name]); };
    HttpRequest asked{std::string(request.method_string()), std::string(request.target()), header(http::field::host),
                      header(http::field::origin), request.body()};
    asio::post(workers_, [self = shared_from_this(), asked = std::move(asked)] {
      HttpResponse response{500, "text/plain", "this failed"};
      try {
        response = self->answer_(asked);
      } catch (const std::exception& error) {
        response.body = error.what();
      }
      asio::post(self->stream_.get_executor(),
                 [self, response = std::move(response)]() mutable { self->respond(std::move(response)); });
    });
  }

  void respond(HttpResponse response) {
    waiting_ = false;
    response_ = {static_cast<http::status>(response.status), 11};
    response_.set(http::field::cache_control, "no-store");
    response_.set("X-Content-Type-Options", "nosniff");
    response_.set("Referrer-Policy", "no-referrer");
    response_.set("Cross-Origin-Resource-Policy", "same-origin");
    if (!response.policy.empty()) response_.set("Content-Security-Policy", response.policy);
    if (!response.type.empty()) response_.set(http::field::content_type, response.type);
    response_.body() = std::move(response.body);
    response_.keep_alive(false);
    response_.prepare_payload();
    stream_.expires_after(kResponseTime);
    http::async_write(stream_, response_, [self = shared_from_this()](ErrorCode error, std::size_t) {
      if (error) return self->stream_.close();
      self->stream_.socket().shutdown(tcp::socket::shutdown_send, error);
      self->stream_.expires_after(kFarewellTime);
      self->waiting_ = true;
      self->drop_rest();
    });
  }

  // A socket that is closed with unread bytes takes back what was sent.
  void drop_rest() {
    stream_.async_read_some(asio::buffer(dropped_), [self = shared_from_this()](ErrorCode error, std::size_t bytes) {
      self->unread_ += bytes;
      if (error || self->unread_ > kUnreadBytes) return self->stream_.close();
      self->drop_rest();
    });
  }

  beast::tcp_stream stream_;
  asio::thread_pool& workers_;
  const Answer& answer_;
  beast::flat_buffer buffer_;
  std::optional<http::request_parser<http::string_body>> parser_{std::in_place};
  http::response<http::string_body> response_;
  std::array<char, 4096> dropped_{};
  std::size_t unread_ = 0;
  bool waiting_ = true;
};

}  // namespace

struct LocalServer::Impl {
  std::chrono::milliseconds request_time;
  asio::io_context context{1};
  tcp::acceptor acceptor{context};
  asio::steady_timer pause{context};
  std::list<std::weak_ptr<Connection>> connections = {};  // oldest first

  void accept(asio::thread_pool& workers, const Answer& answer) {
    acceptor.async_accept([&](ErrorCode error, tcp::socket socket) {
      if (error == asio::error::operation_aborted) return;
      if (error) {  // no descriptors left, say
        pause.expires_after(std::chrono::milliseconds(100));
        pause.async_wait([&](ErrorCode) { accept(workers, answer); });
        return;
      }
      make_room();
      if (connections.size() < kConnections) {
        const auto connection = std::make_shared<Connection>(std::move(socket), workers, answer);
        connections.push_back(connection);
        connection->start(request_time);
      }
      accept(workers, answer);
    });
  }

  void make_room() {
    connections.remove_if([](const std::weak_ptr<Connection>& connection) { return connection.expired(); });
    if (connections.size() < kConnections) return;
    const auto slowest = std::ranges::find_if(connections, [](const std::weak_ptr<Connection>& each) {
      const auto connection = each.lock();
      return connection && connection->waiting();
    });
    if (slowest == connections.end()) return;
    if (const auto connection = slowest->lock()) connection->close();
    connections.erase(slowest);
  }
};

LocalServer::LocalServer(std::chrono::milliseconds request_time) : impl_(new Impl{request_time}) {
  ErrorCode error;
  const tcp::endpoint here(asio::ip::address_v4::loopback(), 0);
  auto& acceptor = impl_->acceptor;
  acceptor.open(here.protocol(), error);
  if (!error) acceptor.bind(here, error);
  if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
  if (error) throw Error(Errc::io, "no port of 127.0.0.1 is available for the page: " + error.message());
}

LocalServer::~LocalServer() = default;

std::uint16_t LocalServer::port() const { return impl_->acceptor.local_endpoint().port(); }

void LocalServer::serve(const std::function<HttpResponse(const HttpRequest&)>& answer, std::stop_token stop) {
  asio::thread_pool workers(kThreads);
  impl_->accept(workers, answer);
  const std::stop_callback stopped(stop, [&] { impl_->context.stop(); });
  impl_->context.run();
  workers.join();
}

}  // namespace vantage
