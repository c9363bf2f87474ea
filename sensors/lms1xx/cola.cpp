#include "sensors/lms1xx/cola.hpp"

#include <algorithm>
#include <charconv>
#include <cstdio>

namespace madori::sensors::lms1xx {
namespace {

constexpr std::uint8_t kStx = 0x02;
constexpr std::uint8_t kEtx = 0x03;
constexpr std::size_t kHeaderB = 8;

using Span = std::span<const std::uint8_t>;

std::uint8_t xor_of(Span bytes) {
  std::uint8_t sum = 0;
  for (const std::uint8_t byte : bytes) sum = static_cast<std::uint8_t>(sum ^ byte);
  return sum;
}

void append(Bytes& out, std::string_view text) {
  out.insert(out.end(), text.begin(), text.end());
}

void append_text(Bytes& out, const Argument& argument) {
  char digits[16];
  const char* const format = argument.decimal ? " +%0*u" : " %0*X";
  append(out, {digits, static_cast<std::size_t>(std::snprintf(digits, sizeof digits, format,
                                                              argument.text_digits, argument.value))});
}

void append_binary(Bytes& out, const Argument& argument) {
  for (int i = argument.bytes - 1; i >= 0; --i)
    out.push_back(static_cast<std::uint8_t>((argument.value >> (8 * i)) & 0xFFU));
}

}  // namespace

Bytes frame(Dialect dialect, Span payload) {
  Bytes out;
  out.reserve(payload.size() + kHeaderB + 1);
  if (dialect == Dialect::A) {
    out.push_back(kStx);
    out.insert(out.end(), payload.begin(), payload.end());
    out.push_back(kEtx);
    return out;
  }
  out.assign(4, kStx);
  append_binary(out, {static_cast<std::uint32_t>(payload.size()), 4});
  out.insert(out.end(), payload.begin(), payload.end());
  out.push_back(xor_of(payload));
  return out;
}

void Splitter::push(Span bytes) {
  const auto done = static_cast<std::ptrdiff_t>(start_);
  buffer_.erase(buffer_.begin(), buffer_.begin() + done);
  sums_.erase(sums_.begin(), sums_.begin() + done);
  searched_ -= std::min(searched_, start_);
  start_ = 0;
  buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
  for (const std::uint8_t byte : bytes) sums_.push_back(static_cast<std::uint8_t>(sums_.back() ^ byte));
}

void Splitter::clear() {
  buffer_.clear();
  sums_.assign(1, 0);
  start_ = searched_ = 0;
}

void Splitter::skip(std::size_t count) {
  start_ += count;
  skipped_ += count;
}

std::optional<Span> Splitter::next() {
  return dialect_ == Dialect::A ? next_a() : next_b();
}

std::optional<Span> Splitter::next_a() {
  while (start_ < buffer_.size()) {
    const auto from = buffer_.begin() + static_cast<std::ptrdiff_t>(start_);
    const auto stx = std::find(from, buffer_.end(), kStx);
    skip(static_cast<std::size_t>(stx - from));
    if (stx == buffer_.end()) return std::nullopt;
    const auto unseen = buffer_.begin() + static_cast<std::ptrdiff_t>(std::max(start_ + 1, searched_));
    const auto end = std::find_if(unseen, buffer_.end(), [](auto c) { return c == kStx || c == kEtx; });
    const auto length = static_cast<std::size_t>(end - stx);
    searched_ = static_cast<std::size_t>(end - buffer_.begin());
    if (end == buffer_.end() && length <= kMaxPayload) return std::nullopt;
    if (end == buffer_.end() || *end == kStx || length > kMaxPayload) {
      ++damaged_;
      skip(length);
      continue;
    }
    const Span payload(buffer_.data() + start_ + 1, length - 1);
    start_ += length + 1;
    return payload;
  }
  return std::nullopt;
}

std::optional<Span> Splitter::next_b() {
  while (buffer_.size() - start_ >= kHeaderB) {
    const std::uint8_t* const at = buffer_.data() + start_;
    if (at[0] != kStx || at[1] != kStx || at[2] != kStx || at[3] != kStx) {
      skip(1);
      continue;
    }
    const std::size_t length = (std::size_t{at[4]} << 24U) | (std::size_t{at[5]} << 16U) |
                               (std::size_t{at[6]} << 8U) | std::size_t{at[7]};
    if (length == 0 || length > kMaxPayload) {
      ++damaged_;
      skip(1);
      continue;
    }
    if (buffer_.size() - start_ < kHeaderB + length + 1) return std::nullopt;
    const Span payload(at + kHeaderB, length);
    const std::size_t begin = start_ + kHeaderB;
    if ((sums_[begin] ^ sums_[begin + length]) != at[kHeaderB + length]) {
      ++damaged_;
      skip(1);
      continue;
    }
    start_ += kHeaderB + length + 1;
    return payload;
  }
  return std::nullopt;
}

Bytes encode(Dialect dialect, const Message& message) {
  Bytes payload;
  append(payload, message.kind);
  if (!message.name.empty()) append(payload, " " + message.name);
  if (dialect == Dialect::B && !message.name.empty() && !message.arguments.empty()) payload.push_back(' ');
  for (const Argument& argument : message.arguments) {
    if (dialect == Dialect::A)
      append_text(payload, argument);
    else
      append_binary(payload, argument);
  }
  return frame(dialect, payload);
}

std::optional<Head> head_of(Span payload) {
  const std::string_view text(reinterpret_cast<const char*>(payload.data()), payload.size());
  if (text.starts_with("sFA")) return Head{text.substr(0, 3), {}, payload.subspan(3)};
  if (text.size() < 5 || text[0] != 's' || text[3] != ' ') return std::nullopt;
  const std::size_t end = std::min(text.find(' ', 4), text.size());
  const std::string_view name = text.substr(4, end - 4);
  if (name.empty() || name.size() > 32) return std::nullopt;
  return Head{text.substr(0, 3), name, payload.subspan(std::min(end + 1, payload.size()))};
}

std::optional<std::uint32_t> first_argument(Dialect dialect, const Head& head, int bytes) {
  const auto count = static_cast<std::size_t>(bytes);
  std::uint32_t value = 0;
  if (dialect == Dialect::B) {
    if (head.rest.size() < count) return std::nullopt;
    for (std::size_t i = 0; i < count; ++i) value = (value << 8U) | head.rest[i];
    return value;
  }
  const char* const text = reinterpret_cast<const char*>(head.rest.data());
  const auto [end, error] = std::from_chars(text, text + head.rest.size(), value, 16);
  if (error != std::errc()) return std::nullopt;
  return value;
}

Message poll_message() {
  return {"sRN", "LMDscandata", {}};
}

std::vector<Message> start_dialogue(bool with_rssi, bool polled) {
  const Argument rssi{with_rssi ? 1U : 0U, 1};
  const Argument rssi_16_bit{with_rssi ? 0U : 1U, 1};
  const Argument off{0, 1};
  std::vector<Message> dialogue{{"sMN", "SetAccessMode", {{0x03, 1, false, 2}, {0xF4724744, 4}}},
                                {"sWN",
                                 "LMDscandatacfg",
                                 {{0x01, 1, false, 2},
                                  {0x00, 1, false, 2},
                                  rssi,
                                  rssi_16_bit,
                                  off,
                                  {0, 1, false, 2},
                                  {0, 1, false, 2},
                                  off,
                                  off,
                                  off,
                                  off,
                                  {1, 2, true}}},
                                {"sMN", "LMCstartmeas", {}},
                                {"sMN", "Run", {}}};
  if (!polled) dialogue.push_back({"sEN", "LMDscandata", {{1, 1}}});
  return dialogue;
}

}  // namespace madori::sensors::lms1xx
