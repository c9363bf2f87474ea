#include "hmi/server/scan_frame.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace madori::hmi {
namespace {

static_assert(std::endian::native == std::endian::little, "a frame copies the machine's own byte order");

constexpr std::size_t kHead = 36;
constexpr std::size_t kPoint = 4;
constexpr float kUnit_m = 0.01F;
constexpr double kMostUnits = std::numeric_limits<std::int16_t>::max();

void put_count(std::string& frame, std::size_t count) {
  const auto n = static_cast<std::uint32_t>(count);
  std::memcpy(frame.data() + 4, &n, sizeof n);
}

}  // namespace

std::string scan_frame(std::span<const Point2<Base>> scan, const Transform2<Map, Base>& pose) {
  double most_m = 0.0;
  for (const auto& p : scan)
    if (std::isfinite(p.x_m + p.y_m)) most_m = std::max({most_m, std::abs(p.x_m), std::abs(p.y_m)});
  const float unit_m = std::max(kUnit_m, static_cast<float>(1.001 * most_m / kMostUnits));
  std::string frame(kHead + kPoint * scan.size(), '\0');
  std::memcpy(frame.data(), "MDS2", 4);
  const double place[3] = {pose.x_m(), pose.y_m(), pose.yaw_rad()};
  std::memcpy(frame.data() + 8, place, sizeof place);
  std::memcpy(frame.data() + 32, &unit_m, sizeof unit_m);
  std::size_t count = 0;
  const double per_m = 1.0 / static_cast<double>(unit_m);
  for (const auto& p : scan) {
    if (!std::isfinite(p.x_m + p.y_m)) continue;
    const std::int16_t xy[2] = {static_cast<std::int16_t>(std::lround(p.x_m * per_m)),
                                static_cast<std::int16_t>(std::lround(p.y_m * per_m))};
    std::memcpy(frame.data() + kHead + kPoint * count++, xy, sizeof xy);
  }
  frame.resize(kHead + kPoint * count);
  put_count(frame, count);
  return frame;
}

std::string thinned_scan_frame(const std::string& frame, std::size_t most) {
  if (frame.size() < kHead) return scan_frame({}, {});
  const std::size_t count = (frame.size() - kHead) / kPoint;
  if (count <= most) return frame;
  const std::size_t stride = (count + most - 1) / std::max<std::size_t>(1, most);
  std::string thin = frame.substr(0, kHead);
  for (std::size_t i = 0; i < count; i += stride) thin.append(frame, kHead + kPoint * i, kPoint);
  put_count(thin, (thin.size() - kHead) / kPoint);
  return thin;
}

}  // namespace madori::hmi
