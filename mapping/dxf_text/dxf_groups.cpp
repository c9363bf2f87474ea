#include "mapping/dxf_text/dxf_groups.hpp"

#include <algorithm>
#include <array>
#include <charconv>

#include "core/utf8.hpp"

namespace madori::mapping {
namespace {

/// Entities that GDAL delivers, and those in which no wall stands. What is in neither list may be a wall.
constexpr std::array<std::string_view, 23> kRead{
    "LINE",   "POLYLINE", "LWPOLYLINE", "VERTEX",    "SEQEND", "CIRCLE", "ELLIPSE",    "ARC",
    "SPLINE", "HELIX",    "3DFACE",     "INSERT",    "MLINE",  "SOLID",  "TRACE",      "HATCH",
    "POINT",  "LEADER",   "MLEADER",    "DIMENSION", "TEXT",   "MTEXT",  "MULTILEADER"};
constexpr std::array<std::string_view, 16> kNoWalls{
    "ATTRIB",    "ATTDEF",   "VIEWPORT",       "WIPEOUT",
    "OLE2FRAME", "OLEFRAME", "XLINE",          "RAY",
    "TOLERANCE", "SHAPE",    "ACAD_TABLE",     "ARC_DIMENSION",
    "LIGHT",     "RTEXT",    "ARCALIGNEDTEXT", "LARGE_RADIAL_DIMENSION"};

std::string_view trimmed_group(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\r')) text.remove_suffix(1);
  return text;
}

std::optional<int> whole_number(std::string_view text) {
  int value = 0;
  if (std::from_chars(text.data(), text.data() + text.size(), value).ec != std::errc()) return std::nullopt;
  return value;
}

template <std::size_t kCount>
bool holds(const std::array<std::string_view, kCount>& kinds, std::string_view kind) {
  return std::ranges::find(kinds, kind) != kinds.end();
}

}  // namespace

void DxfGroups::add(std::string_view lines) {
  text_.utf8 = text_.utf8 && utf8_end(lines) == lines.size();
  while (!lines.empty()) {
    const std::size_t end = lines.find('\n');
    const std::string_view line = trimmed_group(lines.substr(0, end));
    if (is_value_)
      take(code_, line);
    else
      code_ = whole_number(line).value_or(-1);
    is_value_ = !is_value_;
    lines.remove_prefix(end == std::string_view::npos ? lines.size() : end + 1);
  }
}

void DxfGroups::take(int code, std::string_view value) {
  if (code == 0) return begin(value);
  if (section_ == "BLOCKS" && entity_ == "BLOCK") return take_of_block(code, value);
  if (code == 2 && entity_ == "SECTION" && section_.empty()) section_ = value;
  if (section_ != "HEADER") return;
  if (code == 70 && variable_ != nullptr) *variable_ = whole_number(value);
  if (code == 9)
    variable_ = value == "$INSUNITS"      ? &text_.insunits
                : value == "$MEASUREMENT" ? &text_.measurement
                                          : nullptr;
}

void DxfGroups::begin(std::string_view kind) {
  entity_ = kind;
  if (kind == "ENDSEC") section_.clear();
  if (section_ != "ENTITIES" && section_ != "BLOCKS") return;
  if (kind == "BLOCK") {
    block_.clear();
    attached_ = any_content_ = false;
  } else if (kind == "ENDBLK") {
    end_block();
  } else {
    any_content_ = true;
    if (!holds(kRead, kind) && !holds(kNoWalls, kind)) ++text_.unread[std::string(kind)];
  }
}

/// Of the block itself: its name, its flags, and the path of the file that it stands for.
void DxfGroups::take_of_block(int code, std::string_view value) {
  constexpr unsigned kAttachedOrOverlaid = 4U | 8U;
  if ((code == 2 && block_.empty()) || (code == 1 && !value.empty())) block_ = value;
  if (code == 70)
    attached_ = (static_cast<unsigned>(whole_number(value).value_or(0)) & kAttachedOrOverlaid) != 0;
}

void DxfGroups::end_block() {
  if (attached_ && !any_content_) text_.references.push_back(block_);
  attached_ = false;
}

}  // namespace madori::mapping
