#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// SICK's CoLa protocol (Telegram Listing "Ranging sensors LMS1xx, LMS5xx ...", 8014631): frames and
/// messages.
namespace madori::sensors::lms1xx {

/// A: text between STX and ETX. B: 02 02 02 02, u32 big-endian length, payload, XOR of the payload.
enum class Dialect { A, B };

inline constexpr std::uint16_t kPortA = 2111;
inline constexpr std::uint16_t kPortB = 2112;
inline constexpr std::size_t kMaxPayload = 65'536;

using Bytes = std::vector<std::uint8_t>;

/// A payload on the wire.
[[nodiscard]] Bytes frame(Dialect dialect, std::span<const std::uint8_t> payload);

/// Cuts a TCP stream into payloads; finds its way back after noise, damaged lengths and checksums.
class Splitter {
 public:
  explicit Splitter(Dialect dialect) : dialect_(dialect) {}

  void push(std::span<const std::uint8_t> bytes);
  /// The next whole payload, valid until the next call of push() or next(); nothing until more bytes come.
  [[nodiscard]] std::optional<std::span<const std::uint8_t>> next();
  void clear();
  /// Frames with a wrong checksum or an impossible length.
  [[nodiscard]] std::uint64_t damaged() const { return damaged_; }
  [[nodiscard]] std::uint64_t skipped_bytes() const { return skipped_; }

 private:
  std::optional<std::span<const std::uint8_t>> next_a();
  std::optional<std::span<const std::uint8_t>> next_b();
  void skip(std::size_t count);

  Dialect dialect_;
  Bytes buffer_;
  Bytes sums_{0};  ///< XOR of all that came before each byte: a frame's check costs the same at any length
  std::size_t start_ = 0;
  std::size_t searched_ = 0;  ///< text: no mark lies between the frame's begin and here
  std::uint64_t damaged_ = 0;
  std::uint64_t skipped_ = 0;
};

/// A number among a message's arguments. Text: hexadecimal, or "+1" where the listing wants a decimal.
/// Binary: big-endian in `bytes` bytes.
struct Argument {
  std::uint32_t value = 0;
  int bytes = 1;
  bool decimal = false;
  int text_digits = 0;  ///< least digits in text
};

/// `sMN SetAccessMode 03 F4724744` and the like.
struct Message {
  std::string kind;  ///< sRN, sRA, sWN, sWA, sMN, sAN, sEN, sEA, sSN, sFA
  std::string name;  ///< empty of sFA, which has a code alone (two bytes)
  std::vector<Argument> arguments;
};

[[nodiscard]] Bytes encode(Dialect dialect, const Message& message);

/// Kind and name of a payload, e.g. "sSN" and "LMDscandata", and the bytes behind them. A refusal has no
/// name: "sFA 5" in text, in binary the code follows at once.
struct Head {
  std::string_view kind;
  std::string_view name;
  std::span<const std::uint8_t> rest;
};
/// Nothing when the payload begins with no CoLa word pair.
[[nodiscard]] std::optional<Head> head_of(std::span<const std::uint8_t> payload);

/// The first argument of an answer: `sAN Run 1` gives 1. Nothing when it has none.
[[nodiscard]] std::optional<std::uint32_t> first_argument(Dialect dialect, const Head& head, int bytes = 1);

/// Asks for the newest scan, once.
[[nodiscard]] Message poll_message();
/// What a PC sends so that scans flow, in order; `polled`: so that they can be asked for one by one.
[[nodiscard]] std::vector<Message> start_dialogue(bool with_rssi, bool polled = false);

}  // namespace madori::sensors::lms1xx
