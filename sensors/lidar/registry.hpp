#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "sensors/lidar/lidar.hpp"

namespace madori::sensors {

enum class LidarLink { Udp, Tcp, Serial };

/// Everything that the rest of the house knows of a kind of lidar.
struct LidarRow {
  std::string type;     ///< in site.yaml
  std::string title;    ///< for people
  LidarLink link;       ///< how it is connected
  std::string address;  ///< where it is looked for unless the site says otherwise
  bool has_field;       ///< tells of a protective field: the vehicle obeys it
  bool keeps_bytes;     ///< recordings keep its packets instead of its sweeps
  std::function<LidarModel(const LidarSettings&)> model;
  std::function<std::unique_ptr<LidarDecoder>(const LidarSettings&, SweepSink)> decoder;
  /// Throws Error where its port is taken or a setting is wrong; a device that is not there may come later.
  std::function<std::unique_ptr<LidarDriver>(const LidarSettings&, SweepSink, BytesTap)> open;
};

/// How a row makes its decoder or driver: a class that is constructed from what the row is asked with.
template <class Made>
[[nodiscard]] auto made() {
  return [](const LidarSettings& settings, SweepSink sink, auto... more) {
    return std::make_unique<Made>(settings, std::move(sink), std::move(more)...);
  };
}

/// All kinds of lidar, in the order in which they are offered. Registered before main() and by tests; read
/// by everybody.
[[nodiscard]] const std::vector<LidarRow>& lidar_rows();
/// Null where no lidar is called so.
[[nodiscard]] const LidarRow* find_lidar(const std::string& type);
/// The same; throws an Error that names `where` and the kinds there are.
[[nodiscard]] const LidarRow& lidar_of(const std::string& type, const std::string& where);
/// "a, b or c", for messages.
[[nodiscard]] std::string lidar_types();
/// One more kind, for programs that bring their own. Replaces one of the same name.
void add_lidar(LidarRow row);

}  // namespace madori::sensors
