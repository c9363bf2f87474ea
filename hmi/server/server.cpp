#include "hmi/server/server.hpp"

#include <sys/resource.h>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/thread_pool.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <limits>
#include <thread>

#include "core/result.hpp"
#include "hmi/server/live_socket.hpp"
#include "hmi/server/origin.hpp"

namespace madori::hmi {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using tcp = asio::ip::tcp;
using Parser = http::request_parser<http::string_body>;

constexpr std::size_t kMostHeaderBytes = 16U << 10U;
constexpr const char* kPolicy =
    "default-src 'self'; img-src 'self' data: blob:; style-src 'self' 'unsafe-inline'; object-src 'none'; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

bool is_loopback(const std::string& host) {
  return host_allowed(host, true);
}

/// Half-open sockets of an attacker must not use up the descriptors that the sensors need.
void raise_descriptor_limit() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  limit.rlim_cur = limit.rlim_max;
  (void)::setrlimit(RLIMIT_NOFILE, &limit);
}

Request to_request(const http::request<http::string_body>& message) {
  Request request;
  request.method = std::string(message.method_string());
  for (const auto& field : message) {
    std::string name(field.name_string());
    for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    request.headers[name] = std::string(field.value());
  }
  return request;
}

http::response<http::string_body> to_message(Response response, unsigned version, bool keep_alive,
                                             bool head) {
  http::response<http::string_body> message{static_cast<http::status>(response.status), version};
  message.set(http::field::content_type, response.content_type);
  message.set("Content-Security-Policy", kPolicy);
  message.set("X-Content-Type-Options", "nosniff");
  message.set("Referrer-Policy", "no-referrer");
  message.set("Cross-Origin-Opener-Policy", "same-origin");
  message.set("Cross-Origin-Resource-Policy", "same-origin");
  message.set(http::field::cache_control, "no-store");
  for (const auto& [name, value] : response.headers) message.set(name, value);
  message.keep_alive(keep_alive);
  message.body() = std::move(response.body);
  message.prepare_payload();
  if (head) message.body().clear();
  return message;
}

}  // namespace

struct Server::Impl {
  Impl(const ServerOptions& o, Router r, Access& a, const StaticFiles& f, Vehicle& v)
      : options(o), router(std::move(r)), access(a), files(f), vehicle(v), loopback(is_loopback(o.host)) {}

  void listen();
  asio::awaitable<void> accept_connections();
  asio::awaitable<void> serve(tcp::socket socket);
  asio::awaitable<bool> serve_one(beast::tcp_stream& stream, beast::flat_buffer& buffer,
                                  const std::string& address);
  asio::awaitable<Response> answer(Request& request, Router::Match match);
  [[nodiscard]] Response refuse_by_header(Request& request, Router::Match& match);
  asio::awaitable<bool> read_body(beast::tcp_stream& stream, beast::flat_buffer& buffer, Parser& parser,
                                  bool upload);

  ServerOptions options;
  Router router;
  Access& access;
  const StaticFiles& files;
  Vehicle& vehicle;
  bool loopback;
  std::size_t connections = 0;
  asio::io_context io{1};
  asio::thread_pool workers{2};
  tcp::acceptor acceptor{io};
  std::thread thread;
};

void Server::Impl::listen() {
  raise_descriptor_limit();
  const std::string where = options.host + ":" + std::to_string(options.port);
  boost::system::error_code error;
  const auto address =
      asio::ip::make_address(options.host == "localhost" ? "127.0.0.1" : options.host, error);
  if (error)
    throw Error(where, "is no address of this machine", "give one like 127.0.0.1:8080 or 0.0.0.0:8080");
  const tcp::endpoint endpoint(address, options.port);
  acceptor.open(endpoint.protocol());
  acceptor.set_option(tcp::acceptor::reuse_address(true));
  acceptor.bind(endpoint, error);
  if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
  if (error)
    throw Error(where, "cannot be served: " + error.message(), "choose another port with --hmi HOST:PORT");
}

asio::awaitable<void> Server::Impl::accept_connections() {
  asio::steady_timer pause(io);
  while (true) {
    boost::system::error_code error;
    tcp::socket socket = co_await acceptor.async_accept(asio::redirect_error(asio::use_awaitable, error));
    if (error == asio::error::operation_aborted) co_return;
    if (error) {  // out of descriptors: give the others a moment to close
      pause.expires_after(std::chrono::milliseconds(100));
      co_await pause.async_wait(asio::redirect_error(asio::use_awaitable, error));
      continue;
    }
    if (connections >= options.most_connections) continue;
    asio::co_spawn(io, serve(std::move(socket)), asio::detached);
  }
}

asio::awaitable<void> Server::Impl::serve(tcp::socket socket) {
  struct Count {
    std::size_t& n;
    explicit Count(std::size_t& c) : n(c) { ++n; }
    ~Count() { --n; }
    Count(const Count&) = delete;
    Count& operator=(const Count&) = delete;
  } const count(connections);
  boost::system::error_code error;
  const auto peer = socket.remote_endpoint(error);
  socket.set_option(tcp::no_delay(true), error);
  beast::tcp_stream stream(std::move(socket));
  beast::flat_buffer buffer;
  try {
    while (co_await serve_one(stream, buffer, peer.address().to_string())) {
    }
  } catch (const std::exception&) {
    // The peer went away or was too slow; its socket closes with this scope.
  }
}

