#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "core/stamp.hpp"

namespace madori::io {

/// Receives UDP packets on one port, with a thread of its own that calls `packet`.
class UdpReceiver {
 public:
  using Packet = std::function<void(std::span<const std::uint8_t> bytes, Stamp received)>;
  /// `address`: the network interface to listen on, 0.0.0.0 for all. Port 0 takes a free one.
  /// Throws Error when the port is taken or the address is none.
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
