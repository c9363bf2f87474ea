#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "io/udp_receiver.hpp"
#include "sensors/source_pin.hpp"
#include "sensors/vlp16/assembler.hpp"

namespace madori::sensors::vlp16 {

struct ReceiverOptions {
  std::string address = "0.0.0.0";  ///< network interface to listen on
  std::uint16_t data_port = kDataPort;
  std::uint16_t position_port = kPositionPort;
  AssemblerOptions assembler = {};
};

/// A VLP-16 on the network: the first sender of good data packets (SourcePin).
class Receiver {
 public:
  using Tap = std::function<void(std::span<const std::uint8_t> bytes, Stamp received)>;
  /// `sink` is called from the receiver's thread for every revolution; `tap`, where given, for every packet
  /// of this sender that has a data packet's length (recordings). Throws Error when a port is taken.
  Receiver(const ReceiverOptions& options, FrameSink sink, Tap tap = {});

  [[nodiscard]] AssemblerCounters counters() const;
  [[nodiscard]] std::string foreign_sensor() const;
  /// Who else sends to the data port, HOST:PORT, and is not listened to; empty where nobody does.
  [[nodiscard]] std::string stranger() const;
  [[nodiscard]] std::optional<PositionPacket> position() const;
  /// Since the last data packet that was taken; a large number before the first.
  [[nodiscard]] Duration silence() const;
  /// Packets come to the data port that are no VLP-16's.
  [[nodiscard]] bool hears_others() const;
  /// Good packets come, but no revolution.
  [[nodiscard]] bool rotor_stands() const;
  [[nodiscard]] std::uint16_t data_port() const { return data_->port(); }
  [[nodiscard]] std::uint16_t position_port() const { return position_receiver_->port(); }

 private:
  bool admits(const io::Sender& sender, Stamp received);

  mutable std::mutex mutex_;
  Tap tap_;
  SourcePin pin_;
  Assembler assembler_;
  AssemblerCounters counters_;
  std::string foreign_sensor_;
  bool rotor_stands_ = false;
  std::optional<PositionPacket> position_;
  Stamp heard_{};
  Stamp refused_at_{};  ///< the last packet that was of another length or make
  std::unique_ptr<io::UdpReceiver> data_, position_receiver_;  ///< last: their threads use all of the above
};

}  // namespace madori::sensors::vlp16
