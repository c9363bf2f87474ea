#pragma once

// Includes Asio: only server.cpp and exchange.cpp may see this header.
#include <boost/asio/awaitable.hpp>
#include <boost/asio/ip/tcp.hpp>

#include "hmi/server/server_parts.hpp"

namespace madori::hmi {

/// Serves the requests of one connection, one after the other, until it closes, is too slow, or becomes a
/// live socket that ends.
[[nodiscard]] boost::asio::awaitable<void> serve_connection(ServerParts& parts,
                                                            boost::asio::ip::tcp::socket socket);

}  // namespace madori::hmi
