#include "sensors/carmen/line.hpp"

#include <charconv>
#include <cmath>

#include "core/angle.hpp"
#include "core/possible.hpp"

namespace madori::sensors::carmen {
namespace {

constexpr int kMaxBeams = 20'000;
constexpr int kMaxHalfCircleBeams = 722;
constexpr double kUnstatedRangeMaxM = 50.0;  ///< an 81.9 m error code lies beyond it as well
constexpr double kLargestTimeS = 9e9;        ///< keeps nanoseconds within 64 bits

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
    const auto value = taken<double>();
    good_ = good_ && std::abs(value) <= largest;
    return good_ ? value : 0.0;
  }

  /// nan and inf, which converters of other logs write, are no returns.
  double range() {
    const auto value = taken<double>();
    const bool finite = std::isfinite(value);
    good_ = good_ && (!finite || std::abs(value) <= kLargestRead);
    return good_ && finite ? value : 0.0;
  }

  int count(int smallest, int largest) {
    const int value = taken<int>();
    good_ = good_ && value >= smallest && value <= largest;
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
  /// The next word, all of it, as a number; it may be nan or inf.
  template <class Number>
  Number taken() {
    const std::string_view text = word();
    Number value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    good_ = good_ && error == std::errc() && end == text.data() + text.size();
    return value;
  }

  std::string_view rest_;
  bool good_ = true;
};

using Parsed = Result<std::optional<ParsedLine>>;

void read_ranges(Words& words, int beams, LaserScan& scan) {
  scan.ranges_m.reserve(static_cast<std::size_t>(beams));
  for (int i = 0; i < beams && words.good(); ++i) {
    const double range_m = words.range();
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

/// Steps that the field of view counts: a sweep of an even number of beams stops one step short of its end,
/// one of an odd number includes both.
int steps_of(int beams) {
  return beams % 2 == 0 ? beams : beams - 1;
}

/// The half-circle form says no angles. Counts of the lasers that CARMEN knew say them: whole, half and
/// quarter degrees over 180, whole and quarter degrees over 100. Nothing where neither these nor `said` do,
/// or where what is said contradicts the count.
std::optional<LogParams::Laser> spread_of(int beams, LogParams::Laser said) {
  const int steps = steps_of(beams);
  for (const int half_circle : {180, 360, 720})
    if (steps == half_circle) return LogParams::Laser{kPi, kPi / steps};
  if (steps == 400 || beams == 101) return LogParams::Laser{to_rad(100.0), to_rad(100.0) / steps};
  if (said.fov_rad <= 0.0) said.fov_rad = said.step_rad * steps;
  if (said.step_rad <= 0.0) said.step_rad = said.fov_rad / steps;
  const bool agree = std::abs(said.step_rad * (beams - 0.5) - said.fov_rad) < 1.6 * said.step_rad;
  return said.step_rad > 0.0 && agree ? std::optional(said) : std::nullopt;
}

Parsed parse_half_circle(Words words, std::string_view kind, const LogParams& params) {
  ScanRecord record{std::string(kind), {}, {}, {}, {}};
  const int beams = words.count(2, kMaxHalfCircleBeams);
  if (!words.good())
    return Parsed::failure("needs a number of beams between 2 and 722 after " + record.source);
  const bool rear = kind == "RLASER";
  const auto spread = spread_of(beams, rear ? params.rear : params.front);
  if (!spread) {
    const std::string param = rear ? "laser_rear_laser_" : "laser_front_laser_";
    return Parsed::failure("has " + std::to_string(beams) +
                           " beams, which do not say over what angle: put `PARAM " + param +
                           "fov DEGREES` and `PARAM " + param + "resolution DEGREES` before it");
  }
  record.scan.angle_min_rad = -spread->fov_rad / 2.0;
  record.scan.angle_step_rad = spread->step_rad;
  record.scan.range_max_m = kUnstatedRangeMaxM;
  read_ranges(words, beams, record.scan);
  const auto odom_from_lidar = words.pose<Odom, Lidar>();
  record.odom_from_base = words.pose<Odom, Base>();
  record.scan.stamp = words.stamp();
  if (!words.good())
    return Parsed::failure("is not `" + record.source + " n ranges laser-pose robot-pose time ...`");
  if (rear) record.base_from_lidar = {0.0, 0.0, kPi};
  return Parsed(ParsedLine{std::move(record), odom_from_lidar});
}

/// RAWLASER1 is the same without the poses, as the laser's own driver tells it.
Parsed parse_robot_laser(Words words, std::string_view kind, const LogParams& params) {
  ScanRecord record{std::string(kind), {}, {}, {}, {}};
  LaserScan& scan = record.scan;
  words.skip(1);  // laser type
  scan.angle_min_rad = words.number();
  words.skip(1);  // field of view: the count and the step say it
  scan.angle_step_rad = words.number();
  const double stated_max_m = words.number();
  scan.range_max_m = stated_max_m == 0.0 ? kUnstatedRangeMaxM : stated_max_m;
  words.skip(2);  // accuracy, remission mode
  const int beams = words.count(1, kMaxBeams);
  read_ranges(words, beams, scan);
  const int remissions = words.count(0, kMaxBeams);
  for (int i = 0; i < remissions && words.good(); ++i)
    scan.intensities.push_back(static_cast<float>(words.number()));
  if (remissions != beams) scan.intensities.clear();
  std::optional<Transform2<Odom, Lidar>> odom_from_lidar;
  if (kind == "RAWLASER1") {
    record.base_from_lidar = {params.front_ahead_m, 0.0, 0.0};
  } else {
    odom_from_lidar = words.pose<Odom, Lidar>();
    record.odom_from_base = words.pose<Odom, Base>();
    words.skip(5);  // speeds, safety distances, turn axis
  }
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

void LogParams::take(std::string_view line) {
  Words words(line);
  if (words.word() != "PARAM") return;
  const std::string_view name = words.word();
  const double value = words.number();
  if (!words.good()) return;
  if (name == "laser_front_laser_fov") front.fov_rad = to_rad(value);
  if (name == "laser_front_laser_resolution") front.step_rad = to_rad(value);
  if (name == "laser_rear_laser_fov") rear.fov_rad = to_rad(value);
  if (name == "laser_rear_laser_resolution") rear.step_rad = to_rad(value);
  if (name == "robot_frontlaser_offset") front_ahead_m = value;
}

Parsed parse_line(std::string_view line, const LogParams& params) {
  Words words(line);
  const std::string_view kind = words.word();
  if (!words.good() || kind.front() == '#') return Parsed(std::nullopt);
  if (kind == "ODOM") return parse_odometry(words);
  if (kind == "FLASER" || kind == "RLASER") return parse_half_circle(words, kind, params);
  if (kind == "ROBOTLASER1" || kind == "RAWLASER1") return parse_robot_laser(words, kind, params);
  if (!is_message_name(kind)) return Parsed::failure("does not begin with a CARMEN message name");
  return Parsed(std::nullopt);
}

}  // namespace madori::sensors::carmen
