#include "tests/support/panel_attacks.hpp"

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

namespace madori::test {
namespace {

constexpr int kPatience_ms = 2000;

class Socket {
 public:
  explicit Socket(unsigned short port) : handle_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    ::inet_pton(AF_INET, "127.0.0.1", &address.sin_addr);
    if (handle_ < 0 || ::connect(handle_, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0)
      throw std::runtime_error("cannot connect to the server");
  }
  ~Socket() {
    if (handle_ >= 0) ::close(handle_);
  }
  Socket(Socket&& other) noexcept : handle_(std::exchange(other.handle_, -1)) {}
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;
  Socket& operator=(Socket&&) = delete;

  bool send(const std::string& bytes) const {
    std::size_t sent = 0;
    while (sent < bytes.size()) {
      const auto n = ::send(handle_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
      if (n <= 0) return false;
      sent += static_cast<std::size_t>(n);
    }
    return true;
  }
  [[nodiscard]] bool readable(int wait_ms) const {
    pollfd poll{handle_, POLLIN, 0};
    return ::poll(&poll, 1, wait_ms) > 0;
  }
  /// Empty at the end of the stream, or when nothing came in time.
  [[nodiscard]] std::string receive(int wait_ms) const {
    std::array<char, 65536> part{};
    if (!readable(wait_ms)) return {};
    const auto n = ::recv(handle_, part.data(), part.size(), 0);
    return n > 0 ? std::string(part.data(), static_cast<std::size_t>(n)) : std::string();
  }
  /// The peer has closed: there is something to read, and it is the end.
  [[nodiscard]] bool closed() const {
    char byte = 0;
    return readable(0) && ::recv(handle_, &byte, 1, MSG_PEEK | MSG_DONTWAIT) <= 0;
  }

 private:
  int handle_;
};

std::string head(unsigned short port, const std::string& request_line, const std::string& more) {
  const std::string host = "127.0.0.1:" + std::to_string(port);
  return request_line + " HTTP/1.1\r\nHost: " + host + "\r\nOrigin: http://" + host + "\r\n" + more + "\r\n";
}

std::string session_of(const std::string& cookie) {
  return cookie.empty() ? std::string() : "Cookie: madori_session=" + cookie + "\r\n";
}

/// A client's frame: first byte, payload, masked with zeros.
std::string masked(char first, const std::string& payload) {
  std::string frame{first};
  if (payload.size() < 126) {
    frame += static_cast<char>(0x80U | payload.size());
  } else {
    frame += static_cast<char>(0xFEU);
    frame += static_cast<char>(payload.size() >> 8U);
    frame += static_cast<char>(payload.size() & 0xFFU);
  }
  return frame + std::string(4, '\0') + payload;
}

}  // namespace

struct NeglectedSockets::Impl {
  std::vector<Socket> sockets;
};

NeglectedSockets::NeglectedSockets(unsigned short port, std::size_t count, const std::string& bytes)
    : impl_(std::make_unique<Impl>()) {
  for (std::size_t i = 0; i < count; ++i) {
    impl_->sockets.emplace_back(port);
    (void)impl_->sockets.back().send(bytes);
  }
}
NeglectedSockets::~NeglectedSockets() = default;

std::size_t NeglectedSockets::drip(char byte) {
  return static_cast<std::size_t>(std::ranges::count_if(
      impl_->sockets, [byte](const Socket& s) { return !s.closed() && s.send(std::string(1, byte)); }));
}

std::size_t NeglectedSockets::open() const {
  return static_cast<std::size_t>(
      std::ranges::count_if(impl_->sockets, [](const Socket& s) { return !s.closed(); }));
}

UploadOutcome upload_for_ever(unsigned short port, std::size_t bytes, bool chunked,
                              const std::string& cookie) {
  const Socket socket(port);
  const std::string how =
      session_of(cookie) +
      (chunked ? "Transfer-Encoding: chunked\r\n" : "Content-Length: " + std::to_string(bytes) + "\r\n");
  UploadOutcome outcome;
  (void)socket.send(head(port, "POST /api/site/drawing?name=hall.png", how));
  const std::string part(1U << 16U, 'x');
  while (outcome.sent_bytes < bytes && !socket.readable(0)) {
    if (chunked && !socket.send("10000\r\n")) break;
    if (!socket.send(part)) break;
    if (chunked && !socket.send("\r\n")) break;
    outcome.sent_bytes += part.size();
  }
  const std::string answer = socket.receive(kPatience_ms);
  outcome.answer = answer.substr(0, answer.find('\r'));
  return outcome;
}

bool closes_on_frames(unsigned short port, const std::string& bytes, const std::string& cookie) {
  const Socket socket(port);
  (void)socket.send(head(port, "GET /api/live",
                         session_of(cookie) +
                             "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
                             "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"));
  if (!socket.receive(kPatience_ms).starts_with("HTTP/1.1 101")) return false;
  (void)socket.send(bytes);
  for (int i = 0; i < 1000; ++i)  // what the server sends meanwhile is live state
    if (socket.receive(kPatience_ms).empty()) return socket.closed();
  return false;
}

std::vector<std::string> bad_frames() {
  std::string endless = masked('\x01', "a");  // a text that is never finished
  for (int i = 0; i < 200; ++i) endless += masked('\x00', std::string(60, 'a'));
  return {
      std::string("\x81\x02hi", 4),                                 // not masked
      masked('\xF1', "{}"),                                         // reserved bits
      masked('\x83', "{}"),                                         // an unknown kind
      std::string("\x81\xFF\x7F\xFF\xFF\xFF\xFF\xFF\xFF\xFF", 10),  // 2^63 bytes are to come
      masked('\x81', std::string(5000, 'x')),                       // longer than any command
      masked('\x81', "\xC3\x28\xA0\xA1"),                           // no UTF-8
      masked('\x09', "ping"),                                       // a control frame in pieces
      endless,
      std::string(3000, '\xFF'),
  };
}

std::vector<std::string> bad_orders() {
  return {"",
          "{",
          "null",
          "[]",
          "{\"stations\":[1e999]}",
          "{\"stations\":[1],\"repeat\":99999999999999999999}",
          "\xff\xfe",
          std::string(100'000, '[')};
}

std::vector<std::string> climbing_paths() {
  return {"/../pins",
          "/../../../../etc/passwd",
          "/%2e%2e/pins",
          "/%2e%2e%2f%2e%2e%2fetc%2fpasswd",
          "/..%5c..%5cpins",
          "/assets/../../pins",
          "//etc/passwd",
          "/./pins",
          "/%00/pins",
          "/pins%00.html",
          "/api/recordings/..%2f..%2fpins",
          "/api/recordings/%2e%2e",
          "/api/site/tiles/..%2f..%2f1/2/pins",
          "/api/site/tiles/1/2/..%2fsource.json",
          "/api/site/routes/..%2fpins",
          "file:///etc/passwd",
          "http://127.0.0.1/../pins"};
}

}  // namespace madori::test
