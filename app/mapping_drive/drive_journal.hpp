#pragma once

#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>
#include <vector>

#include "core/odometry.hpp"
#include "core/point2.hpp"

namespace madori::app {

/// A scan as the mapper gets it.
struct DriveScan {
  Stamp stamp{};
  Point2<Base> sensor;  ///< where the lidar sits
  std::vector<Point2<Base>> points;
};

/// A reading as a file gives it back, to the bit.
[[nodiscard]] OdometryReading as_kept(const OdometryReading& reading);

/// Who reads a drive, record by record in the order in which it was driven.
struct DriveReader {
  std::function<void(const OdometryReading&)> on_odometry;
  std::function<void(const DriveScan&)> on_scan;
  std::stop_token stop = {};  ///< asked before each record
};

/// Reads what a DriveJournal has written, up to the first record that is not whole: the end of power may have
/// cut it off, or until it is to stop. Returns the bytes that are whole as far as it read; 0 where there is
/// no such file. Throws Error where it is something else.
std::uintmax_t read_drive(const std::filesystem::path& file, const DriveReader& reader);

/// What a mapper was given, kept as it is driven: "MADORI drive 1\n", then records of u32 size, payload,
/// u64 FNV-1a of the payload. A payload: 'O', i64 stamp in ns, f64 x, y, yaw of odom_from_base; or 'S',
/// i64 stamp in ns, f64 x, y of the lidar, u32 n, n pairs of f32 (Base frame, metres). Little-endian.
class DriveJournal {
 public:
  /// Goes on behind the first `whole` bytes of the file; 0: begins anew. Throws Error (no permission).
  DriveJournal(const std::filesystem::path& file, std::uintmax_t whole);

  void add(const OdometryReading& reading);
  /// With it what was added before reaches the file: a program that is killed loses nothing.
  void add(const DriveScan& scan);
  /// Down to the disk: a power failure loses nothing of it.
  void sync();
  /// The disk's complaint; empty when there is none.
  [[nodiscard]] const std::string& problem() const { return problem_; }

 private:
  struct Close {
    void operator()(std::FILE* file) const { (void)std::fclose(file); }
  };
  void put(const std::string& payload_and_sum);
  /// All that waits reaches the file, or nothing of it: behind a torn record nothing could be read again.
  /// What a full disk does not take is missing as a scan is that was dropped.
  void flush();
  [[nodiscard]] bool cut_to_whole();

  std::unique_ptr<std::FILE, Close> file_;
  std::uintmax_t whole_;  ///< bytes of the file, all of them whole records
  std::string waiting_;   ///< records that have still to reach it
  std::string problem_;
};

}  // namespace madori::app
