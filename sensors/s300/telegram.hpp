#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/laser_scan.hpp"

/// The continuous telegram of a SICK S300 safety scanner (Telegram Listing S3000 Expert / S300 Expert,
/// IM0022891).
namespace madori::sensors::s300 {

/// How the telegram states its own size, which depends on the version and on the configuration.
enum class Variant {
  V0201,            ///< from byte 4 to the end with CRC
  V0301,            ///< no I/O and no fields configured: from byte 8 with CRC
  V0301WithFields,  ///< from byte 12 without CRC
};

enum class Content : std::uint16_t { InputsOutputs = 0xAAAA, Distances = 0xBBBB, Reflectors = 0xCCCC };

struct Telegram {
  Variant variant = Variant::V0301;
  std::uint8_t device_address = 0x07;  ///< 07, or 08 for a slave
  std::uint16_t status = 0;            ///< 0x0100: lock-out
  std::uint32_t scan_number = 0;
  std::uint16_t telegram_number = 0;
  Content content = Content::Distances;
  std::uint16_t field = 0x1111;  ///< measurement field 0x1111 ... 0x5555; none with InputsOutputs
  std::vector<std::uint16_t> values;

  friend bool operator==(const Telegram&, const Telegram&) = default;
};

inline constexpr std::uint16_t kDistanceMask = 0x1FFF;  ///< centimetres
inline constexpr std::uint16_t kReflector = 0x2000;     ///< or dazzled
inline constexpr std::uint16_t kProtectiveField = 0x4000;
inline constexpr std::uint16_t kWarningField = 0x8000;
inline constexpr std::uint16_t kStandbyValue = 0x4004;
inline constexpr std::size_t kMaxValues = 1024;
inline constexpr double kScanPeriodS = 0.040;
inline constexpr double kBitsPerSecond = 500'000.0;

/// What the fields say in one telegram of distances.
struct Fields {
  bool protective = false;  ///< a beam ends within the protective field
  bool warning = false;
  bool standby = false;  ///< all beams 0x4004: the device measures nothing
  bool lockout = false;
  /// Whatever else says go: with any of these the vehicle must stand.
  [[nodiscard]] bool must_stop() const { return protective || standby || lockout; }
};
[[nodiscard]] Fields fields_of(const Telegram& telegram);

/// The distances as a scan of the Lidar frame, -135 ... 135 deg, 0.5 deg apart; 0 and 30 m or more are no
/// returns, and a device in standby sees nothing at all. The stamp stays unset.
[[nodiscard]] LaserScan to_laser_scan(const Telegram& telegram);

struct StreamCounters {
  std::uint64_t telegrams = 0, damaged = 0, lost = 0, skipped_bytes = 0;
};

/// Cuts the serial stream into telegrams with a right CRC.
class Stream {
 public:
  using Sink = std::function<void(const Telegram&)>;
  explicit Stream(Sink sink) : sink_(std::move(sink)) {}

  void push(std::span<const std::uint8_t> bytes);
  [[nodiscard]] const StreamCounters& counters() const { return counters_; }

 private:
  enum class Outcome { NeedMore, Skip, Taken };
  Outcome take_one(std::span<const std::uint8_t> bytes, std::size_t& used);
  void deliver(Telegram& telegram);

  Sink sink_;
  std::vector<std::uint8_t> buffer_;
  StreamCounters counters_;
  std::uint32_t last_scan_ = 0;
  bool started_ = false;
};

}  // namespace madori::sensors::s300