/// Everything that can be refused before a body is read. Status 0: go on.
Response Server::Impl::refuse_by_header(Request& request, Router::Match& match) {
  const std::string host = request.header("host");
  if (!host_allowed(host, loopback))
    return Response::error(421, "wrong-host", "this server has another name");
  const bool changes = request.method != "GET" && request.method != "HEAD";
  const bool live = request.path == "/api/live";
  if (!origin_allowed(request.header("origin"), host, changes || live))
    return Response::error(403, "wrong-origin", "the request comes from another page");
  if (live) {
    if (request.role < Role::Viewer) return Response::error(401, "no-session", "enter a PIN first");
    return {0, {}, {}, {}};
  }
  if (!request.path.starts_with("/api/")) {
    return changes ? Response::error(405, "not-allowed", "this page can only be read")
                   : Response{0, {}, {}, {}};
  }
  match = router.match(request);
  switch (match.refusal) {
    case 0:
      return {0, {}, {}, {}};
    case 401:
      return Response::error(401, "no-session", "enter a PIN first");
    case 403:
      return Response::error(403, "not-allowed", "this needs an operator's or integrator's PIN");
    case 405:
      return Response::error(405, "wrong-method", "this address does not take that method");
    default:
      return Response::error(404, "not-found", "there is no such address");
  }
}

asio::awaitable<bool> Server::Impl::read_body(beast::tcp_stream& stream, beast::flat_buffer& buffer,
                                              Parser& parser, bool upload) {
  const std::size_t most = upload ? options.most_upload_bytes : options.most_body_bytes;
  if (const auto length = parser.content_length(); length && *length > most) co_return false;
  parser.body_limit(most);
  stream.expires_after(upload ? std::chrono::seconds(120) : std::chrono::seconds(20));
  boost::system::error_code error;
  co_await http::async_read(stream, buffer, parser, asio::redirect_error(asio::use_awaitable, error));
  if (error == http::error::body_limit) co_return false;
  if (error) throw boost::system::system_error(error);
  co_return true;
}

asio::awaitable<Response> Server::Impl::answer(Request& request, Router::Match match) {
  if (match.handler == nullptr) co_return files.get(request);
  const auto guarded = [&]() -> Response {
    try {
      return (*match.handler)(request);
    } catch (const Error& e) {
      return Response::error(422, "refused", e.what());
    } catch (const std::exception& e) {
      return Response::error(500, "internal", e.what());
    }
  };
  if (!match.long_work) co_return guarded();
  const auto on_worker = [&]() -> asio::awaitable<Response> { co_return guarded(); };
  co_return co_await asio::co_spawn(workers, on_worker, asio::use_awaitable);
}

asio::awaitable<bool> Server::Impl::serve_one(beast::tcp_stream& stream, beast::flat_buffer& buffer,
                                              const std::string& address) {
  Parser parser;
  parser.header_limit(kMostHeaderBytes);
  parser.body_limit(std::numeric_limits<std::uint64_t>::max());  // 1.74 takes "none" for zero
  stream.expires_after(std::chrono::milliseconds(static_cast<long>(options.header_timeout_s * 1e3)));
  co_await http::async_read_header(stream, buffer, parser, asio::use_awaitable);

  Request request = to_request(parser.get());
  Router::Match match;
  Response response = Response::error(400, "bad-target", "the address is malformed");
  bool body_read = false;
  if (parse_target(std::string_view(parser.get().target().data(), parser.get().target().size()), request)) {
    request.headers["x-peer"] = address;
    request.role = access.role_of(request.cookie("madori_session"));
    response = refuse_by_header(request, match);
  }
  if (response.status == 0 && request.path == "/api/live") {
    if (!beast::websocket::is_upgrade(parser.get())) {
      response = Response::error(426, "websocket-only", "this address speaks WebSocket");
    } else {
      co_await serve_live(std::move(stream), parser.release(), request.role, vehicle, options.live_rate_hz);
      co_return false;
    }
  }
  if (response.status == 0) {
    body_read = co_await read_body(stream, buffer, parser, match.long_work);
    if (body_read) {
      request.body = std::move(parser.get().body());
      response = co_await answer(request, match);
    } else {
      response = Response::error(413, "too-large", "the file is too large for this server");
    }
  }
  // A refused request's body was not read: the connection cannot be used again.
  const bool keep = parser.get().keep_alive() && (body_read || parser.is_done());
  auto message = to_message(std::move(response), parser.get().version(), keep, request.method == "HEAD");
  stream.expires_after(std::chrono::seconds(60));
  co_await http::async_write(stream, message, asio::use_awaitable);
  co_return keep;
}

Server::Server(const ServerOptions& options, Router router, Access& access, const StaticFiles& files,
               Vehicle& vehicle)
    : impl_(std::make_unique<Impl>(options, std::move(router), access, files, vehicle)) {
  impl_->listen();
  asio::co_spawn(impl_->io, impl_->accept_connections(), asio::detached);
  impl_->thread = std::thread([this] { impl_->io.run(); });
}

Server::~Server() {
  (void)impl_->vehicle.jog({});
  impl_->io.stop();
  if (impl_->thread.joinable()) impl_->thread.join();
  impl_->workers.stop();
  impl_->workers.join();
}

std::uint16_t Server::port() const {
  return impl_->acceptor.local_endpoint().port();
}

}  // namespace madori::hmi
