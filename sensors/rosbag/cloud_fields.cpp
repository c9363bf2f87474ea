#include "sensors/rosbag/cloud_fields.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <initializer_list>
#include <optional>
#include <string_view>

namespace madori::sensors {
namespace {

using rosbag_bridge::Cloud;
using rosbag_bridge::Field;

constexpr std::uint64_t kMaxPoints = 4'000'000;
enum FieldType : std::uint8_t { kI8 = 1, kU8, kI16, kU16, kI32, kU32, kF32, kF64 };
constexpr std::array<std::uint32_t, 9> kSizes{0, 1, 1, 2, 2, 4, 4, 4, 8};
static_assert(std::endian::native == std::endian::little);

template <class T>
double load(const std::uint8_t* at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  return static_cast<double>(value);
}

double value_at(const std::uint8_t* point, const Field& field) {
  const std::uint8_t* const at = point + field.offset;
  switch (field.type) {
    case kI8:
      return load<std::int8_t>(at);
    case kU8:
      return load<std::uint8_t>(at);
    case kI16:
      return load<std::int16_t>(at);
    case kU16:
      return load<std::uint16_t>(at);
    case kI32:
      return load<std::int32_t>(at);
    case kU32:
      return load<std::uint32_t>(at);
    case kF32:
      return load<float>(at);
    case kF64:
      return load<double>(at);
    default:
      return std::nan("");
  }
}

std::optional<Field> find(const Cloud& cloud, std::initializer_list<std::string_view> names) {
  for (const Field& field : cloud.fields) {
    const bool named = std::find(names.begin(), names.end(), field.name) != names.end();
    if (!named || field.type < kI8 || field.type > kF64) continue;
    if (std::uint64_t{field.offset} + kSizes[field.type] <= cloud.point_step) return field;
  }
  return std::nullopt;
}

double bounded(double value, double largest) {
  return std::isfinite(value) ? std::clamp(value, 0.0, largest) : 0.0;
}

/// Seconds from the message's stamp, before it where that is the sweep's end.
float time_offset_s(double seconds) {
  return std::isfinite(seconds) ? static_cast<float>(std::clamp(seconds, -10.0, 10.0)) : 0.0F;
}

/// The stamp becomes that of the first firing.
void count_from_first(PointCloud<Lidar>& cloud) {
  float first_s = 0.0F;
  for (const CloudPoint& point : cloud.points) first_s = std::min(first_s, point.time_offset_s);
  if (first_s == 0.0F) return;
  cloud.stamp += duration_from_seconds(static_cast<double>(first_s));
  for (CloudPoint& point : cloud.points) point.time_offset_s -= first_s;
}

struct Layout {
  std::optional<Field> x, y, z, intensity, ring, time;
};

std::optional<CloudPoint> read_point(const std::uint8_t* at, const Layout& layout) {
  CloudPoint point;
  point.x_m = static_cast<float>(value_at(at, *layout.x));
  point.y_m = static_cast<float>(value_at(at, *layout.y));
  point.z_m = static_cast<float>(value_at(at, *layout.z));
  if (!std::isfinite(point.x_m + point.y_m + point.z_m)) return std::nullopt;
  if (layout.intensity)
    point.intensity = static_cast<std::uint8_t>(bounded(value_at(at, *layout.intensity), 255.0));
  if (layout.ring) point.ring = static_cast<std::uint8_t>(bounded(value_at(at, *layout.ring), 255.0));
  if (layout.time) {
    const double unit = layout.time->type >= kF32 ? 1.0 : 1e-9;
    point.time_offset_s = time_offset_s(unit * value_at(at, *layout.time));
  }
  return point;
}

}  // namespace

Result<PointCloud<Lidar>> cloud_from_fields(const Cloud& in) {
  using Answer = Result<PointCloud<Lidar>>;
  const Layout layout{find(in, {"x"}),    find(in, {"y"}),
                      find(in, {"z"}),    find(in, {"intensity", "i"}),
                      find(in, {"ring"}), find(in, {"time", "t", "time_offset"})};
  const std::uint64_t points = std::uint64_t{in.width} * in.height;
  if (in.big_endian) return Answer::failure("the cloud is big-endian");
  if (!layout.x || !layout.y || !layout.z) return Answer::failure("the cloud has no x, y and z");
  if (points > kMaxPoints) return Answer::failure("the cloud has more than 4,000,000 points");
  if (points > 0 && (std::uint64_t{in.width} * in.point_step > in.row_step ||
                     std::uint64_t{in.row_step} * in.height > in.data.size()))
    return Answer::failure("the cloud's rows lie outside its data");
  PointCloud<Lidar> cloud{Stamp(Duration(in.stamp_ns)), {}};
  cloud.points.reserve(points);
  for (std::size_t row = 0; points > 0 && row < in.height; ++row)
    for (std::size_t column = 0; column < in.width; ++column) {
      const auto point = read_point(in.data.data() + row * in.row_step + column * in.point_step, layout);
      if (point) cloud.points.push_back(*point);
    }
  count_from_first(cloud);
  return cloud;
}

Cloud fields_from_cloud(const PointCloud<Lidar>& in) {
  struct Packed {
    float x, y, z, intensity, time;
    std::uint16_t ring, padding;
  };
  static_assert(sizeof(Packed) == 24);
  Cloud cloud;
  cloud.stamp_ns = in.stamp.time_since_epoch().count();
  cloud.frame = "lidar";
  cloud.width = static_cast<std::uint32_t>(in.points.size());
  cloud.point_step = sizeof(Packed);
  cloud.row_step = cloud.width * cloud.point_step;
  cloud.fields = {{"x", 0, 1, kF32},          {"y", 4, 1, kF32},     {"z", 8, 1, kF32},
                  {"intensity", 12, 1, kF32}, {"time", 16, 1, kF32}, {"ring", 20, 1, kU16}};
  cloud.data.resize(cloud.row_step);
  std::uint8_t* at = cloud.data.data();
  for (const CloudPoint& p : in.points) {
    const Packed packed{p.x_m, p.y_m, p.z_m, static_cast<float>(p.intensity), p.time_offset_s, p.ring, 0};
    std::memcpy(at, &packed, sizeof packed);
    at += sizeof packed;
  }
  return cloud;
}

}  // namespace madori::sensors
