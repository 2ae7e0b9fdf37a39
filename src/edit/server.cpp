// SPDX-License-Identifier: Apache-2.0
#include "edit/server.hpp"

#include <array>
#include <random>
#include <utility>

#include "core/json_text.hpp"
#include "edit/edit_files.hpp"
#include "edit/local_server.hpp"
#include "report/page.hpp"
#include "report/page_files.hpp"
#include "vantage/error.hpp"
#include "vantage/version.hpp"

namespace vantage {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

std::string random_token() {
  std::random_device device;  // the system's own, not a seeded generator
  std::string token;
  for (int k = 0; k < 32; ++k) token += "0123456789abcdef"[device() & 15];
  return token;
}

std::string text_of(const ordered_json& value) { return json_text(value); }

HttpResponse json_response(const ordered_json& value, int status = 200) {
  return {status, "application/json", text_of(value)};
}
HttpResponse refused(int status, const std::string& why) { return json_response({{"error", why}}, status); }

HttpResponse changed(EditSession& session, const std::string& body) {
  const json change = json::parse(body, nullptr, false);
  if (change.is_discarded()) return refused(400, "the request is no JSON");
  std::string why;
  try {
    session.change(change);
  } catch (const Error& error) {
    why = error.what();  // no error of the request: the page shows the reason
  }
  ordered_json state = session.state();
  if (!why.empty()) state["refused"] = why;
  return json_response(state);
}

}  // namespace

void serve_editor(EditSession& session, const std::string& title, const std::function<void(const std::string&)>& ready,
                  std::stop_token stop) {
  const std::array scripts{page_three, page_orbit, page_unpack, page_site_view, page_tables, page_edit_js};
  const std::array styles{page_report_css, page_edit_css};
  const std::string page =
      make_page(page_edit_html, styles, scripts, title,
                {{"title", title}, {"version", version()}, {"view", session.site()}, {"state", session.state()}});
  const std::string policy = page_policy(styles, scripts) + "; connect-src 'self'; frame-ancestors 'none'";

  LocalServer server;
  const std::string root = "/" + random_token() + "/", host = "127.0.0.1:" + std::to_string(server.port()),
                    origin = "http://" + host;
  const auto answer = [&](const HttpRequest& request) -> HttpResponse {
    const bool get = request.method == "GET", post = request.method == "POST";
    if (request.host != host) return refused(403, "this page is served to " + host + " alone");
    if ((!get || !request.origin.empty()) && request.origin != origin)
      return refused(403, "requests from other pages are refused");
    if (!request.target.starts_with(root)) return refused(404, "there is nothing here");
    const std::string what = request.target.substr(root.size());
    if (get && what.empty()) return {200, "text/html; charset=utf-8", page, policy};
    if (get && what == "state?version=" + std::to_string(session.version())) return {204, "", ""};
    if (get && (what == "state" || what.starts_with("state?"))) return json_response(session.state());
    if (post && what == "change") return changed(session, request.body);
    return refused(404, "there is nothing here");
  };
  ready(origin + root);
  server.serve(answer, std::move(stop));
}

}  // namespace vantage
