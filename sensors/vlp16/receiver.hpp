#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "io/udp_receiver.hpp"
#include "sensors/vlp16/assembler.hpp"

namespace madori::sensors::vlp16 {

struct ReceiverOptions {
  std::string address = "0.0.0.0";  ///< network interface to listen on
  std::uint16_t data_port = kDataPort;
  std::uint16_t position_port = kPositionPort;
  AssemblerOptions assembler = {};
};

/// A VLP-16 on the network.
class Receiver {
 public:
  /// `sink` is called from the receiver's thread for every revolution; `tap`, where given, for every data
  /// packet (recordings). Throws Error when a port is taken.
  Receiver(const ReceiverOptions& options, FrameSink sink, io::UdpReceiver::Packet tap = {});

  [[nodiscard]] AssemblerCounters counters() const;
  [[nodiscard]] std::string foreign_sensor() const;
  [[nodiscard]] std::optional<PositionPacket> position() const;
  /// Since the last data packet that was taken; a large number before the first.
  [[nodiscard]] Duration silence() const;
  [[nodiscard]] std::uint16_t data_port() const { return data_->port(); }
  [[nodiscard]] std::uint16_t position_port() const { return position_receiver_->port(); }

 private:
  mutable std::mutex mutex_;
  io::UdpReceiver::Packet tap_;
  Assembler assembler_;
  AssemblerCounters counters_;
  std::string foreign_sensor_;
  std::optional<PositionPacket> position_;
  std::chrono::steady_clock::time_point heard_{};
  std::unique_ptr<io::UdpReceiver> data_, position_receiver_;  ///< last: their threads use all of the above
};

}  // namespace madori::sensors::vlp16
