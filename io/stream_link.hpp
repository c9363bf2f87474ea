#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "core/stamp.hpp"
#include "io/link.hpp"

namespace madori::io {

struct StreamOptions {
  Duration reopen_after = std::chrono::milliseconds(500);  ///< after a failure or loss
  Duration silence = std::chrono::seconds(2);  ///< nothing heard for so long: closed and opened again
  std::size_t max_pending_bytes =
      4096;  ///< unsent bytes; more are refused, since late commands are dangerous
};

/// A serial port or TCP connection that opens itself again, with a thread of its own. Start-up errors (no
/// such device, nobody listens) are reported by `closed` and tried again: a cable may be plugged in later.
class StreamLink {
 public:
  /// 8N1, no flow control. Throws Error on a baud rate of 0.
  [[nodiscard]] static std::unique_ptr<StreamLink> serial(const std::string& device, unsigned baud,
                                                          LinkEvents events, StreamOptions options = {});
  [[nodiscard]] static std::unique_ptr<StreamLink> tcp(const std::string& host, std::uint16_t port,
                                                       LinkEvents events, StreamOptions options = {});

  virtual ~StreamLink() = default;
  StreamLink(const StreamLink&) = delete;
  StreamLink& operator=(const StreamLink&) = delete;

  /// Begins to open and to call back; once.
  virtual void start() = 0;
  /// From any thread. False when the link is closed or too much is unsent: the bytes are thrown away.
  virtual bool write(std::span<const std::uint8_t> bytes) = 0;
  [[nodiscard]] virtual bool is_open() const = 0;
  /// Closes and opens again, with this reason.
  virtual void drop(const std::string& reason) = 0;

 protected:
  StreamLink() = default;
};

}  // namespace madori::io
