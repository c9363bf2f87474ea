#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "core/fnv1a.hpp"
#include "core/possible.hpp"
#include "core/transform2.hpp"

namespace madori::localization {

static_assert(std::endian::native == std::endian::little, "the files are little-endian");

/// Values into bytes for a file, with a checksum at the end.
class ByteWriter {
 public:
  template <class T>
  requires std::is_arithmetic_v<T>
  void put(T value) {
    std::array<char, sizeof(T)> raw;
    std::memcpy(raw.data(), &value, sizeof(T));
    bytes_.append(raw.data(), raw.size());
  }
  void put(std::string_view text) { bytes_ += text; }
  template <class A, class B>
  void put(const Transform2<A, B>& t) {
    for (const double v : {t.x_m(), t.y_m(), t.yaw_rad()}) put(v);
  }
  [[nodiscard]] std::string take() {
    put(fnv1a(bytes_));
    return std::move(bytes_);
  }

 private:
  std::string bytes_;
};

/// Never reads beyond its bytes: what is missing reads as zero and ok() becomes false.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}
  template <class T>
  T get() {
    T value{};
    if (bytes_.size() < sizeof(T)) {
      ok_ = false;
      bytes_ = {};
      return value;
    }
    std::memcpy(&value, bytes_.data(), sizeof(T));
    bytes_.remove_prefix(sizeof(T));
    if constexpr (std::is_floating_point_v<T>) ok_ = ok_ && std::isfinite(value);
    return value;
  }
  template <class Float>
  Float metres() {
    const auto value = get<Float>();
    ok_ = ok_ && is_possible(static_cast<double>(value));
    return value;
  }
  template <class A, class B>
  Transform2<A, B> transform() {
    const auto x = metres<double>(), y = metres<double>(), yaw = metres<double>();
    return {x, y, yaw};
  }
  /// A number of items of at least `item_bytes` each.
  std::uint32_t count(std::size_t item_bytes) {
    const auto n = get<std::uint32_t>();
    ok_ = ok_ && n <= bytes_.size() / item_bytes;
    return ok_ ? n : 0;
  }
  [[nodiscard]] bool ok() const { return ok_; }
  [[nodiscard]] bool at_end() const { return ok_ && bytes_.empty(); }

 private:
  std::string_view bytes_;
  bool ok_ = true;
};

}  // namespace madori::localization
