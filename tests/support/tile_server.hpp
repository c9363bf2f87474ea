#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <string>
#include <thread>

namespace madori::test {

/// What the server answers; every field can be a lie.
struct TileReply {
  int status = 200;
  std::string type = "image/png";
  std::string body{};
  std::string location{};              ///< of a redirect
  std::size_t declared = 0;            ///< Content-Length; 0: the truth
  std::chrono::milliseconds pause{0};  ///< in the middle of the body
};

/// An HTTP server on 127.0.0.1, an ephemeral port, one request after the other, that misbehaves as told.
class TileServer {
 public:
  using Answer = std::function<TileReply(const std::string& path)>;

  explicit TileServer(Answer answer)
      : answer_(std::move(answer)), listener_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    auto* plain = reinterpret_cast<sockaddr*>(&address);
    if (::bind(listener_, plain, size) != 0 || ::listen(listener_, 16) != 0) std::abort();
    ::getsockname(listener_, plain, &size);
    port_ = ntohs(address.sin_port);
    thread_ = std::thread([this] { serve(); });
  }
  ~TileServer() {
    stop_ = true;
    thread_.join();
    ::close(listener_);
  }
  TileServer(const TileServer&) = delete;
  TileServer& operator=(const TileServer&) = delete;

  [[nodiscard]] std::string url() const {
    return "http://127.0.0.1:" + std::to_string(port_) + "/{z}/{x}/{y}.png";
  }
  [[nodiscard]] int requests() const { return requests_; }

 private:
  void serve() {
    while (!stop_) {
      pollfd ready{listener_, POLLIN, 0};
      if (::poll(&ready, 1, 10) <= 0) continue;
      const int client = ::accept(listener_, nullptr, nullptr);
      if (client < 0) continue;
      talk(client);
      ::close(client);
    }
  }
  void talk(int client) {
    std::string request;
    char buffer[4096];
    while (request.find("\r\n\r\n") == std::string::npos) {
      const ssize_t count = ::recv(client, buffer, sizeof buffer, 0);
      if (count <= 0) return;
      request.append(buffer, static_cast<std::size_t>(count));
    }
    const std::size_t start = request.find(' ') + 1;
    const TileReply reply = answer_(request.substr(start, request.find(' ', start) - start));
    ++requests_;
    std::string head = "HTTP/1.1 " + std::to_string(reply.status) +
                       " x\r\nConnection: close\r\nContent-Type: " + reply.type + "\r\n";
    if (!reply.location.empty()) head += "Location: " + reply.location + "\r\n";
    const std::size_t declared = reply.declared == 0 ? reply.body.size() : reply.declared;
    head += "Content-Length: " + std::to_string(declared) + "\r\n\r\n";
    const std::size_t half = reply.body.size() / 2;
    if (!send_all(client, head + reply.body.substr(0, half))) return;
    const auto end = std::chrono::steady_clock::now() + reply.pause;
    while (!stop_ && std::chrono::steady_clock::now() < end) {
      char byte = 0;
      if (::recv(client, &byte, 1, MSG_PEEK | MSG_DONTWAIT) == 0) return;  // the client gave up
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    send_all(client, reply.body.substr(half));
  }
  static bool send_all(int client, const std::string& text) {
    std::size_t sent = 0;
    while (sent < text.size()) {
      const ssize_t count = ::send(client, text.data() + sent, text.size() - sent, MSG_NOSIGNAL);
      if (count <= 0) return false;
      sent += static_cast<std::size_t>(count);
    }
    return true;
  }

  Answer answer_;
  int listener_;
  int port_ = 0;
  std::atomic<bool> stop_{false};
  std::atomic<int> requests_{0};
  std::thread thread_;
};

}  // namespace madori::test
