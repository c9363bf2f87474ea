#pragma once

// Includes Beast: only exchange.cpp and body.cpp may see this header.
#include <boost/asio/awaitable.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/string_body.hpp>

#include "hmi/server/http_message.hpp"
#include "hmi/server/server_parts.hpp"

namespace madori::hmi {

using RequestParser = boost::beast::http::request_parser<boost::beast::http::string_body>;

/// Reads the body of a request whose head has been read, as far as `role` may send one. Status 0: it is
/// there; else the refusal, and the body was not read to its end. Throws where the peer goes away or is too
/// slow.
[[nodiscard]] boost::asio::awaitable<Response> read_body(ServerParts& parts, boost::beast::tcp_stream& stream,
                                                         boost::beast::flat_buffer& buffer,
                                                         RequestParser& parser, Work work, Role role);

/// Sends an answer, whole or in parts. Throws where the peer goes away or is too slow.
[[nodiscard]] boost::asio::awaitable<void> write_answer(ServerParts& parts, boost::beast::tcp_stream& stream,
                                                        Response response, const HttpRequest& request,
                                                        bool keep);

}  // namespace madori::hmi
