#pragma once

// Includes Asio: only server.cpp, exchange.cpp and body.cpp may see this header.
#include <boost/asio/awaitable.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/thread_pool.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <cstddef>
#include <utility>

#include "core/thread_role.hpp"
#include "hmi/server/gate.hpp"
#include "hmi/server/live_feed.hpp"
#include "hmi/server/server.hpp"

namespace madori::hmi {

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

/// What all connections share. Only the sockets' thread may use it; slow work goes to the workers.
struct ServerParts {
  ServerParts(const ServerOptions& o, ApiContext& c, const StaticFiles& f, bool loopback_only,
              boost::asio::thread_pool& pool)
      : options(o),
        access(c.access),
        files(f),
        vehicle(c.vehicle),
        router(make_router(c)),
        gate(router, loopback_only),
        feed(c.vehicle, c.editor, c.replay),
        workers(pool) {}

  /// What `work` returns, once a worker has done it.
  template <class Work>
  auto on_worker(Work work) -> boost::asio::awaitable<decltype(work())> {
    const auto behind = [work]() -> boost::asio::awaitable<decltype(work())> {
      thread_local const bool lowered = take_role("panel worker", ThreadRole::Behind);
      (void)lowered;
      co_return work();
    };
    co_return co_await boost::asio::co_spawn(workers, behind, boost::asio::use_awaitable);
  }

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
  boost::asio::thread_pool& workers;
};

}  // namespace madori::hmi
