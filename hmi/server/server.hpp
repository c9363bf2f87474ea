#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "hmi/server/api.hpp"
#include "hmi/server/static_files.hpp"

namespace madori::hmi {

struct ServerOptions {
  std::string host = "127.0.0.1";
  std::uint16_t port = 8080;  ///< 0 takes a free one
  std::size_t most_connections = 1500;
  std::size_t most_body_bytes = 4U << 20U;
  std::size_t most_upload_bytes = 256U << 20U;  ///< of a drawing, integrators only
  double header_timeout_s = 5.0;                ///< half-open connections are dropped after it
  double live_rate_hz = 10.0;
  std::size_t most_live_sockets = 32;  ///< each costs a stream of scans
};

/// HTTP and WebSocket on one port, in threads of its own: nothing here can hold up the autonomy cycle.
/// Wrong hosts and origins are refused, so that a foreign page in the same browser commands nothing.
class Server {
 public:
  /// Binds at once; throws Error when the address is taken. The references must outlive the server.
  Server(const ServerOptions& options, ApiContext& context, const StaticFiles& files);
  /// Stops a jog that is held, closes every connection and joins the threads.
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  [[nodiscard]] std::uint16_t port() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace madori::hmi
