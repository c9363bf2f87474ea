#include "mapping/drawing/vector/dxf_lines.hpp"

#include <cpl_conv.h>
#include <cpl_error.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string_view>

#include "core/result.hpp"
#include "mapping/drawing/vector/door_leaves.hpp"
#include "mapping/dxf_text/dxf_text.hpp"

namespace madori::mapping {
namespace {

using Dataset = std::unique_ptr<GDALDataset>;

constexpr std::size_t kMostLines = 5'000'000;
constexpr double kLeastAjar = 0.08, kMostAjar = 1.5;  // radians

Dataset open_dxf(const std::filesystem::path& file) {
  static std::once_flag once;
  std::call_once(once, [] {
    GDALAllRegister();
    CPLSetConfigOption("DXF_INLINE_BLOCKS", "TRUE");
    CPLSetConfigOption("DXF_MERGE_BLOCK_GEOMETRIES", "FALSE");
    CPLSetConfigOption("OGR_ARC_STEPSIZE", "4");
  });
  const char* const drivers[] = {"DXF", nullptr};
  CPLPushErrorHandler(CPLQuietErrorHandler);
  Dataset dataset(GDALDataset::Open(file.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY, drivers));
  CPLPopErrorHandler();
  if (!dataset || dataset->GetLayerCount() == 0)
    throw Error(file.string(), "is no readable DXF", "save it again as ASCII DXF (R2000 or newer)");
  return dataset;
}

std::string field(const OGRFeature& feature, const char* name) {
  const int index = feature.GetFieldIndex(name);
  return index < 0 || feature.IsFieldSetAndNotNull(index) == 0 ? std::string()
                                                               : feature.GetFieldAsString(index);
}

/// 12'-6", 9' and 36" are imperial figures; the 80's are none.
bool is_imperial(const std::string& text) {
  for (std::size_t i = 1; i < text.size(); ++i) {
    if (text[i] != '\'' && text[i] != '"') continue;
    const std::size_t before = text.find_last_not_of(' ', i - 1);
    const std::size_t after = text.find_first_not_of(" -", i + 1);
    const auto is_digit = [&](std::size_t at) { return text[at] >= '0' && text[at] <= '9'; };
    if (before == std::string::npos || !is_digit(before)) continue;
    if (text[i] == '"' || after == std::string::npos || is_digit(after)) return true;
  }
  return false;
}

/// The straight pieces of a curve, each like `line` but for its ends.
void add_points(const OGRSimpleCurve& curve, DxfLine line, std::vector<DxfLine>& lines) {
  for (int i = 0; i + 1 < curve.getNumPoints(); ++i) {
    line.x1 = curve.getX(i), line.y1 = curve.getY(i);
    line.x2 = curve.getX(i + 1), line.y2 = curve.getY(i + 1);
    if (std::isfinite(line.length()) && line.length() > 0.0 && lines.size() < kMostLines)
      lines.push_back(line);
  }
}

/// One entity's share of all lines.
void add_lines(const OGRGeometry& geometry, const DxfLine& like, std::vector<DxfLine>& lines) {
  const auto add_parts = [&](const auto& parts) {
    for (const auto* part : parts) add_lines(*part, like, lines);
  };
  switch (wkbFlatten(geometry.getGeometryType())) {
    case wkbLineString:
      return add_points(*geometry.toLineString(), like, lines);
    case wkbPolygon:
      return add_parts(*geometry.toPolygon());
    case wkbPolyhedralSurface:
      return add_parts(*geometry.toPolyhedralSurface());
    case wkbMultiLineString:
    case wkbMultiPolygon:
    case wkbGeometryCollection:
      return add_parts(*geometry.toGeometryCollection());
    default:
      return;  // points hold no lines
  }
}

/// What tells an arc from another line.
struct Curve {
  DxfPoint from, middle, to;
  double length = 0;
};

std::optional<Curve> curve_of(const OGRGeometry& geometry) {
  if (wkbFlatten(geometry.getGeometryType()) != wkbLineString) return std::nullopt;
  const auto& line = *geometry.toLineString();
  const int last = line.getNumPoints() - 1;
  if (last < 2) return std::nullopt;
  const auto at = [&](int i) { return DxfPoint{line.getX(i), line.getY(i)}; };
  return Curve{at(0), at(last / 2), at(last), line.get_Length()};
}

/// The curve where it is about a quarter of a circle.
std::optional<DoorSwing> quarter_arc(const OGRGeometry& geometry) {
  const auto curve = curve_of(geometry);
  if (!curve) return std::nullopt;
  const auto& [from, middle, to, length] = *curve;
  const double chord = std::hypot(to.x - from.x, to.y - from.y);
  const double share = length / chord;  // pi / (2 sqrt 2) = 1.11 for a quarter
  if (!(share > 1.07 && share < 1.16)) return std::nullopt;
  // The hinge lies half a chord from the chord's middle, on the side that the arc does not bulge to.
  const DxfPoint between{0.5 * (from.x + to.x), 0.5 * (from.y + to.y)};
  const double off = (middle.x - from.x) * (to.y - from.y) - (middle.y - from.y) * (to.x - from.x);
  const double side = off > 0 ? -0.5 : 0.5;
  const DxfPoint hinge{between.x + side * (to.y - from.y), between.y - side * (to.x - from.x)};
  return DoorSwing{hinge, from, to, chord / std::sqrt(2.0)};
}

/// The arc of less than a quarter circle, by the circle through its ends and its middle.
std::optional<DoorSwing> short_arc(const OGRGeometry& geometry) {
  const auto curve = curve_of(geometry);
  if (!curve) return std::nullopt;
  const auto& [from, middle, to, length] = *curve;
  const DxfPoint a{middle.x - from.x, middle.y - from.y}, b{to.x - from.x, to.y - from.y};
  const double twice = 2 * (a.x * b.y - a.y * b.x), aa = a.x * a.x + a.y * a.y, bb = b.x * b.x + b.y * b.y;
  const double u = (b.y * aa - a.y * bb) / twice, v = (a.x * bb - b.x * aa) / twice;
  const double radius = std::hypot(u, v), share = length / radius;  // the angle it turns by
  if (!std::isfinite(share) || share < kLeastAjar || share > kMostAjar) return std::nullopt;
  return DoorSwing{{from.x + u, from.y + v}, from, to, radius};
}

/// What an entity's kind and pen say: GDAL draws what is frozen, off or invisible with a colour #rrggbb00.
std::optional<RejectReason> no_wall(const std::string& classes, const char* pen) {
  const std::string_view style = pen == nullptr ? "" : pen;
  const auto colour = style.find("c:#");
  if (classes.find("Hatch") != std::string::npos) return RejectReason::Hatch;
  if (classes.find("Leader") != std::string::npos) return RejectReason::Dimension;
  if (colour != std::string_view::npos && style.find("00", colour + 9) == colour + 9)
    return RejectReason::Other;
  if (style.find("p:\"") != std::string_view::npos) return RejectReason::Dashed;
  return std::nullopt;
}

void add_feature(const OGRFeature& feature, std::map<std::string, std::size_t>& layers, DxfContent& content) {
  if (is_imperial(field(feature, "Text"))) content.units.imperial_texts = true;
  const OGRGeometry* geometry = feature.GetGeometryRef();
  if (geometry == nullptr) return;
  const std::string layer = field(feature, "Layer");
  const auto [entry, fresh] = layers.try_emplace(layer, content.layers.size());
  if (fresh) content.layers.push_back(layer);
  const std::string classes = field(feature, "SubClasses");
  DxfLine like;
  like.layer = entry->second;
  like.no_wall = no_wall(classes, feature.GetStyleString());
  const bool is_arc = classes.find("AcDbArc") != std::string::npos;
  const auto swing = is_arc ? quarter_arc(*geometry) : std::nullopt;
  if (swing) {
    if (!like.no_wall) like.no_wall = RejectReason::DoorArc;
    content.swings.push_back(*swing);
    content.units.door_radii.push_back(swing->radius);
  }
  const std::size_t first = content.lines.size();
  add_lines(*geometry, like, content.lines);
  if (!is_arc || swing) return;
  if (auto arc = short_arc(*geometry)) {
    arc->first_line = first;
    arc->end_line = content.lines.size();
    content.short_arcs.push_back(*arc);
  }
}

}  // namespace

double DxfLine::length() const {
  return std::hypot(x2 - x1, y2 - y1);
}

DxfContent read_dxf_lines(const std::filesystem::path& file) {
  DxfContent content;
  const DxfText text = read_dxf_text(file);
  CPLSetThreadLocalConfigOption("DXF_ENCODING", text.utf8 ? "UTF-8" : nullptr);
  content.units.insunits = text.insunits;
  content.units.measurement = text.measurement;
  content.unread = unread_notes(text);
  const Dataset dataset = open_dxf(file);
  CPLPushErrorHandler(CPLQuietErrorHandler);
  std::map<std::string, std::size_t> layers;
  for (const char* space : {"PaperSpace IS NULL", "PaperSpace = 1"}) {
    if (!content.lines.empty()) break;
    dataset->GetLayer(0)->SetAttributeFilter(space);
    for (auto&& feature : dataset->GetLayer(0)) add_feature(*feature, layers, content);
  }
  CPLPopErrorHandler();
  mark_door_leaves(content.lines, content.swings);
  mark_doors_ajar(content.lines, content.short_arcs);
  return content;
}

}  // namespace madori::mapping
