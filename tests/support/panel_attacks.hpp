#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace madori::test {

/// Sockets to the panel's server that are opened and then neglected.
class NeglectedSockets {
 public:
  /// Connects `count` times to 127.0.0.1 and sends `bytes` on each.
  NeglectedSockets(unsigned short port, std::size_t count, const std::string& bytes);
  ~NeglectedSockets();
  NeglectedSockets(const NeglectedSockets&) = delete;
  NeglectedSockets& operator=(const NeglectedSockets&) = delete;

  /// One more byte on every socket that is still open, as slow-loris does; how many took it.
  std::size_t drip(char byte);
  /// How many the server has not closed.
  [[nodiscard]] std::size_t open() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// What came of an upload that never ends.
struct UploadOutcome {
  std::size_t sent_bytes = 0;
  std::string answer;  ///< first line
};
/// POSTs `bytes` of a drawing, announced or chunked, until the server answers or closes. `cookie`: a session.
[[nodiscard]] UploadOutcome upload_for_ever(unsigned short port, std::size_t bytes, bool chunked,
                                            const std::string& cookie = "");

/// Opens a WebSocket to /api/live and sends `bytes` as they are. True where the server closed it within two
/// seconds.
[[nodiscard]] bool closes_on_frames(unsigned short port, const std::string& bytes,
                                    const std::string& cookie = "");

/// Frames that RFC 6455 forbids or that no panel sends.
[[nodiscard]] std::vector<std::string> bad_frames();

/// Bodies that are no order.
[[nodiscard]] std::vector<std::string> bad_orders();

/// Paths that try to leave the page's folder.
[[nodiscard]] std::vector<std::string> climbing_paths();

}  // namespace madori::test
