#pragma once

#include <memory>
#include <string>

namespace madori::test {

struct HttpAnswer {
  int status = 0;  ///< 0 where the server closed the connection without an answer
  std::string body;
  std::string cookie;
};

struct HttpCall {
  std::string method = "GET";
  std::string target = "/";
  std::string body;
  std::string host;    ///< empty: the right one
  std::string origin;  ///< empty: none; "same": the right one
  std::string cookie;
};

/// One request to 127.0.0.1 over a real socket.
[[nodiscard]] HttpAnswer http_call(unsigned short port, const HttpCall& call);
/// Raw bytes to the server; what it answers until it closes, at most for two seconds.
[[nodiscard]] std::string raw_call(unsigned short port, const std::string& bytes);

/// A WebSocket to /api/live.
class LiveClient {
 public:
  /// Throws std::runtime_error where the server refuses.
  LiveClient(unsigned short port, const std::string& origin, const std::string& cookie = "");
  ~LiveClient();
  LiveClient(const LiveClient&) = delete;
  LiveClient& operator=(const LiveClient&) = delete;

  void send(const std::string& text);
  /// The next text message.
  [[nodiscard]] std::string receive_text();
  /// The next binary message.
  [[nodiscard]] std::string receive_binary();
  /// Closes the socket without a word, as a crashed browser does.
  void drop();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace madori::test
