#pragma once

#include <CLI/CLI.hpp>

#include "app/log_options.hpp"

namespace madori::app {

/// The options with which a person says which part of a log is meant.
inline void add_log_arguments(CLI::App& command, LogArguments& arguments) {
  command.add_option("--scan-topic", arguments.scan_topic, "whose LaserScans of a .bag are read");
  command.add_option("--cloud-topic", arguments.cloud_topic, "whose PointCloud2 of a .bag are read");
  command.add_option("--odometry-topic", arguments.odometry_topic, "whose Odometry of a .bag is read");
  command.add_option("--lidar", arguments.lidar,
                     "the sensor of site.yaml whose scans a .bag or .pcap holds, where that is not clear");
}

inline void add_wheels(CLI::App& command, LogArguments& arguments) {
  command.add_option("--wheels", arguments.wheels, "time_s,left_rad,right_rad; for a .pcap")
      ->check(CLI::ExistingFile);
}

}  // namespace madori::app
