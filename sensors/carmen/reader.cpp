#include "sensors/carmen/reader.hpp"

#include <algorithm>
#include <cmath>

#include "core/angle.hpp"
#include "core/result.hpp"

namespace madori::sensors::carmen {
namespace {

constexpr std::size_t kMaxLine = 1U << 20U;
constexpr std::size_t kMostKinds = 12;
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

/// Where the lines of one source say that their laser sits on the robot.
struct StatedMounting {
  std::optional<Transform2<Base, Lidar>> offset;
  Transform2<Odom, Base> start;
  bool constant = true, travelled = false, turned = false;

  void take(const Transform2<Odom, Base>& robot, const Transform2<Odom, Lidar>& laser) {
    const Transform2<Base, Lidar> here = robot.inverse() * laser;
    if (!offset) offset = here, start = robot;
    constant = constant && same(*offset, here);
    travelled = travelled || distance_m(start.translation(), robot.translation()) > kTravelToBelieveM;
    turned = turned || heading_gap_rad(start.yaw_rad(), robot.yaw_rad()) > kTurnToBelieveRad;
  }
  /// A robot that stands, or has only driven straight on, does not tell a mounting from a correction.
  [[nodiscard]] bool is_sure() const { return constant && travelled && turned; }
  [[nodiscard]] bool is_settled() const { return !constant || is_sure(); }
};

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
  find_mountings();
}

std::optional<ParsedLine> CarmenReader::next_line() {
  while (get_bounded_line(stream_, line_)) {
    ++number_;
    const auto place = [this] { return file_.string() + ":" + std::to_string(number_); };
    if (line_.size() > kMaxLine) throw Error(place(), "is longer than 1 MiB", "this is no CARMEN text log");
    params_.take(line_);
    auto parsed = parse_line(line_, params_);
    if (!parsed) throw Error(place(), parsed.reason(), "mend or remove that line");
    if (std::optional<ParsedLine> found = std::move(parsed).value()) return found;
    note_skipped();
  }
  return std::nullopt;
}

void CarmenReader::note_skipped() {
  const std::string kind = line_.substr(0, line_.find_first_of(" \t\r"));
  if (!kind.empty() && kind.front() != '#' && skipped_.size() < kMostKinds) skipped_.insert(kind);
}

std::optional<LogRecord> CarmenReader::next() {
  while (std::optional<ParsedLine> found = next_line()) {
    auto* const scan = std::get_if<ScanRecord>(&found->record);
    if (scan == nullptr) return std::move(found->record);
    if (!scan->odom_from_base && !raw_only_) continue;  // told again, with its pose
    any_scan_ = true;
    const auto mounting = mountings_.find(scan->source);
    if (mounting != mountings_.end()) scan->base_from_lidar = mounting->second;
    return std::move(found->record);
  }
  std::string skipped;
  for (const std::string& kind : skipped_) skipped += (skipped.empty() ? "" : ", ") + kind;
  if (!any_scan_ && !skipped.empty())
    throw Error(file_.string(), "holds no FLASER, RLASER, ROBOTLASER1 or RAWLASER1, but " + skipped,
                "convert its scans to one of these (docs/reference/logs.md)");
  return std::nullopt;
}

void CarmenReader::find_mountings() {
  std::map<std::string, StatedMounting> stated;
  const auto settled = [](const auto& source) { return source.second.is_settled(); };
  try {
    while (stated.empty() || !std::ranges::all_of(stated, settled)) {
      const auto found = next_line();
      if (!found) break;
      const auto* const scan = std::get_if<ScanRecord>(&found->record);
      if (scan == nullptr || !found->odom_from_lidar) continue;
      raw_only_ = false;
      stated[scan->source].take(*scan->odom_from_base, *found->odom_from_lidar);
    }
  } catch (const Error&) {
    // next() reports the damaged line when it comes to it
  }
  stream_.clear();
  stream_.seekg(0);
  number_ = 0;
  params_ = {};
  for (const auto& [source, mounting] : stated) {
    if (!mounting.is_sure() || same(*mounting.offset, {})) continue;
    Transform2<Base, Lidar> at = *mounting.offset;
    const bool looks_back = std::abs(at.yaw_rad()) > kPi / 2.0;
    if (source == "RLASER" && !looks_back) at = {at.x_m(), at.y_m(), wrap_angle(at.yaw_rad() + kPi)};
    if (std::hypot(at.x_m(), at.y_m()) < kFarthestMountingM) mountings_.emplace(source, at);
  }
}

}  // namespace madori::sensors::carmen
