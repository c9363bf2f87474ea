#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace madori::mapping {

/// What is known of every line of a drawing, a named column a feature. All are relative to the drawing's own
/// size, pen and greys, so that they mean the same on every sheet.
class FeatureTable {
 public:
  explicit FeatureTable(std::size_t rows) : rows_(rows) {}

  void add(std::string name, std::vector<float> column) {
    names_.push_back(std::move(name));
    columns_.push_back(std::move(column));
  }
  /// A column of value(row) for each row.
  template <class Value>
  void fill(std::string name, Value value) {
    std::vector<float> column;
    column.reserve(rows_);
    for (std::size_t i = 0; i < rows_; ++i) column.push_back(static_cast<float>(value(i)));
    add(std::move(name), std::move(column));
  }
  /// The columns of another table of the same lines behind these.
  void add(const FeatureTable& other) {
    for (std::size_t k = 0; k < other.names_.size(); ++k) add(other.names_[k], other.columns_[k]);
  }
  [[nodiscard]] std::size_t rows() const { return rows_; }
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  [[nodiscard]] float at(std::size_t row, std::size_t column) const { return columns_[column][row]; }
  /// The values of one line, in the order of names().
  [[nodiscard]] std::vector<float> row(std::size_t row) const {
    std::vector<float> values;
    values.reserve(columns_.size());
    for (const auto& column : columns_) values.push_back(column[row]);
    return values;
  }

 private:
  std::size_t rows_;
  std::vector<std::string> names_;
  std::vector<std::vector<float>> columns_;
};

}  // namespace madori::mapping
