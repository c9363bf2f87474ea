#include "hmi/server/server.hpp"

#include <sys/resource.h>

#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/steady_timer.hpp>
#include <thread>

#include "core/result.hpp"
#include "core/thread_role.hpp"
#include "hmi/server/exchange.hpp"
#include "hmi/server/origin.hpp"
#include "hmi/server/server_parts.hpp"

namespace madori::hmi {
namespace {

namespace asio = boost::asio;
using tcp = asio::ip::tcp;

/// Half-open sockets of an attacker must not use up the descriptors that the sensors need.
void raise_descriptor_limit() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  limit.rlim_cur = limit.rlim_max;
  (void)::setrlimit(RLIMIT_NOFILE, &limit);
}

}  // namespace

struct Server::Impl {
  Impl(const ServerOptions& options, ApiContext& context, const StaticFiles& files)
      : parts(options, context, files, host_allowed(options.host, true), workers) {}

  void listen();
  asio::awaitable<void> accept_connections();
  asio::awaitable<void> keep_feed();

  ServerParts parts;
  asio::io_context io{1};
  static constexpr std::size_t kWorkers = 2;
  asio::thread_pool workers{kWorkers};  ///< ends before `io`: what waits in it holds connections of that
  tcp::acceptor acceptor{io};
  std::thread thread;
};

void Server::Impl::listen() {
  raise_descriptor_limit();
  const auto& options = parts.options;
  const std::string where = options.host + ":" + std::to_string(options.port);
  const Error not_here(where, "is no address of this machine",
                       "give one like 127.0.0.1:8080 or 0.0.0.0:8080");
  boost::system::error_code error;
  const auto address =
      asio::ip::make_address(options.host == "localhost" ? "127.0.0.1" : options.host, error);
  if (error) throw not_here;
  const tcp::endpoint endpoint(address, options.port);
  acceptor.open(endpoint.protocol());
  acceptor.set_option(tcp::acceptor::reuse_address(true));
  acceptor.bind(endpoint, error);
  if (error == boost::system::errc::address_not_available) throw not_here;
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
    if (parts.connections >= parts.options.most_connections) continue;
    asio::co_spawn(io, serve_connection(parts, std::move(socket)), asio::detached);
  }
}

/// Works the state out while no panel looks on, so that the replay has no gaps.
asio::awaitable<void> Server::Impl::keep_feed() {
  asio::steady_timer timer(io);
  boost::system::error_code error;
  while (!error) {
    parts.feed.refresh(std::chrono::steady_clock::now());
    timer.expires_after(Replay::kPeriod);
    co_await timer.async_wait(asio::redirect_error(asio::use_awaitable, error));
  }
}

Server::Server(const ServerOptions& options, ApiContext& context, const StaticFiles& files)
    : impl_(std::make_unique<Impl>(options, context, files)) {
  impl_->listen();
  asio::co_spawn(impl_->io, impl_->accept_connections(), asio::detached);
  asio::co_spawn(impl_->io, impl_->keep_feed(), asio::detached);
  impl_->thread = std::thread([this] {
    (void)take_role("panel", ThreadRole::Behind);
    impl_->io.run();
  });
}

Server::~Server() {
  impl_->io.stop();  // the sockets let their buttons go as they end
  if (impl_->thread.joinable()) impl_->thread.join();
  impl_->workers.stop();
  impl_->workers.join();
}

std::uint16_t Server::port() const {
  return impl_->acceptor.local_endpoint().port();
}

}  // namespace madori::hmi
