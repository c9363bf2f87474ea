#include "sensors/open_log.hpp"

#include <deque>

#include "core/input_file.hpp"
#include "core/result.hpp"
#include "sensors/carmen/reader.hpp"
#include "sensors/deskewed_reader.hpp"
#include "sensors/pcap/reader.hpp"
#include "sensors/time_order.hpp"
#include "sensors/vlp16/assembler.hpp"
#include "sensors/wheels_csv.hpp"

namespace madori::sensors {
namespace {

constexpr auto kBagDisorder = std::chrono::milliseconds(300);

/// The revolutions of a capture, with the wheels' odometry in between.
class Vlp16LogReader final : public LogReader {
 public:
  Vlp16LogReader(const std::filesystem::path& file, const LogOptions& options)
      : file_(file),
        capture_(file),
        assembler_([this](vlp16::Frame& f) { frames_.push_back(std::move(f.cloud)); }),
        options_(options) {
    if (!options.wheels.empty()) wheels_.emplace(options.wheels, options.geometry);
    if (wheels_) wheel_ = wheels_->next();
    read_frame();
    if (frames_.empty())
      throw Error(file.string(), "holds no VLP-16 data packets", "capture the sensor's UDP port 2368");
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
        assembler_.push(packet->udp.bytes, packet->captured);
      }
      if (!assembler_.foreign_sensor().empty())
        throw Error(file_.string(), "holds packets of another sensor (" + assembler_.foreign_sensor() + ")",
                    "only the VLP-16 is supported");
    }
  }

  std::filesystem::path file_;
  pcap::PcapReader capture_;
  vlp16::Assembler assembler_;
  LogOptions options_;
  std::deque<PointCloud<Lidar>> frames_;
  std::optional<WheelsCsv> wheels_;
  std::optional<OdometryReading> wheel_;
  bool any_cloud_ = false;  ///< was handed out
  bool ended_ = false;
};

}  // namespace

std::unique_ptr<LogReader> open_log(const std::filesystem::path& file, const LogOptions& options) {
  const std::string extension = lower_extension(file);
  const bool capture = extension == ".pcap" || extension == ".pcapng";
  if (!std::filesystem::is_regular_file(file))
    throw Error(file.string(), "is no file", "check the path of the log");
  if (!options.wheels.empty() && !capture)
    throw Error(file.string(), "carries its own odometry", "give the wheels' record with a .pcap only");
  const auto deskewed = [&](std::unique_ptr<LogReader> log) -> std::unique_ptr<LogReader> {
    if (!options.deskew) return log;
    return std::make_unique<DeskewedReader>(std::move(log));
  };
  const auto steady = [&](std::unique_ptr<LogReader> log) -> std::unique_ptr<LogReader> {
    LogRemark remark;
    if (options.remark)
      remark = [told = options.remark, file](const std::string& what) { told(file.string() + ": " + what); };
    return std::make_unique<SteadyTimeReader>(std::move(log), std::move(remark));
  };
  if (capture) return deskewed(steady(std::make_unique<Vlp16LogReader>(file, options)));
  if (extension == ".log" || extension == ".clf" || extension == ".carmen")
    return steady(std::make_unique<carmen::CarmenReader>(file));
  if (extension == ".bag") {
    BagOptions bag = options.bag;
    if (bag.lidars.empty())
      bag.lidars.push_back({"", "", options.lidar, false, options.base_from_lidar, options.lidar_height_m});
    return deskewed(
        std::make_unique<TimeOrderedReader>(steady(std::make_unique<BagReader>(file, bag)), kBagDisorder));
  }
  throw Error(file.string(), "has an extension that is no log's",
              "use .log, .clf or .carmen (CARMEN), .bag (ROS 1) or .pcap (VLP-16)");
}

}  // namespace madori::sensors
