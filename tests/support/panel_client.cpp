#include "tests/support/panel_client.hpp"

#include <boost/asio/connect.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>

namespace madori::test {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using tcp = asio::ip::tcp;

std::string host_of(unsigned short port) {
  return "127.0.0.1:" + std::to_string(port);
}
tcp::endpoint endpoint_of(unsigned short port) {
  return {asio::ip::make_address("127.0.0.1"), port};
}

}  // namespace

HttpAnswer http_call(unsigned short port, const HttpCall& call) {
  asio::io_context io;
  beast::tcp_stream stream(io);
  stream.connect(endpoint_of(port));
  http::request<http::string_body> request(http::string_to_verb(call.method), call.target, 11);
  request.set(http::field::host, call.host.empty() ? host_of(port) : call.host);
  if (!call.origin.empty())
    request.set(http::field::origin, call.origin == "same" ? "http://" + host_of(port) : call.origin);
  if (!call.cookie.empty()) request.set(http::field::cookie, "madori_session=" + call.cookie);
  request.body() = call.body;
  request.prepare_payload();
  beast::error_code error;
  http::write(stream, request, error);  // the server may answer and close before it has read all
  beast::flat_buffer buffer;
  http::response_parser<http::string_body> parser;
  parser.body_limit(1U << 30U);
  http::read(stream, buffer, parser, error);
  if (error && !parser.is_header_done()) return {};
  HttpAnswer answer{static_cast<int>(parser.get().result_int()), parser.get().body(), ""};
  const std::string cookie(parser.get()[http::field::set_cookie]);
  const std::size_t start = cookie.find('=');
  if (start != std::string::npos) answer.cookie = cookie.substr(start + 1, cookie.find(';') - start - 1);
  return answer;
}

std::string raw_call(unsigned short port, const std::string& bytes) {
  asio::io_context io;
  beast::tcp_stream stream(io);
  stream.connect(endpoint_of(port));
  beast::error_code error;
  asio::write(stream.socket(), asio::buffer(bytes), error);
  stream.socket().shutdown(tcp::socket::shutdown_send, error);
  std::string all;
  std::array<char, 4096> part{};
  while (!error) {
    const std::size_t n = stream.socket().read_some(asio::buffer(part), error);
    all.append(part.data(), n);
  }
  return all;
}

struct LiveClient::Impl {
  asio::io_context io;
  websocket::stream<tcp::socket> socket{io};
  beast::flat_buffer buffer;

  std::string receive(bool text) {
    while (true) {
      buffer.consume(buffer.size());
      socket.read(buffer);
      if (socket.got_text() == text) return beast::buffers_to_string(buffer.data());
    }
  }
};

LiveClient::LiveClient(unsigned short port, const std::string& origin, const std::string& cookie)
    : impl_(std::make_unique<Impl>()) {
  impl_->socket.next_layer().connect(endpoint_of(port));
  impl_->socket.set_option(websocket::stream_base::decorator([&](websocket::request_type& request) {
    if (!origin.empty())
      request.set(http::field::origin, origin == "same" ? "http://" + host_of(port) : origin);
    if (!cookie.empty()) request.set(http::field::cookie, "madori_session=" + cookie);
  }));
  impl_->socket.handshake(host_of(port), "/api/live");
}
LiveClient::~LiveClient() = default;
void LiveClient::send(const std::string& text) {
  impl_->socket.write(asio::buffer(text));
}
std::string LiveClient::receive_text() {
  return impl_->receive(true);
}
std::string LiveClient::receive_binary() {
  return impl_->receive(false);
}
void LiveClient::drop() {
  impl_->socket.next_layer().close();
}

}  // namespace madori::test
