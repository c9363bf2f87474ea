#include "app/mapping_drive/drive_journal.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <string_view>
#include <utility>

#include "core/fnv1a.hpp"
#include "core/result.hpp"
#include "localization/byte_stream.hpp"

namespace madori::app {
namespace {

using localization::ByteReader;
using localization::ByteWriter;

constexpr std::string_view kHead = "MADORI drive 1\n";
constexpr std::uint32_t kMostBytes = 16U << 20U;  ///< of a record: more is damage
constexpr std::size_t kSumBytes = sizeof(std::uint64_t);
constexpr std::size_t kMostWaitingBytes = 64U << 10U;

/// Whether the payload was one that is known.
bool hand_out(std::string_view payload, const DriveReader& reader) {
  ByteReader in(payload);
  const char kind = in.get<char>();
  const Stamp stamp{Duration(in.get<std::int64_t>())};
  if (kind == 'O') {
    const auto pose = in.transform<Odom, Base>();
    if (!in.at_end()) return false;
    reader.on_odometry({stamp, pose});
    return true;
  }
  if (kind != 'S') return false;
  DriveScan scan{stamp, {}, {}};
  scan.sensor.x_m = in.get<double>();
  scan.sensor.y_m = in.get<double>();
  scan.points.resize(in.count(2 * sizeof(float)));
  for (auto& p : scan.points) {
    p.x_m = static_cast<double>(in.get<float>());
    p.y_m = static_cast<double>(in.get<float>());
  }
  if (!in.at_end()) return false;
  reader.on_scan(scan);
  return true;
}

}  // namespace

OdometryReading as_kept(const OdometryReading& reading) {
  const auto& p = reading.odom_from_base;
  return {reading.stamp, {p.x_m(), p.y_m(), p.yaw_rad()}};
}

std::uintmax_t read_drive(const std::filesystem::path& file, const DriveReader& reader) {
  std::ifstream in(file, std::ios::binary);
  if (!in) return 0;
  std::string head(kHead.size(), '\0');
  in.read(head.data(), static_cast<std::streamsize>(head.size()));
  if (in.gcount() < static_cast<std::streamsize>(head.size())) return 0;  // it was begun and nothing more
  if (head != kHead) throw Error(file.string(), "is no recorded drive", "take it away, and map anew");
  std::uintmax_t whole = kHead.size();
  for (std::string record;;) {
    std::uint32_t size = 0;
    if (reader.stop.stop_requested()) return whole;
    if (!in.read(reinterpret_cast<char*>(&size), sizeof size)) return whole;
    if (size < kSumBytes || size > kMostBytes) return whole;
    record.resize(size);
    if (!in.read(record.data(), size)) return whole;
    const auto payload = std::string_view(record).substr(0, size - kSumBytes);
    std::uint64_t sum = 0;
    std::memcpy(&sum, record.data() + payload.size(), kSumBytes);
    if (sum != fnv1a(payload) || !hand_out(payload, reader)) return whole;
    whole += sizeof size + size;
  }
}

DriveJournal::DriveJournal(const std::filesystem::path& file, std::uintmax_t whole)
    : file_(std::fopen(file.c_str(), "ab")), whole_(whole) {
  if (!file_ || !cut_to_whole())
    throw Error(file.string(), "cannot be written", "check the folder's permissions and free space");
  (void)std::setvbuf(file_.get(), nullptr, _IONBF, 0);  // what could not be written shall not come later
  if (whole == 0) waiting_ = kHead;
  flush();
}

bool DriveJournal::cut_to_whole() {
  return ::ftruncate(fileno(file_.get()), static_cast<off_t>(whole_)) == 0;
}

void DriveJournal::flush() {
  const std::string records = std::exchange(waiting_, {});
  if (std::fwrite(records.data(), 1, records.size(), file_.get()) == records.size()) {
    whole_ += records.size();
    return;
  }
  problem_ = std::strerror(errno);
  std::clearerr(file_.get());
  (void)cut_to_whole();
  if (whole_ == 0) waiting_ = kHead;
}

void DriveJournal::put(const std::string& payload_and_sum) {
  const auto size = static_cast<std::uint32_t>(payload_and_sum.size());
  waiting_.append(reinterpret_cast<const char*>(&size), sizeof size);
  waiting_ += payload_and_sum;
  if (waiting_.size() > kMostWaitingBytes) flush();
}

void DriveJournal::add(const OdometryReading& reading) {
  ByteWriter out;
  out.put('O');
  out.put(static_cast<std::int64_t>(reading.stamp.time_since_epoch().count()));
  out.put(reading.odom_from_base);
  put(out.take());
}

void DriveJournal::add(const DriveScan& scan) {
  ByteWriter out;
  out.put('S');
  out.put(static_cast<std::int64_t>(scan.stamp.time_since_epoch().count()));
  out.put(scan.sensor.x_m);
  out.put(scan.sensor.y_m);
  out.put(static_cast<std::uint32_t>(scan.points.size()));
  for (const auto& p : scan.points) {
    out.put(static_cast<float>(p.x_m));
    out.put(static_cast<float>(p.y_m));
  }
  put(out.take());
  flush();
}

void DriveJournal::sync() {
  flush();
  if (::fdatasync(fileno(file_.get())) != 0) problem_ = std::strerror(errno);
}

}  // namespace madori::app
