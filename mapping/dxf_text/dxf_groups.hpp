#pragma once

#include <string>
#include <string_view>

#include "mapping/dxf_text/dxf_text.hpp"

namespace madori::mapping {

/// Follows the pairs of lines (group code, value) of a text DXF.
class DxfGroups {
 public:
  /// Whole lines, in the order of the file.
  void add(std::string_view lines);
  [[nodiscard]] const DxfText& text() const { return text_; }

 private:
  void take(int code, std::string_view value);
  void begin(std::string_view kind);
  void end_block();
  void take_of_block(int code, std::string_view value);

  DxfText text_;
  int code_ = 0;
  bool is_value_ = false;
  std::string section_, entity_;  ///< in which the pairs stand
  std::optional<int>* variable_ = nullptr;
  std::string block_;  ///< the file or the name of the block that began last
  bool attached_ = false, any_content_ = true;
};

}  // namespace madori::mapping
