#pragma once

// Includes Beast: only server.cpp and live_socket.cpp may see this header.
#include <boost/asio/awaitable.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>
#include <functional>

#include "hmi/server/http.hpp"
#include "hmi/server/live_feed.hpp"
#include "hmi/server/vehicle.hpp"

namespace madori::hmi {

using RoleNow = std::function<Role()>;

/// /api/live: sends the feed's message (JSON) and, when it is new, the scan (binary) at `rate_hz`; a browser
/// that cannot keep up gets fewer frames, never old ones. Takes LiveCommand of hmi/schema; jogs only from
/// operators. A jog ends when no message came for 250 ms, and at once when the socket closes. `role` is what
/// the session may do now: the socket closes when that has ended.
boost::asio::awaitable<void> serve_live(boost::beast::tcp_stream stream,
                                        boost::beast::http::request<boost::beast::http::string_body> upgrade,
                                        RoleNow role, Vehicle& vehicle, LiveFeed& feed, double rate_hz);

}  // namespace madori::hmi
