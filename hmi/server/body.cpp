#include "hmi/server/body.hpp"

#include <boost/asio/redirect_error.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/http.hpp>
#include <chrono>
#include <functional>
#include <optional>

#include "hmi/server/wire.hpp"

namespace madori::hmi {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;

constexpr std::size_t kMostStrangerBytes = 4096;  ///< of a body, without a session: a PIN

asio::awaitable<void> write_parts(ServerParts& parts, beast::tcp_stream& stream,
                                  const std::function<std::string()>& next) {
  while (true) {
    const std::string part = co_await parts.on_worker([&next] { return next(); });
    stream.expires_after(std::chrono::seconds(60));
    if (part.empty()) break;
    co_await asio::async_write(stream, http::make_chunk(asio::buffer(part)), asio::use_awaitable);
  }
  co_await asio::async_write(stream, http::make_chunk_last(), asio::use_awaitable);
}

/// Before a drawing's bytes are taken; status 0 where it may come.
Response may_upload(const ServerParts& parts) {
  if (parts.uploads > 0) return Response::error(409, "busy", "another file is being sent");
  const Reply may = parts.vehicle.may_change_site();
  if (!may.accepted) return Response::json(dump({{"error", to_wire(may.reason)}}), 409);
  Response yes;
  yes.status = 0;
  return yes;
}

}  // namespace

asio::awaitable<Response> read_body(ServerParts& parts, beast::tcp_stream& stream, beast::flat_buffer& buffer,
                                    RequestParser& parser, Work work, Role role) {
  const bool upload = work == Work::Upload;
  Response read;
  read.status = 0;
  if (upload) read = may_upload(parts);
  if (read.status != 0) co_return read;
  std::optional<Counted> count;
  if (upload) count.emplace(parts.uploads);
  const std::size_t most = role == Role::None ? kMostStrangerBytes
                           : upload           ? parts.options.most_upload_bytes
                                              : parts.options.most_body_bytes;
  const Response too_large = Response::error(413, "too-large", "the file is too large for this server");
  if (const auto length = parser.content_length(); length && *length > most) co_return too_large;
  parser.body_limit(most);
  stream.expires_after(upload ? std::chrono::seconds(120) : std::chrono::seconds(20));
  boost::system::error_code error;
  co_await http::async_read(stream, buffer, parser, asio::redirect_error(asio::use_awaitable, error));
  if (error == http::error::body_limit) co_return too_large;
  if (error) throw boost::system::system_error(error);
  co_return read;
}

asio::awaitable<void> write_answer(ServerParts& parts, beast::tcp_stream& stream, Response response,
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
  if (!head) co_await write_parts(parts, stream, next_part);
}

}  // namespace madori::hmi
