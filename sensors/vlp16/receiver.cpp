#include "sensors/vlp16/receiver.hpp"

namespace madori::sensors::vlp16 {

Receiver::Receiver(const ReceiverOptions& options, FrameSink sink, io::UdpReceiver::Packet tap)
    : tap_(std::move(tap)), assembler_(std::move(sink), options.assembler) {
  // Only the data thread touches the assembler; what others may ask for is copied under the lock.
  const auto on_data = [this](std::span<const std::uint8_t> bytes, Stamp received) {
    if (tap_) tap_(bytes, received);
    const PushVerdict verdict = assembler_.push(bytes, received);
    const std::lock_guard lock(mutex_);
    counters_ = assembler_.counters();
    if (foreign_sensor_.empty()) foreign_sensor_ = assembler_.foreign_sensor();
    if (verdict == PushVerdict::Taken) heard_ = std::chrono::steady_clock::now();
  };
  const auto on_position = [this](std::span<const std::uint8_t> bytes, Stamp) {
    const auto position = decode_position(bytes);
    const std::lock_guard lock(mutex_);
    if (position) position_ = position;
  };
  position_receiver_ = std::make_unique<io::UdpReceiver>(options.address, options.position_port, on_position);
  data_ = std::make_unique<io::UdpReceiver>(options.address, options.data_port, on_data);
}

AssemblerCounters Receiver::counters() const {
  const std::lock_guard lock(mutex_);
  return counters_;
}

std::string Receiver::foreign_sensor() const {
  const std::lock_guard lock(mutex_);
  return foreign_sensor_;
}

std::optional<PositionPacket> Receiver::position() const {
  const std::lock_guard lock(mutex_);
  return position_;
}

Duration Receiver::silence() const {
  const std::lock_guard lock(mutex_);
  return std::chrono::steady_clock::now() - heard_;
}

}  // namespace madori::sensors::vlp16
