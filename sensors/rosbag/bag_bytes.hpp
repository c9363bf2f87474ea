#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <map>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace madori::sensors::rosbag_bridge {

using Bytes = std::span<const std::uint8_t>;
static_assert(std::endian::native == std::endian::little, "bags are little-endian");

/// Takes values from the front of bytes. Throws std::runtime_error where they end before the value does.
class BagBytes {
 public:
  explicit BagBytes(Bytes bytes) : bytes_(bytes) {}

  [[nodiscard]] bool empty() const { return bytes_.empty(); }
  Bytes take(std::size_t size) {
    if (size > bytes_.size()) throw std::runtime_error("a value lies outside its record");
    const Bytes taken = bytes_.first(size);
    bytes_ = bytes_.subspan(size);
    return taken;
  }
  template <class Number>
  Number number() {
    Number value;
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
    return value;
  }
  /// Bytes behind their u32 count.
  Bytes counted() { return take(number<std::uint32_t>()); }
  std::string text() {
    const Bytes bytes = counted();
    return {bytes.begin(), bytes.end()};
  }
  template <class Number>
  std::vector<Number> numbers() {
    const Bytes bytes = take(number<std::uint32_t>() * sizeof(Number));
    std::vector<Number> values(bytes.size() / sizeof(Number));
    if (!values.empty()) std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
  }

 private:
  Bytes bytes_;
};

/// What stands before a record's data, or in a connection's: `name=value`, each behind its u32 size.
class BagFields {
 public:
  BagFields() = default;
  explicit BagFields(Bytes header) {
    for (BagBytes in(header); !in.empty();) {
      const std::string field = in.text();
      const std::size_t equals = field.find('=');
      if (equals == std::string::npos)
        throw std::runtime_error("a record's header has a field without a name");
      fields_[field.substr(0, equals)] = field.substr(equals + 1);
    }
  }
  /// Empty where there is none.
  [[nodiscard]] std::string text(const std::string& name) const {
    const auto found = fields_.find(name);
    return found == fields_.end() ? std::string() : found->second;
  }
  template <class Number>
  [[nodiscard]] Number number(const std::string& name) const {
    const std::string value = text(name);
    if (value.size() != sizeof(Number)) throw std::runtime_error("a record's header has no right " + name);
    Number number;
    std::memcpy(&number, value.data(), sizeof number);
    return number;
  }

 private:
  std::map<std::string, std::string> fields_;
};

}  // namespace madori::sensors::rosbag_bridge
