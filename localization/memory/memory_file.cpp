#include "localization/memory/memory_file.hpp"

#include <string>
#include <utility>

#include "core/fnv1a.hpp"
#include "localization/byte_stream.hpp"

namespace madori::localization {
namespace {

constexpr std::string_view kMagic = "MADORIMM";
constexpr std::uint32_t kVersion = 1;
constexpr std::size_t kLeastKeyframe = 61, kFactor = 105;  // bytes
/// Of a keyframe; a cut is a break, too.
constexpr unsigned kAfterBreak = 1;
constexpr unsigned kCut = 2;

using Writer = ByteWriter;
using Reader = ByteReader;

void put_scan(Writer& out, const SurfaceScan& scan) {
  out.put(static_cast<std::int64_t>(scan.stamp.time_since_epoch().count()));
  out.put(scan.sensor.x_m);
  out.put(scan.sensor.y_m);
  out.put(static_cast<std::uint32_t>(scan.points.size()));
  for (const SurfacePoint& p : scan.points) {
    for (const double v : {p.x_m, p.y_m, p.normal_x, p.normal_y}) out.put(static_cast<float>(v));
  }
}

SurfaceScan get_scan(Reader& in) {
  SurfaceScan scan;
  scan.stamp = Stamp(Duration(in.get<std::int64_t>()));
  scan.sensor.x_m = in.metres<double>();
  scan.sensor.y_m = in.metres<double>();
  scan.points.resize(in.count(4 * sizeof(float)));
  for (SurfacePoint& p : scan.points) {
    p.x_m = in.metres<float>();
    p.y_m = in.metres<float>();
    p.normal_x = in.metres<float>();
    p.normal_y = in.metres<float>();
  }
  return scan;
}

void put_factor(Writer& out, const RelativeFactor& f) {
  out.put(static_cast<std::int32_t>(f.from));
  out.put(static_cast<std::int32_t>(f.to));
  out.put(static_cast<std::uint8_t>(f.loop ? 1 : 0));
  out.put(f.motion);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) out.put(f.information(i, j));
  }
}

RelativeFactor get_factor(Reader& in) {
  RelativeFactor f;
  f.from = in.get<std::int32_t>();
  f.to = in.get<std::int32_t>();
  f.loop = in.get<std::uint8_t>() != 0;
  f.motion = in.transform<Base, Base>();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) f.information(i, j) = in.get<double>();
  }
  return f;
}

bool has_ends(const RelativeFactor& f, std::size_t keyframes) {
  const int n = static_cast<int>(keyframes);
  return f.from >= 0 && f.from < n && f.to >= 0 && f.to < n && f.from != f.to;
}

}  // namespace

std::string memory_bytes(const Memory& memory, std::uint64_t walls) {
  Writer out;
  out.put(kMagic);
  out.put(kVersion);
  out.put(walls);
  out.put(static_cast<std::uint32_t>(memory.size()));
  for (std::size_t i = 0; i < memory.size(); ++i) {
    const Keyframe& keyframe = memory.keyframes()[i];
    out.put(memory.poses()[i]);
    out.put(keyframe.path_m);
    out.put(static_cast<std::uint8_t>((keyframe.after_break ? kAfterBreak : 0) | (keyframe.cut ? kCut : 0)));
    put_scan(out, *keyframe.scan);
  }
  out.put(static_cast<std::uint32_t>(memory.factors().size()));
  for (const RelativeFactor& f : memory.factors()) put_factor(out, f);
  out.put(static_cast<std::int32_t>(memory.loops()));
  return out.take();
}

Result<Memory> parse_memory(std::string_view bytes, std::uint64_t walls, const MemoryOptions& options) {
  const auto refuse = [](const char* reason) { return Result<Memory>::failure(reason); };
  if (!bytes.starts_with(kMagic) || bytes.size() < kMagic.size() + sizeof(std::uint64_t)) {
    return refuse("it is no memory of Madori");
  }
  const std::string_view body = bytes.substr(0, bytes.size() - sizeof(std::uint64_t));
  Reader end(bytes.substr(body.size()));
  Reader in(body.substr(kMagic.size()));
  if (in.get<std::uint32_t>() != kVersion) return refuse("it was written by another version");
  if (end.get<std::uint64_t>() != fnv1a(body)) return refuse("it is damaged");
  if (in.get<std::uint64_t>() != walls) return refuse("the walls have changed since");
  std::vector<Keyframe> keyframes(in.count(kLeastKeyframe));
  std::vector<Transform2<Map, Base>> poses(keyframes.size());
  for (std::size_t i = 0; i < keyframes.size() && in.ok(); ++i) {
    poses[i] = in.transform<Map, Base>();
    keyframes[i].path_m = in.metres<double>();
    const auto marks = in.get<std::uint8_t>();
    keyframes[i].after_break = marks != 0;
    keyframes[i].cut = (marks & kCut) != 0;
    keyframes[i].scan = std::make_shared<const SurfaceScan>(get_scan(in));
  }
  std::vector<RelativeFactor> factors(in.count(kFactor));
  for (RelativeFactor& f : factors) {
    f = get_factor(in);
    if (!has_ends(f, keyframes.size())) return refuse("it is damaged");
  }
  const int loops = in.get<std::int32_t>();
  if (!in.at_end()) return refuse("it is damaged");
  return Memory(options, std::move(keyframes), std::move(poses), std::move(factors), loops);
}

}  // namespace madori::localization
