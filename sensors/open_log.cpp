#include "sensors/open_log.hpp"

#include "core/input_file.hpp"
#include "core/result.hpp"
#include "sensors/carmen/reader.hpp"
#include "sensors/deskewed_reader.hpp"
#include "sensors/pcap/vlp16_log.hpp"
#include "sensors/time_order.hpp"

namespace madori::sensors {
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
  LogRemark remark;
  if (options.remark)
    remark = [told = options.remark, file](const std::string& what) { told(file.string() + ": " + what); };
  const auto steady = [&](std::unique_ptr<LogReader> log) -> std::unique_ptr<LogReader> {
    return std::make_unique<SteadyTimeReader>(std::move(log), remark);
  };
  if (capture) return deskewed(steady(pcap::open_vlp16_log(file, options)));
  if (extension == ".log" || extension == ".clf" || extension == ".carmen")
    return steady(std::make_unique<carmen::CarmenReader>(file));
  if (extension == ".bag") {
    BagOptions bag = options.bag;
    bag.remark = remark;
    if (bag.lidars.empty())
      bag.lidars.push_back({"", "", options.lidar, false, options.base_from_lidar, options.lidar_height_m});
    return deskewed(
        std::make_unique<TimeOrderedReader>(steady(std::make_unique<BagReader>(file, bag)), kBagDisorder));
  }
  throw Error(file.string(), "has an extension that is no log's",
              "use .log, .clf or .carmen (CARMEN), .bag (ROS 1) or .pcap (VLP-16)");
}

}  // namespace madori::sensors
