#pragma once

#include <cstring>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.hpp"

namespace madori::mapping {

/// Takes a model file's bytes from front to back: lines of words, and rows of numbers as memory holds them.
/// Throws Error, naming the file, where they are not what was asked for.
class ModelBytes {
 public:
  ModelBytes(std::string file, std::string_view bytes) : file_(std::move(file)), bytes_(bytes) {}

  void demand(bool holds) const {
    if (!holds) throw Error(file_, "is no wall model of this version", "train it again: train_walls");
  }

  template <class... Words>
  void take_line(Words&... words) {
    const std::size_t end = bytes_.find('\n');
    demand(end != std::string_view::npos);
    std::istringstream line{std::string(bytes_.substr(0, end))};
    bytes_.remove_prefix(end + 1);
    demand(static_cast<bool>((line >> ... >> words)));
  }

  template <class T>
  std::vector<T> take(std::size_t count) {
    demand(count <= bytes_.size() / sizeof(T));
    std::vector<T> values(count);
    if (count > 0) std::memcpy(values.data(), bytes_.data(), count * sizeof(T));
    bytes_.remove_prefix(count * sizeof(T));
    return values;
  }

 private:
  std::string file_;
  std::string_view bytes_;
};

}  // namespace madori::mapping
