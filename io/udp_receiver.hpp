#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "core/stamp.hpp"

namespace madori::io {

/// Where a packet came from.
struct Sender {
  std::array<std::uint8_t, 16> address{};  ///< IPv6, or IPv4 mapped into it
  std::uint16_t port = 0;

  /// "192.168.1.201:2368"
  [[nodiscard]] std::string text() const;
  friend bool operator==(const Sender&, const Sender&) = default;
};

/// Receives UDP packets on one port, with a thread of its own that calls `packet`.
class UdpReceiver {
 public:
  using Packet =
      std::function<void(std::span<const std::uint8_t> bytes, Stamp received, const Sender& sender)>;
  /// `address`: the network interface to listen on, 0.0.0.0 for all. Port 0 takes a free one.
  /// Throws Error when the address is invalid, or another program listens there: one program a device.
  UdpReceiver(const std::string& address, std::uint16_t port, Packet packet);
  ~UdpReceiver();
  UdpReceiver(const UdpReceiver&) = delete;
  UdpReceiver& operator=(const UdpReceiver&) = delete;

  [[nodiscard]] std::uint16_t port() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace madori::io
