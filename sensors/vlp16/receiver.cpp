#include "sensors/vlp16/receiver.hpp"

#include "core/clock.hpp"

namespace madori::sensors::vlp16 {

Receiver::Receiver(const ReceiverOptions& options, FrameSink sink, Tap tap)
    : tap_(std::move(tap)), assembler_(std::move(sink), options.assembler) {
  // Only the data thread touches the assembler; what others may ask for is copied under the lock.
  const auto on_data = [this](std::span<const std::uint8_t> bytes, Stamp received, const io::Sender& sender) {
    if (!admits(sender, received)) return;
    // Before the revolution that it completes: who collects both never has a revolution without its packets.
    if (tap_ && bytes.size() == kDataBytes) tap_(bytes, received);
    const PushVerdict verdict = assembler_.push(bytes, received);
    const std::lock_guard lock(mutex_);
    counters_ = assembler_.counters();
    foreign_sensor_ = assembler_.foreign_sensor();
    rotor_stands_ = assembler_.rotor_stands();
    if (verdict == PushVerdict::Refused) refused_at_ = received;
    if (verdict != PushVerdict::Taken) return;
    pin_.good(sender, received);
    heard_ = received;
  };
  const auto on_position = [this](std::span<const std::uint8_t> bytes, Stamp, const io::Sender& sender) {
    const auto position = decode_position(bytes);
    const std::lock_guard lock(mutex_);
    if (position && pin_.is_host(sender)) position_ = position;
  };
  position_receiver_ = std::make_unique<io::UdpReceiver>(options.address, options.position_port, on_position);
  data_ = std::make_unique<io::UdpReceiver>(options.address, options.data_port, on_data);
}

/// A new sender's packets have nothing to do with those before.
bool Receiver::admits(const io::Sender& sender, Stamp received) {
  SourcePin::Verdict verdict;
  {
    const std::lock_guard lock(mutex_);
    verdict = pin_.judge(sender, received);
  }
  if (verdict.fresh) assembler_.begin_anew();
  return verdict.admitted;
}

std::string Receiver::stranger() const {
  const std::lock_guard lock(mutex_);
  const auto other = pin_.stranger(clock_now());
  return other ? other->text() : "";
}

bool Receiver::hears_others() const {
  const std::lock_guard lock(mutex_);
  return clock_now() - refused_at_ < std::chrono::seconds(1);
}

AssemblerCounters Receiver::counters() const {
  const std::lock_guard lock(mutex_);
  return counters_;
}

std::string Receiver::foreign_sensor() const {
  const std::lock_guard lock(mutex_);
  return foreign_sensor_;
}

bool Receiver::rotor_stands() const {
  const std::lock_guard lock(mutex_);
  return rotor_stands_;
}

std::optional<PositionPacket> Receiver::position() const {
  const std::lock_guard lock(mutex_);
  return position_;
}

Duration Receiver::silence() const {
  const std::lock_guard lock(mutex_);
  return clock_now() - heard_;
}

}  // namespace madori::sensors::vlp16
