#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace madori::mapping {

/// What the group codes of a text DXF say that GDAL does not pass on (AutoCAD DXF reference).
struct DxfText {
  bool utf8 = true;                          ///< valid UTF-8, whatever code page the header names
  std::optional<int> insunits, measurement;  ///< header $INSUNITS, 0 = unitless; $MEASUREMENT, 1 = metric
  std::map<std::string, std::size_t>
      unread;                           ///< entities that GDAL skips and that may be walls, by their kind
  std::vector<std::string> references;  ///< files that are attached (XREF) and not bound
};

/// Reads the whole file. Throws Error for what GDAL would read half (no EOF at the end) or never end on (zero
/// bytes).
[[nodiscard]] DxfText read_dxf_text(const std::filesystem::path& file);

/// What of a DXF was not read, each with its remedy, in words.
[[nodiscard]] std::vector<std::string> unread_notes(const DxfText& text);

}  // namespace madori::mapping
