#pragma once

// Includes Beast: only server.cpp and http_message.cpp may see this header.
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>

#include "hmi/server/http.hpp"

namespace madori::hmi {

using HttpRequest = boost::beast::http::request<boost::beast::http::string_body>;
using HttpResponse = boost::beast::http::response<boost::beast::http::string_body>;

/// Method and headers; the target and the body are taken later.
[[nodiscard]] Request to_request(const HttpRequest& message);

/// With the security headers that every answer has. A body in parts is announced as chunked; `head` leaves
/// the body out.
[[nodiscard]] HttpResponse to_message(Response response, unsigned version, bool keep_alive, bool head);

}  // namespace madori::hmi
