#include "hmi/server/server.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/thread_pool.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <limits>
#include <optional>
#include <thread>

#include "core/result.hpp"
#include "hmi/server/gate.hpp"
#include "hmi/server/http_message.hpp"
#include "hmi/server/live_feed.hpp"
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
constexpr std::size_t kMostReadAhead = 64U << 10U;
constexpr std::size_t kMostStrangerBytes = 4096;  ///< of a body, without a session: a PIN
constexpr std::size_t kWorkers = 2;

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

/// One more of something, as long as it lives.
class Counted {
 public:
  explicit Counted(std::size_t& count) : count_(count) { ++count_; }
  ~Counted() { --count_; }
  Counted(const Counted&) = delete;
  Counted& operator=(const Counted&) = delete;

 private:
  std::size_t& count_;
};

/// On Linux nice values belong to threads.
bool run_behind_the_cycle() {
  constexpr int kNice = 5;
  return ::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), kNice) == 0;
}

}  // namespace

struct Server::Impl {
  Impl(const ServerOptions& o, ApiContext& c, const StaticFiles& f)
      : options(o),
        access(c.access),
        files(f),
        vehicle(c.vehicle),
        router(make_router(c)),
        gate(router, is_loopback(o.host)),
        feed(c.vehicle, c.editor, c.replay) {}

  void listen();
  void run();
  asio::awaitable<void> accept_connections();
  asio::awaitable<void> keep_feed();
  asio::awaitable<void> serve(tcp::socket socket);
  asio::awaitable<bool> serve_one(beast::tcp_stream& stream, beast::flat_buffer& buffer,
                                  const std::string& address);
  asio::awaitable<void> serve_live_socket(beast::tcp_stream& stream, Parser& parser, Role role);
  asio::awaitable<Response> answer(Request& request, const Gate::Passage& passage);
  asio::awaitable<Response> read_body(beast::tcp_stream& stream, beast::flat_buffer& buffer, Parser& parser,
                                      Work work, Role role);
  asio::awaitable<void> write(beast::tcp_stream& stream, Response response, const HttpRequest& request,
                              bool keep);
  asio::awaitable<void> write_parts(beast::tcp_stream& stream, const std::function<std::string()>& next);

  ServerOptions options;
  Access& access;
  const StaticFiles& files;
  Vehicle& vehicle;
  Router router;
  Gate gate;
  LiveFeed feed;
  std::size_t connections = 0;
  std::size_t live_sockets = 0;
  std::size_t uploads = 0;
  asio::io_context io{1};
  asio::thread_pool workers{kWorkers};
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
  const Counted count(connections);
  boost::system::error_code error;
  const auto peer = socket.remote_endpoint(error);
  socket.set_option(tcp::no_delay(true), error);
  beast::tcp_stream stream(std::move(socket));
  beast::flat_buffer buffer(kMostHeaderBytes + kMostReadAhead);
  try {
    while (co_await serve_one(stream, buffer, peer.address().to_string())) {
    }
  } catch (const std::exception&) {
    // The peer went away or was too slow; its socket closes with this scope.
  }
}

/// Works the state out while no panel looks on, so that the replay has no gaps.
asio::awaitable<void> Server::Impl::keep_feed() {
  asio::steady_timer timer(io);
  boost::system::error_code error;
  while (!error) {
    feed.refresh(std::chrono::steady_clock::now());
    timer.expires_after(Replay::kPeriod);
    co_await timer.async_wait(asio::redirect_error(asio::use_awaitable, error));
  }
}

/// Status 0: the body has been read.
asio::awaitable<Response> Server::Impl::read_body(beast::tcp_stream& stream, beast::flat_buffer& buffer,
                                                  Parser& parser, Work work, Role role) {
  const bool upload = work == Work::Upload;
  if (upload && uploads > 0) co_return Response::error(409, "busy", "another file is being sent");
  std::optional<Counted> count;
  if (upload) count.emplace(uploads);
  const std::size_t most = role == Role::None ? kMostStrangerBytes
                           : upload           ? options.most_upload_bytes
                                              : options.most_body_bytes;
  const Response too_large = Response::error(413, "too-large", "the file is too large for this server");
  if (const auto length = parser.content_length(); length && *length > most) co_return too_large;
  parser.body_limit(most);
  stream.expires_after(upload ? std::chrono::seconds(120) : std::chrono::seconds(20));
  boost::system::error_code error;
  co_await http::async_read(stream, buffer, parser, asio::redirect_error(asio::use_awaitable, error));
  if (error == http::error::body_limit) co_return too_large;
  if (error) throw boost::system::system_error(error);
  Response read;
  read.status = 0;
  co_return read;
}

