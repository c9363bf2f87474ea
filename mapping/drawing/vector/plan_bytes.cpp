#include "mapping/drawing/vector/plan_bytes.hpp"

#include <cstdint>
#include <cstring>
#include <type_traits>

#include "core/result.hpp"

namespace madori::mapping {
namespace {

template <class T>
inline constexpr bool kPlain = std::is_trivially_copyable_v<T>;

class Out {
 public:
  template <class T>
  void operator()(const T& value) {
    if constexpr (requires { value.has_value(); }) {
      (*this)(static_cast<std::uint8_t>(value.has_value()));
      if (value) (*this)(*value);
    } else if constexpr (kPlain<T>) {
      bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    } else {
      (*this)(static_cast<std::uint64_t>(value.size()));
      using Item = typename T::value_type;
      if constexpr (kPlain<Item>)
        bytes.append(reinterpret_cast<const char*>(value.data()), value.size() * sizeof(Item));
      else
        for (const auto& item : value) (*this)(item);
    }
  }
  std::string bytes;
};

class In {
 public:
  explicit In(std::string_view bytes) : bytes_(bytes) {}

  template <class T>
  void operator()(T& value) {
    if constexpr (requires { value.has_value(); }) {
      std::uint8_t there = 0;
      (*this)(there);
      if (there != 0) (*this)(value.emplace());
    } else if constexpr (kPlain<T>) {
      take(&value, sizeof value);
    } else {
      std::uint64_t count = 0;
      (*this)(count);
      using Item = typename T::value_type;
      if (count > bytes_.size()) throw Error("the drawing was not handed over whole");
      value.resize(count);
      if constexpr (kPlain<Item>)
        take(value.data(), count * sizeof(Item));
      else
        for (auto& item : value) (*this)(item);
    }
  }

 private:
  void take(void* to, std::size_t size) {
    if (size > bytes_.size()) throw Error("the drawing was not handed over whole");
    if (size > 0) std::memcpy(to, bytes_.data(), size);
    bytes_.remove_prefix(size);
  }
  std::string_view bytes_;
};

template <class Bytes, class Vectors>
void each_of(Bytes& bytes, std::optional<Vectors>& vectors) {
  auto there = static_cast<std::uint8_t>(vectors.has_value());
  bytes(there);
  if (there == 0) return;
  if (!vectors) vectors.emplace();
  bytes(vectors->walls), bytes(vectors->rejected);
}

template <class Bytes>
void each_of(Bytes& bytes, Plan& plan) {
  GrayImage& picture = plan.picture;
  bytes(picture.width_px), bytes(picture.height_px), bytes(picture.pixels), bytes(picture.dpi);
  bytes(picture.red_green), bytes(picture.yellow_blue);
  each_of(bytes, plan.vectors);
  bytes(plan.m_per_px), bytes(plan.scale_method), bytes(plan.notes), bytes(plan.left_out);
}

}  // namespace

std::string plan_bytes(const Plan& plan) {
  Out out;
  Plan copy = plan;  // one list of fields serves both directions
  each_of(out, copy);
  return std::move(out.bytes);
}

Plan plan_of(std::string_view bytes) {
  In in(bytes);
  Plan plan;
  each_of(in, plan);
  return plan;
}

}  // namespace madori::mapping
