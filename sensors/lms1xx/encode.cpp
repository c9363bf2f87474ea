#include "sensors/lms1xx/encode.hpp"

#include <algorithm>
#include <bit>
#include <charconv>

namespace madori::sensors::lms1xx {
namespace {

class BinaryWriter {
 public:
  explicit BinaryWriter(Bytes& out) : out_(out) {}
  template <class Unsigned>
  void number(Unsigned value) {
    for (int shift = 8 * (static_cast<int>(sizeof value) - 1); shift >= 0; shift -= 8)
      out_.push_back(static_cast<std::uint8_t>((value >> shift) & 0xFFU));
  }
  void name(const std::array<char, 5>& text) { out_.insert(out_.end(), text.begin(), text.end()); }

 private:
  Bytes& out_;
};

class TextWriter {
 public:
  explicit TextWriter(Bytes& out) : out_(out) {}
  template <class Unsigned>
  void number(Unsigned value) {
    if (!first_) out_.push_back(' ');
    first_ = false;
    char digits[8] = {};
    char* const end =
        std::to_chars(digits, digits + sizeof digits, static_cast<std::uint32_t>(value), 16).ptr;
    for (const char* c = digits; c != end; ++c)
      out_.push_back(static_cast<std::uint8_t>(*c >= 'a' ? *c - 'a' + 'A' : *c));
  }
  void name(const std::array<char, 5>& text) {
    out_.push_back(' ');
    out_.insert(out_.end(), text.begin(), text.end());
  }

 private:
  Bytes& out_;
  bool first_ = true;
};

template <class Writer, class Value>
void write_channels(Writer& out, const std::vector<Channel<Value>>& channels) {
  out.number(static_cast<std::uint16_t>(channels.size()));
  for (const Channel<Value>& channel : channels) {
    out.name(channel.name);
    out.number(std::bit_cast<std::uint32_t>(channel.scale));
    out.number(std::bit_cast<std::uint32_t>(channel.offset));
    out.number(static_cast<std::uint32_t>(channel.start_angle));
    out.number(channel.angle_step);
    out.number(static_cast<std::uint16_t>(channel.values.size()));
    for (const Value value : channel.values) out.number(value);
  }
}

template <class Writer>
void write_scan(Writer out, const ScanData& data) {
  out.number(data.version);
  out.number(data.device);
  out.number(data.serial);
  for (const auto byte : data.status) out.number(byte);
  out.number(data.telegram_counter);
  out.number(data.scan_counter);
  out.number(data.scan_time_us);
  out.number(data.transmit_time_us);
  for (const auto byte : data.inputs) out.number(byte);
  for (const auto byte : data.outputs) out.number(byte);
  out.number(data.layer);
  out.number(data.scan_frequency);
  out.number(data.measurement_frequency);
  out.number(static_cast<std::uint16_t>(data.encoders.size()));
  for (const EncoderReading& encoder : data.encoders) {
    out.number(encoder.position);
    out.number(encoder.speed);
  }
  write_channels(out, data.channels16);
  write_channels(out, data.channels8);
  for (int part = 0; part < 5; ++part) out.number(std::uint16_t{0});  // position, name, comment, time, event
}

}  // namespace

Bytes encode(Dialect dialect, const ScanData& data) {
  constexpr std::string_view kHead = "sSN LMDscandata ";
  Bytes payload(kHead.begin(), kHead.end());
  if (dialect == Dialect::B)
    write_scan(BinaryWriter(payload), data);
  else
    write_scan(TextWriter(payload), data);
  return frame(dialect, payload);
}

Bytes as_answer(Dialect dialect, std::span<const std::uint8_t> telegram) {
  constexpr std::string_view kAnswer = "sRA";
  Splitter splitter(dialect);
  splitter.push(telegram);
  const auto payload = splitter.next();
  if (!payload || payload->size() < kAnswer.size()) return {};
  Bytes answer(payload->begin(), payload->end());
  std::copy(kAnswer.begin(), kAnswer.end(), answer.begin());
  return frame(dialect, answer);
}

}  // namespace madori::sensors::lms1xx
