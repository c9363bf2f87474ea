#include "sensors/pcap/vlp16_log.hpp"

#include <deque>
#include <optional>

#include "core/result.hpp"
#include "sensors/pcap/reader.hpp"
#include "sensors/pcap/refused_packets.hpp"
#include "sensors/vlp16/assembler.hpp"
#include "sensors/wheels_csv.hpp"

namespace madori::sensors::pcap {
namespace {

/// The revolutions of a capture, with the wheels' odometry in between.
class Vlp16LogReader final : public LogReader {
 public:
  Vlp16LogReader(const std::filesystem::path& file, const LogOptions& options)
      : file_(file),
        capture_(file),
        assembler_([this](vlp16::Frame& f) { frames_.push_back(std::move(f.cloud)); }),
        refused_(file.string()),
        options_(options) {
    if (!options.wheels.empty()) wheels_.emplace(options.wheels, options.geometry);
    if (wheels_) wheel_ = wheels_->next();
    read_frame();
    if (frames_.empty()) refused_.explain(capture_.cut_packets());
    if (wheels_ && (!wheel_ || wheel_->stamp > frames_.front().stamp + std::chrono::hours(1)))
      throw Error(options.wheels.string(), "begins more than an hour after the capture",
                  "time_s must be on the clock of the capture (seconds since 1970)");
  }

  std::optional<LogRecord> next() override {
    read_frame();
    if (wheel_ && (frames_.empty() || wheel_->stamp <= frames_.front().stamp)) return next_wheel();
    if (frames_.empty()) return std::nullopt;
    if (wheels_ && !wheel_ && !any_cloud_)
      throw Error(options_.wheels.string(), "ends before the capture begins",
                  "time_s must be on the clock of the capture (seconds since 1970)");
    any_cloud_ = true;
    PointCloud<Lidar> cloud = std::move(frames_.front());
    frames_.pop_front();
    cloud.lidar = options_.lidar;
    return CloudRecord{"vlp16", std::move(cloud), options_.base_from_lidar, options_.lidar_height_m};
  }

 private:
  std::optional<LogRecord> next_wheel() {
    const OdometryReading reading = *wheel_;
    wheel_ = wheels_->next();
    return reading;
  }
  void read_frame() {
    while (frames_.empty() && !ended_) {
      const auto packet = capture_.next();
      if (!packet) {
        assembler_.flush();
        ended_ = true;
      } else if (packet->udp.bytes.size() == vlp16::kDataBytes) {
        take(*packet);
      }
      if (!assembler_.foreign_sensor().empty())
        throw Error(file_.string(), "holds packets of another sensor (" + assembler_.foreign_sensor() + ")",
                    "only the VLP-16 is supported");
    }
  }

  /// Two lidars' packets in one revolution would be a world that is nowhere.
  void take(const CapturedPacket& packet) {
    if (source_ && *source_ != packet.udp.source) return refused_.count_stranger(packet.udp, *source_);
    const vlp16::PushVerdict verdict = assembler_.push(packet.udp.bytes, packet.captured);
    if (verdict == vlp16::PushVerdict::Refused) refused_.count(packet.udp);
    if (verdict == vlp16::PushVerdict::Taken) source_ = packet.udp.source;
  }

  std::filesystem::path file_;
  PcapReader capture_;
  vlp16::Assembler assembler_;
  RefusedPackets refused_;
  LogOptions options_;
  std::deque<PointCloud<Lidar>> frames_;
  std::optional<WheelsCsv> wheels_;
  std::optional<OdometryReading> wheel_;
  std::optional<std::uint32_t> source_;  ///< the IPv4 address of the lidar
  bool any_cloud_ = false;               ///< was handed out
  bool ended_ = false;
};

}  // namespace

std::unique_ptr<LogReader> open_vlp16_log(const std::filesystem::path& file, const LogOptions& options) {
  return std::make_unique<Vlp16LogReader>(file, options);
}

}  // namespace madori::sensors::pcap
