// SPDX-License-Identifier: Apache-2.0
#include "edit/server.hpp"

#include <httplib.h>

#include <array>
#include <memory>
#include <random>
#include <thread>

#include "edit/edit_files.hpp"
#include "report/page.hpp"
#include "report/page_files.hpp"
#include "vantage/error.hpp"
#include "vantage/version.hpp"

namespace vantage {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

constexpr std::size_t kMostBytes = 4096;  // of a request's body: a change is some numbers

std::string random_token() {
  std::random_device device;  // the system's own, not a generator with a seed
  std::string token;
  for (int k = 0; k < 32; ++k) token += "0123456789abcdef"[device() & 15];
  return token;
}

std::string text_of(const ordered_json& value) {
  return value.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

void refuse(httplib::Response& response, int status, const std::string& why) {
  response.status = status;
  response.set_content(text_of({{"error", why}}), "application/json");
}

}  // namespace

void serve_editor(EditSession& session, const std::string& title, const std::function<void(const std::string&)>& ready,
                  std::stop_token stop) {
  const std::array scripts{page_three, page_orbit, page_unpack, page_site_view, page_tables, page_edit_js};
  const std::array styles{page_report_css, page_edit_css};
  const std::string page =
      make_page(page_edit_html, styles, scripts, title,
                {{"title", title}, {"version", version()}, {"view", session.site()}, {"state", session.state()}});

  httplib::Server server;
  const int port = server.bind_to_any_port("127.0.0.1");
  if (port <= 0) throw Error(Errc::io, "no port of 127.0.0.1 can be had to serve the page");
  const std::string token = random_token(), root = "/" + token + "/";
  const std::string host = "127.0.0.1:" + std::to_string(port), origin = "http://" + host;
  server.set_payload_max_length(kMostBytes);
  server.set_keep_alive_timeout(2);  // an idle tab holds nothing up
  server.set_read_timeout(5);
  server.new_task_queue = [] { return new httplib::ThreadPool(4); };
  server.set_default_headers({{"Cache-Control", "no-store"},
                              {"X-Content-Type-Options", "nosniff"},
                              {"Referrer-Policy", "no-referrer"},
                              {"Content-Security-Policy",
                               "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; "
                               "img-src data: blob:; connect-src 'self'; base-uri 'none'; form-action 'none'; "
                               "frame-ancestors 'none'"}});
  using Handled = httplib::Server::HandlerResponse;
  server.set_pre_routing_handler([&](const httplib::Request& request, httplib::Response& response) {
    const std::string from = request.get_header_value("Origin");
    const bool changes = request.method != "GET" && request.method != "HEAD";
    if (request.get_header_value("Host") != host)
      refuse(response, 403, "this page is served to " + host + " alone");
    else if ((changes || !from.empty()) && from != origin)
      refuse(response, 403, "this page takes nothing from other pages");
    else if (!request.path.starts_with(root))
      refuse(response, 404, "there is nothing here");
    else
      return Handled::Unhandled;
    return Handled::Handled;
  });
  server.Get(root, [&](const httplib::Request&, httplib::Response& response) {
    response.set_content(page, "text/html; charset=utf-8");
  });
  server.Get(root + "state", [&](const httplib::Request& request, httplib::Response& response) {
    if (request.get_param_value("version") == std::to_string(session.version())) {
      response.status = 204;
      return;
    }
    response.set_content(text_of(session.state()), "application/json");
  });
  server.Post(root + "change", [&](const httplib::Request& request, httplib::Response& response) {
    const json change = json::parse(request.body, nullptr, false);
    if (change.is_discarded()) return refuse(response, 400, "the request is no JSON");
    std::string refused;
    try {
      session.change(change);
    } catch (const Error& error) {
      refused = error.what();  // no error of the request: the page tells it, and shows what there is
    }
    ordered_json state = session.state();
    if (!refused.empty()) state["refused"] = refused;
    response.set_content(text_of(state), "application/json");
  });
  // The listener begins before a stop can come, or the stop would be lost.
  std::jthread listener([&] { server.listen_after_bind(); });
  while (!server.is_running()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  const std::stop_callback stopped(stop, [&] { server.stop(); });
  ready(origin + root);
  listener.join();
}

}  // namespace vantage
