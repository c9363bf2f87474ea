#include "sensors/wheels_csv.hpp"

#include <array>
#include <charconv>
#include <cmath>

#include "core/input_file.hpp"
#include "core/result.hpp"

namespace madori::sensors {
namespace {

constexpr double kLargest = 9e9;
constexpr std::size_t kMostInLine = 1'000;

/// Exactly three finite numbers.
bool parse(std::string_view row, std::array<double, 3>& values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    const bool last = i + 1 == values.size();
    const std::size_t end = last ? row.size() : row.find(',');
    if (end == std::string_view::npos) return false;
    const char* const begin = row.data();
    const auto [stop, error] = std::from_chars(begin, begin + end, values[i]);
    if (error != std::errc() || stop != begin + end || !(std::abs(values[i]) < kLargest)) return false;
    row.remove_prefix(last ? end : end + 1);
  }
  return true;
}

}  // namespace

WheelsCsv::WheelsCsv(const std::filesystem::path& file, const WheelGeometry& geometry)
    : file_(file), stream_(file), geometry_(geometry) {
  if (!stream_) throw Error(file.string(), "cannot be opened", "check the path of the wheels' record");
  std::string head;
  (void)madori::next_line(stream_, head, file.string(), 1, kMostInLine);
  if (!head.empty() && head.back() == '\r') head.pop_back();
  if (head != "time_s,left_rad,right_rad")
    throw Error(file.string() + ":1", "is not `time_s,left_rad,right_rad`", "write that line first");
}

std::optional<OdometryReading> WheelsCsv::next() {
  std::string row;
  if (!madori::next_line(stream_, row, file_.string(), line_ + 1, kMostInLine)) return std::nullopt;
  ++line_;
  const std::string place = file_.string() + ":" + std::to_string(line_);
  if (!row.empty() && row.back() == '\r') row.pop_back();
  std::array<double, 3> values{};
  if (!parse(row, values)) throw Error(place, "is not three numbers", "mend or remove that line");
  const auto [time_s, left_rad, right_rad] = values;
  const Stamp stamp = stamp_from_seconds(time_s);
  if (line_ > 2 && stamp < reading_.stamp) throw Error(place, "goes back in time", "sort the rows by time");
  if (line_ > 2)
    reading_.odom_from_base =
        reading_.odom_from_base * arc_step(geometry_, left_rad - left_rad_, right_rad - right_rad_);
  left_rad_ = left_rad;
  right_rad_ = right_rad;
  reading_.stamp = stamp;
  return reading_;
}

}  // namespace madori::sensors
