#include "sensors/carmen/reader.hpp"

#include <cmath>

#include "core/result.hpp"

namespace madori::sensors::carmen {
namespace {

constexpr std::size_t kMaxLine = 1U << 20U;
constexpr int kScansForMounting = 400;
constexpr double kSamePlaceM = 0.02;  ///< logs print centimetres at the coarsest
constexpr double kSameHeadingRad = 0.02;
constexpr double kFarthestMountingM = 5.0;
constexpr double kTravelToBelieveM = 1.0;
constexpr double kTurnToBelieveRad = 0.5;

double heading_gap_rad(double a_rad, double b_rad) {
  return std::abs(wrap_angle(a_rad - b_rad));
}

bool same(const Transform2<Base, Lidar>& a, const Transform2<Base, Lidar>& b) {
  return std::hypot(a.x_m() - b.x_m(), a.y_m() - b.y_m()) < kSamePlaceM &&
         heading_gap_rad(a.yaw_rad(), b.yaw_rad()) < kSameHeadingRad;
}

/// getline that refuses to fill the memory from a file without line ends.
bool get_bounded_line(std::istream& stream, std::string& line) {
  line.clear();
  for (int c = stream.rdbuf()->sbumpc(); c != std::char_traits<char>::eof(); c = stream.rdbuf()->sbumpc()) {
    if (c == '\n') return true;
    line.push_back(static_cast<char>(c));
    if (line.size() > kMaxLine) return true;
  }
  return !line.empty();
}

}  // namespace

CarmenReader::CarmenReader(const std::filesystem::path& file) : file_(file), stream_(file, std::ios::binary) {
  if (!stream_) throw Error(file.string(), "cannot be opened", "check the path of the log");
  find_mounting();
}

std::optional<ParsedLine> CarmenReader::next_line() {
  while (get_bounded_line(stream_, line_)) {
    ++number_;
    const auto place = [this] { return file_.string() + ":" + std::to_string(number_); };
    if (line_.size() > kMaxLine) throw Error(place(), "is longer than 1 MiB", "this is no CARMEN text log");
    auto parsed = parse_line(line_);
    if (!parsed) throw Error(place(), parsed.reason(), "mend or remove that line");
    if (std::optional<ParsedLine> found = std::move(parsed).value()) return found;
  }
  return std::nullopt;
}

std::optional<LogRecord> CarmenReader::next() {
  std::optional<ParsedLine> found = next_line();
  if (!found) return std::nullopt;
  if (auto* scan = std::get_if<ScanRecord>(&found->record); scan && mounting_ && scan->source != "RLASER")
    scan->base_from_lidar = *mounting_;
  return std::move(found->record);
}

std::optional<Transform2<Base, Lidar>> CarmenReader::constant_offset() {
  std::optional<Transform2<Base, Lidar>> offset;
  Transform2<Odom, Base> start;
  bool travelled = false, turned = false;
  for (int scans = 0; scans < kScansForMounting && !(travelled && turned);) {
    const auto found = next_line();
    if (!found) break;
    const auto* scan = std::get_if<ScanRecord>(&found->record);
    if (!scan || scan->source == "RLASER") continue;
    const Transform2<Odom, Base>& robot = *scan->odom_from_base;
    const Transform2<Base, Lidar> here = robot.inverse() * *found->odom_from_lidar;
    if (++scans == 1) offset = here, start = robot;
    if (!same(*offset, here)) return std::nullopt;
    travelled = travelled || distance_m(start.translation(), robot.translation()) > kTravelToBelieveM;
    turned = turned || heading_gap_rad(start.yaw_rad(), robot.yaw_rad()) > kTurnToBelieveRad;
  }
  return travelled && turned ? offset : std::nullopt;
}

void CarmenReader::find_mounting() {
  std::optional<Transform2<Base, Lidar>> offset;
  try {
    offset = constant_offset();
  } catch (const Error&) {
    // next() reports the damaged line when it comes to it
  }
  stream_.clear();
  stream_.seekg(0);
  number_ = 0;
  if (!offset || same(*offset, {})) return;
  if (std::hypot(offset->x_m(), offset->y_m()) < kFarthestMountingM) mounting_ = offset;
}

}  // namespace madori::sensors::carmen
