#include "sensors/carmen/line.hpp"

#include <charconv>
#include <cmath>

#include "core/angle.hpp"
#include "core/possible.hpp"

namespace madori::sensors::carmen {
namespace {

constexpr int kMaxBeams = 20'000;
constexpr int kMaxHalfCircleBeams = 722;
constexpr double kHalfCircleRangeMaxM = 50.0;  ///< an 81.9 m error code lies beyond it as well
constexpr double kLargestTimeS = 9e9;          ///< keeps nanoseconds within 64 bits

/// Takes words and numbers off the front of a line; after the first failure everything fails.
class Words {
 public:
  explicit Words(std::string_view line) : rest_(line) {}

  std::string_view word() {
    const std::size_t start = rest_.find_first_not_of(" \t\r");
    if (start == std::string_view::npos) {
      good_ = false;
      return {};
    }
    const std::size_t end = std::min(rest_.find_first_of(" \t\r", start), rest_.size());
    const std::string_view found = rest_.substr(start, end - start);
    rest_.remove_prefix(end);
    return found;
  }

  double number(double largest = kLargestRead) {
    const std::string_view text = word();
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    good_ = good_ && error == std::errc() && end == text.data() + text.size() && std::abs(value) <= largest;
    return good_ ? value : 0.0;
  }

  int count(int smallest, int largest) {
    const std::string_view text = word();
    int value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    good_ = good_ && error == std::errc() && end == text.data() + text.size() && value >= smallest &&
            value <= largest;
    return good_ ? value : 0;
  }

  template <class To, class From>
  Transform2<To, From> pose() {
    const double x_m = number(), y_m = number(), yaw_rad = number();
    return {x_m, y_m, yaw_rad};
  }
  /// CARMEN prints microseconds; a double of today's seconds holds no more.
  Stamp stamp() {
    return std::chrono::round<std::chrono::microseconds>(stamp_from_seconds(number(kLargestTimeS)));
  }
  void skip(int words) {
    for (int i = 0; i < words; ++i) word();
  }
  [[nodiscard]] bool good() const { return good_; }

 private:
  std::string_view rest_;
  bool good_ = true;
};

using Parsed = Result<std::optional<ParsedLine>>;

void read_ranges(Words& words, int beams, LaserScan& scan) {
  scan.ranges_m.reserve(static_cast<std::size_t>(beams));
  for (int i = 0; i < beams && words.good(); ++i) {
    const double range_m = words.number();
    const bool hit = range_m > 0.0 && range_m < scan.range_max_m;
    scan.ranges_m.push_back(hit ? static_cast<float>(range_m) : LaserScan::kNoReturn);
  }
}

Parsed parse_odometry(Words words) {
  const auto odom_from_base = words.pose<Odom, Base>();
  words.skip(3);  // speeds and acceleration: the differences of the poses say it better
  const Stamp stamp = words.stamp();
  if (!words.good()) return Parsed::failure("is not `ODOM x y yaw tv rv accel time ...`");
  return Parsed(ParsedLine{OdometryReading{stamp, odom_from_base}, {}});
}

/// The half-circle form says no angles: an even count starts at -90 deg and stops one step short of +90 deg,
/// an odd count includes both.
Parsed parse_half_circle(Words words, std::string_view kind) {
  ScanRecord record{std::string(kind), {}, {}, {}, {}};
  const int beams = words.count(2, kMaxHalfCircleBeams);
  if (!words.good())
    return Parsed::failure("needs a number of beams between 2 and 722 after " + record.source);
  record.scan.angle_min_rad = -kPi / 2.0;
  record.scan.angle_step_rad = kPi / (beams % 2 == 0 ? beams : beams - 1);
  record.scan.range_max_m = kHalfCircleRangeMaxM;
  read_ranges(words, beams, record.scan);
  const auto odom_from_lidar = words.pose<Odom, Lidar>();
  record.odom_from_base = words.pose<Odom, Base>();
  record.scan.stamp = words.stamp();
  if (!words.good())
    return Parsed::failure("is not `" + record.source + " n ranges laser-pose robot-pose time ...`");
  if (kind == "RLASER") record.base_from_lidar = {0.0, 0.0, kPi};
  return Parsed(ParsedLine{std::move(record), odom_from_lidar});
}

Parsed parse_robot_laser(Words words, std::string_view kind) {
  ScanRecord record{std::string(kind), {}, {}, {}, {}};
  LaserScan& scan = record.scan;
  words.skip(1);  // laser type
  scan.angle_min_rad = words.number();
  words.skip(1);  // field of view: the count and the step say it
  scan.angle_step_rad = words.number();
  scan.range_max_m = words.number();
  words.skip(2);  // accuracy, remission mode
  const int beams = words.count(1, kMaxBeams);
  read_ranges(words, beams, scan);
  const int remissions = words.count(0, kMaxBeams);
  for (int i = 0; i < remissions && words.good(); ++i)
    scan.intensities.push_back(static_cast<float>(words.number()));
  if (remissions != beams) scan.intensities.clear();
  const auto odom_from_lidar = words.pose<Odom, Lidar>();
  record.odom_from_base = words.pose<Odom, Base>();
  words.skip(5);  // speeds, safety distances, turn axis
  scan.stamp = words.stamp();
  if (!words.good() || scan.range_max_m <= 0.0 || scan.angle_step_rad <= 0.0)
    return Parsed::failure("is no complete " + record.source + " line");
  return Parsed(ParsedLine{std::move(record), odom_from_lidar});
}

bool is_message_name(std::string_view name) {
  if (name.empty() || name.size() > 64 || name.front() < 'A' || name.front() > 'Z') return false;
  for (const char c : name)
    if ((c < 'A' || c > 'Z') && (c < '0' || c > '9') && c != '_') return false;
  return true;
}

}  // namespace

Parsed parse_line(std::string_view line) {
  Words words(line);
  const std::string_view kind = words.word();
  if (!words.good() || kind.front() == '#') return Parsed(std::nullopt);
  if (kind == "ODOM") return parse_odometry(words);
  if (kind == "FLASER" || kind == "RLASER") return parse_half_circle(words, kind);
  if (kind == "ROBOTLASER1") return parse_robot_laser(words, kind);
  if (!is_message_name(kind)) return Parsed::failure("does not begin with a CARMEN message name");
  return Parsed(std::nullopt);
}

}  // namespace madori::sensors::carmen
