#include "hmi/server/exchange.hpp"

#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <chrono>
#include <limits>

#include "core/failure_words.hpp"
#include "core/result.hpp"
#include "hmi/server/body.hpp"
#include "hmi/server/live_socket.hpp"

namespace madori::hmi {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using tcp = asio::ip::tcp;

constexpr std::size_t kMostHeaderBytes = 16U << 10U;
constexpr std::size_t kMostReadAhead = 64U << 10U;

asio::awaitable<Response> answer(ServerParts& parts, Request& request, const Gate::Passage& passage) {
  if (passage.way == Gate::Passage::Way::Page) co_return parts.files.get(request);
  const auto guarded = [&]() -> Response {
    try {
      return (*passage.match.handler)(request);
    } catch (const Error& e) {
      return Response::error(422, "refused", e.what());
    } catch (const std::exception& e) {
      return Response::error(500, "internal", failure_words(e));
    }
  };
  if (passage.match.work == Work::Quick) co_return guarded();
  co_return co_await parts.on_worker(guarded);
}

asio::awaitable<void> serve_live_socket(ServerParts& parts, beast::tcp_stream& stream, RequestParser& parser,
                                        const std::string& token) {
  Response refusal;
  if (!beast::websocket::is_upgrade(parser.get()))
    refusal = Response::error(426, "websocket-only", "this address speaks WebSocket");
  else if (parts.live_sockets >= parts.options.most_live_sockets)
    refusal = Response::error(503, "too-many-panels", "too many panels are open: close some");
  else
    refusal.status = 0;
  if (refusal.status != 0) {
    co_await write_answer(parts, stream, std::move(refusal), parser.get(), false);
    co_return;
  }
  const Counted count(parts.live_sockets);
  // Named: GCC 12 destroys a temporary lambda of a co_await twice.
  RoleNow role = [&access = parts.access, token] { return access.role_of(token); };
  co_await serve_live(std::move(stream), parser.release(), std::move(role), parts.vehicle, parts.feed,
                      parts.options.live_rate_hz);
}

/// True where the connection can be used again.
asio::awaitable<bool> serve_one(ServerParts& parts, beast::tcp_stream& stream, beast::flat_buffer& buffer,
                                const std::string& address) {
  RequestParser parser;
  parser.header_limit(kMostHeaderBytes);
  parser.body_limit(std::numeric_limits<std::uint64_t>::max());  // 1.74 takes "none" for zero
  stream.expires_after(std::chrono::milliseconds(static_cast<long>(parts.options.header_timeout_s * 1e3)));
  co_await http::async_read_header(stream, buffer, parser, asio::use_awaitable);

  Request request = to_request(parser.get());
  request.headers["x-peer"] = address;
  request.role = parts.access.role_of(request.cookie("madori_session"));
  const auto target = parser.get().target();
  Gate::Passage passage = parts.gate.pass({target.data(), target.size()}, request);
  if (passage.way == Gate::Passage::Way::Live) {
    const std::string token = request.cookie("madori_session");
    co_await serve_live_socket(parts, stream, parser, token);
    co_return false;
  }
  Response response = std::move(passage.refusal);
  bool body_read = false;
  if (passage.way != Gate::Passage::Way::Refused) {
    response = co_await read_body(parts, stream, buffer, parser, passage.match.work, request.role);
    body_read = response.status == 0;
    if (body_read) {
      request.body = std::move(parser.get().body());
      response = co_await answer(parts, request, passage);
    }
  }
  // A refused request's body was not read: the connection cannot be used again.
  const bool keep = parser.get().keep_alive() && (body_read || parser.is_done());
  co_await write_answer(parts, stream, std::move(response), parser.get(), keep);
  co_return keep;
}

}  // namespace

asio::awaitable<void> serve_connection(ServerParts& parts, tcp::socket socket) {
  const Counted count(parts.connections);
  boost::system::error_code error;
  const auto peer = socket.remote_endpoint(error);
  socket.set_option(tcp::no_delay(true), error);
  beast::tcp_stream stream(std::move(socket));
  beast::flat_buffer buffer(kMostHeaderBytes + kMostReadAhead);
  try {
    while (co_await serve_one(parts, stream, buffer, peer.address().to_string())) {
    }
  } catch (const std::exception&) {
    // The peer went away or was too slow; its socket closes with this scope.
  }
}

}  // namespace madori::hmi
