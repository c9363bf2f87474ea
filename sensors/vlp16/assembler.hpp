#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>

#include "core/frames.hpp"
#include "core/point_cloud.hpp"
#include "core/stamp.hpp"
#include "sensors/device_clock.hpp"
#include "sensors/vlp16/packet.hpp"

namespace madori::sensors::vlp16 {

/// Which return of a dual-return packet becomes a point. Strongest: the odd blocks' return, which is the
/// second strongest where the last is the strongest; so of two returns always the nearer one, as a vehicle
/// wants it. Both: that one, and the last where it differs.
enum class DualReturn { Strongest, Last, Both };

struct AssemblerOptions {
  DualReturn dual_return = DualReturn::Strongest;
};

/// The points between two azimuth wraps, Lidar frame (x at azimuth 0, y left), in the order of firing.
struct Frame {
  PointCloud<Lidar> cloud;           ///< the stamp is the PC's time of the first firing
  std::int64_t first_firing_us = 0;  ///< the sensor's own time of it, unwrapped over the hour
  int blocks = 0;
};
/// May move the cloud away.
using FrameSink = std::function<void(Frame&)>;

enum class PushVerdict { Taken, Duplicate, Late, Refused, ForeignSensor };

struct AssemblerCounters {
  std::uint64_t packets = 0;  ///< taken
  std::uint64_t lost = 0, duplicates = 0, late = 0, refused = 0;
  std::uint64_t frames = 0, silences = 0;
};

/// Data packets become frames. A frame ends where a block's azimuth is smaller than its forerunner's, and
/// where a whole turn is missing. Lost packets are counted and leave a gap; late and repeated ones are
/// counted and thrown away, however late, and so is what a rotor sees that stands or takes longer for a turn
/// than any VLP-16 may.
class Assembler {
 public:
  explicit Assembler(FrameSink sink, AssemblerOptions options = {});

  PushVerdict push(std::span<const std::uint8_t> packet, Stamp received);
  /// The packets that follow are another lidar's: what was gathered, its clock and its kind are forgotten.
  void begin_anew();
  /// Hands out what has been gathered since the last wrap: the end of a recording.
  void flush();

  [[nodiscard]] const AssemblerCounters& counters() const { return counters_; }
  /// "HDL-32E", "VLP-32C" ... while the packets come faster than a VLP-16 can send; empty otherwise.
  [[nodiscard]] const std::string& foreign_sensor() const { return foreign_sensor_; }
  /// No turn was completed in the time of the slowest one, nor since.
  [[nodiscard]] bool rotor_stands() const { return rotor_stands_; }

 private:
  /// Packets of another time than those before, in the order of their coming.
  struct Doubt {
    std::int64_t first_us = 0, last_us = 0;
    Stamp begun;
  };

  PushVerdict check_order(Stamp received);
  bool is_new_time(Stamp received);
  [[nodiscard]] std::int64_t since(std::int64_t time_us) const;
  void restart(std::int64_t step_us);
  [[nodiscard]] bool is_too_fast();
  bool stays_foreign();
  bool find_gaps();
  void add_block(std::size_t block);
  void cut_before(std::uint16_t azimuth_cdeg);
  void finish_frame();
  void drop_frame();

  FrameSink sink_;
  AssemblerOptions options_;
  AssemblerCounters counters_;
  DeviceClock clock_;
  DataPacket packet_;
  std::array<double, kBlocks> gap_cdeg_{};  ///< azimuth swept by each block's two firings
  Frame frame_;
  std::string foreign_sensor_;
  std::int64_t packet_us_ = 0;  ///< unwrapped time of the last packet that was taken
  std::int64_t seen_us_ = 0;    ///< and of the last one at all
  Stamp taken_{};               ///< when the last one came that was taken
  std::optional<Doubt> doubt_;
  ReturnMode mode_ = ReturnMode::Strongest;
  bool started_ = false;
  bool rotor_stands_ = false;
  int impossible_steps_ = 0;
  int possible_steps_ = 0;  ///< in a row, while it counts as another model
  int last_azimuth_cdeg_ = -1;
};

}  // namespace madori::sensors::vlp16