asio::awaitable<Response> Server::Impl::answer(Request& request, const Gate::Passage& passage) {
  if (passage.way == Gate::Passage::Way::Page) co_return files.get(request);
  const auto guarded = [&]() -> Response {
    try {
      return (*passage.match.handler)(request);
    } catch (const Error& e) {
      return Response::error(422, "refused", e.what());
    } catch (const std::exception& e) {
      return Response::error(500, "internal", e.what());
    }
  };
  if (passage.match.work == Work::Quick) co_return guarded();
  const auto on_worker = [&]() -> asio::awaitable<Response> {
    thread_local const bool behind = run_behind_the_cycle();
    (void)behind;
    co_return guarded();
  };
  co_return co_await asio::co_spawn(workers, on_worker, asio::use_awaitable);
}

asio::awaitable<void> Server::Impl::write_parts(beast::tcp_stream& stream,
                                                const std::function<std::string()>& next) {
  const auto on_worker = [&]() -> asio::awaitable<std::string> { co_return next(); };
  while (true) {
    const std::string part = co_await asio::co_spawn(workers, on_worker, asio::use_awaitable);
    stream.expires_after(std::chrono::seconds(60));
    if (part.empty()) break;
    co_await asio::async_write(stream, http::make_chunk(asio::buffer(part)), asio::use_awaitable);
  }
  co_await asio::async_write(stream, http::make_chunk_last(), asio::use_awaitable);
}

asio::awaitable<void> Server::Impl::write(beast::tcp_stream& stream, Response response,
                                          const HttpRequest& request, bool keep) {
  const bool head = request.method() == http::verb::head;
  const auto next_part = response.next_part;
  auto message = to_message(std::move(response), request.version(), keep, head);
  stream.expires_after(std::chrono::seconds(60));
  if (!next_part) {
    co_await http::async_write(stream, message, asio::use_awaitable);
    co_return;
  }
  http::response_serializer<http::string_body> serializer(message);
  co_await http::async_write_header(stream, serializer, asio::use_awaitable);
  if (!head) co_await write_parts(stream, next_part);
}

asio::awaitable<void> Server::Impl::serve_live_socket(beast::tcp_stream& stream, Parser& parser, Role role) {
  Response refusal;
  if (!beast::websocket::is_upgrade(parser.get()))
    refusal = Response::error(426, "websocket-only", "this address speaks WebSocket");
  else if (live_sockets >= options.most_live_sockets)
    refusal = Response::error(503, "too-many-panels", "too many panels are open: close some");
  else
    refusal.status = 0;
  if (refusal.status != 0) {
    co_await write(stream, std::move(refusal), parser.get(), false);
    co_return;
  }
  const Counted count(live_sockets);
  co_await serve_live(std::move(stream), parser.release(), role, vehicle, feed, options.live_rate_hz);
}

asio::awaitable<bool> Server::Impl::serve_one(beast::tcp_stream& stream, beast::flat_buffer& buffer,
                                              const std::string& address) {
  Parser parser;
  parser.header_limit(kMostHeaderBytes);
  parser.body_limit(std::numeric_limits<std::uint64_t>::max());  // 1.74 takes "none" for zero
  stream.expires_after(std::chrono::milliseconds(static_cast<long>(options.header_timeout_s * 1e3)));
  co_await http::async_read_header(stream, buffer, parser, asio::use_awaitable);

  Request request = to_request(parser.get());
  request.headers["x-peer"] = address;
  request.role = access.role_of(request.cookie("madori_session"));
  const auto target = parser.get().target();
  Gate::Passage passage = gate.pass({target.data(), target.size()}, request);
  if (passage.way == Gate::Passage::Way::Live) {
    co_await serve_live_socket(stream, parser, request.role);
    co_return false;
  }
  Response response = std::move(passage.refusal);
  bool body_read = false;
  if (passage.way != Gate::Passage::Way::Refused) {
    response = co_await read_body(stream, buffer, parser, passage.match.work, request.role);
    body_read = response.status == 0;
    if (body_read) {
      request.body = std::move(parser.get().body());
      response = co_await answer(request, passage);
    }
  }
  // A refused request's body was not read: the connection cannot be used again.
  const bool keep = parser.get().keep_alive() && (body_read || parser.is_done());
  co_await write(stream, std::move(response), parser.get(), keep);
  co_return keep;
}

/// The vehicle's cycle comes first, whatever a browser asks for.
void Server::Impl::run() {
  (void)run_behind_the_cycle();
  io.run();
}

Server::Server(const ServerOptions& options, ApiContext& context, const StaticFiles& files)
    : impl_(std::make_unique<Impl>(options, context, files)) {
  impl_->listen();
  asio::co_spawn(impl_->io, impl_->accept_connections(), asio::detached);
  asio::co_spawn(impl_->io, impl_->keep_feed(), asio::detached);
  impl_->thread = std::thread([this] { impl_->run(); });
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
