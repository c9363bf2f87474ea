#include "mapping/drawing/vector/load_dxf.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <set>
#include <sstream>

#include "core/result.hpp"
#include "mapping/drawing/vector/dxf_layers.hpp"
#include "mapping/drawing/vector/dxf_lines.hpp"
#include "mapping/picture/load_image.hpp"

namespace madori::mapping {
namespace {

constexpr double kMargin = 0.02;  // of the longer side

struct Bounds {
  double x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  [[nodiscard]] double longer() const { return std::max(x1 - x0, y1 - y0); }
  [[nodiscard]] bool holds(const DxfLine& l) const {
    return std::min(l.x1, l.x2) >= x0 && std::max(l.x1, l.x2) <= x1 && std::min(l.y1, l.y2) >= y0 &&
           std::max(l.y1, l.y2) <= y1;
  }
};

/// Between the `low` and the `high` share of all line ends.
std::array<double, 2> range(std::vector<double> values, double low, double high) {
  const auto at = [&](double share) {
    const auto index = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::ranges::nth_element(values, values.begin() + index);
    return values[static_cast<std::size_t>(index)];
  };
  return {at(low), at(high)};
}

/// The box around all lines; without stray entities kilometres away where there are such.
Bounds drawn_bounds(const std::vector<DxfLine>& lines) {
  std::vector<double> xs, ys;
  for (const auto& l : lines) xs.insert(xs.end(), {l.x1, l.x2}), ys.insert(ys.end(), {l.y1, l.y2});
  const auto all_x = range(xs, 0, 1), all_y = range(ys, 0, 1);
  const auto most_x = range(xs, 0.02, 0.98), most_y = range(ys, 0.02, 0.98);
  const Bounds all{all_x[0], all_y[0], all_x[1], all_y[1]};
  const Bounds most{most_x[0], most_y[0], most_x[1], most_y[1]};
  const double reach = most.longer();
  if (!(reach > 0) || all.longer() < 10.0 * reach) return all;
  return {most.x0 - reach, most.y0 - reach, most.x1 + reach, most.y1 + reach};
}

std::vector<LayerMeaning> meanings(const DxfContent& content, const PlanOptions& options,
                                   const std::string& file) {
  std::vector<LayerMeaning> result;
  for (const auto& name : content.layers) {
    if (options.layers.empty()) {
      result.push_back(layer_meaning(name));
    } else {
      const bool named = std::ranges::find(options.layers, name) != options.layers.end();
      result.push_back({named ? LayerKind::Wall : LayerKind::NoWall, RejectReason::Other});
    }
  }
  for (const auto& name : options.layers) {
    if (std::ranges::find(content.layers, name) != content.layers.end()) continue;
    std::string known;
    for (const auto& layer : content.layers) known += (known.empty() ? "" : ", ") + layer;
    throw Error(file, "has no layer \"" + name + "\"", "its layers are: " + known);
  }
  return result;
}

/// Lines on layers without a telling name count as walls unless the named walls make up the drawing.
bool unknown_layers_are_walls(const DxfContent& content, const std::vector<LayerMeaning>& meaning) {
  double named = 0.0, unknown = 0.0;
  for (const auto& line : content.lines) {
    const LayerKind kind = meaning[line.layer].kind;
    if (line.no_wall || line.door_leaf) continue;
    (kind == LayerKind::Wall ? named : unknown) +=
        kind == LayerKind::Wall || kind == LayerKind::Unknown ? line.length() : 0.0;
  }
  return named < unknown;
}

std::optional<RejectReason> rejected(const DxfLine& line, const LayerMeaning& meaning, bool unknown_is_wall,
                                     bool layers_given) {
  if (layers_given) return meaning.kind == LayerKind::Wall ? std::nullopt : std::optional(meaning.reason);
  if (meaning.kind == LayerKind::NoWall && line.no_wall != RejectReason::Hatch) return meaning.reason;
  if (line.no_wall || meaning.kind != LayerKind::Unknown) return line.no_wall;
  if (line.door_leaf) return RejectReason::DoorArc;
  if (!unknown_is_wall) return RejectReason::Other;
  return std::nullopt;
}

GrayImage render(const PlanVectors& vectors, int width, int height) {
  GrayImage image{
      width, height,
      std::vector<std::uint8_t>(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 255), 0};
  cv::Mat view(height, width, CV_8UC1, image.pixels.data());
  const auto at = [](double u, double v) {
    return cv::Point(static_cast<int>(std::lround(16 * u - 8)), static_cast<int>(std::lround(16 * v - 8)));
  };
  for (const auto& r : vectors.rejected)
    cv::line(view, at(r.segment.u1, r.segment.v1), at(r.segment.u2, r.segment.v2), 120, 1, cv::LINE_AA, 4);
  for (const auto& s : vectors.walls) cv::line(view, at(s.u1, s.v1), at(s.u2, s.v2), 0, 2, cv::LINE_AA, 4);
  return image;
}

std::string layer_note(const std::vector<std::string>& layers, const std::set<std::size_t>& used) {
  std::string names;
  for (const std::size_t layer : used) names += (names.empty() ? "" : ", ") + layers[layer];
  return "walls are taken from the layers: " + names;
}

/// Layers that were left out although their names say wall, with the metres (where these are known) that they
/// hold.
void note_doubtful_layers(const DxfContent& content, const std::vector<LayerMeaning>& meaning,
                          double m_per_unit, std::vector<std::string>& notes) {
  std::vector<double> length(content.layers.size());
  for (const auto& line : content.lines) length[line.layer] += line.no_wall ? 0.0 : line.length();
  for (std::size_t i = 0; i < length.size(); ++i) {
    if (!meaning[i].says_wall || !(length[i] > 0)) continue;
    std::ostringstream note;
    note << "the layer " << content.layers[i];
    if (m_per_unit > 0) note << " (" << std::lround(length[i] * m_per_unit) << " m of lines)";
    note << " was not taken: its name says wall, but also something else - where it holds walls, name the "
            "layers "
            "with --layers";
    notes.push_back(note.str());
  }
}

/// The scale from the unit that is named or that explains the drawing, and a note on it.
void set_scale(const DxfContent& content, const PlanOptions& options, double unit_per_px, Plan& plan) {
  const auto unit = options.unit.empty() ? choose_unit(content.units) : named_unit(options.unit);
  if (!unit) {
    plan.notes.emplace_back(
        "no unit, or more than one, gives a plausible building: name it with --unit; the site is unscaled");
    return;
  }
  plan.m_per_px = unit->metres * unit_per_px;
  plan.scale_method = "dxf-units";
  plan.notes.push_back(unit->note);
}

}  // namespace

Plan load_dxf(const std::filesystem::path& file, const PlanOptions& options) {
  DxfContent content = read_dxf_lines(file);
  std::string remedy;
  for (const auto& note : content.unread) remedy += note + "; ";
  if (content.lines.empty()) throw Error(file.string(), "holds no lines", remedy + "export the model space");
  const Bounds bounds = drawn_bounds(content.lines);
  content.units.extent = bounds.longer();
  if (!(bounds.longer() > 0)) throw Error(file.string(), "has no size", "check the drawing in a CAD viewer");
  const auto meaning = meanings(content, options, file.string());
  const bool unknown_is_wall = unknown_layers_are_walls(content, meaning);

  const double unit_per_px = bounds.longer() * (1.0 + 2.0 * kMargin) / kWantedPx;
  const double left = bounds.x0 - kMargin * bounds.longer(), low = bounds.y0 - kMargin * bounds.longer();
  const auto pixels = [&](double drawn) {  // and the margin beyond
    return static_cast<int>(std::ceil(drawn / unit_per_px + kMargin * kWantedPx / (1 + 2 * kMargin)));
  };
  const int width = pixels(bounds.x1 - left), height = pixels(bounds.y1 - low);

  Plan plan;
  plan.vectors.emplace();
  std::set<std::size_t> used;
  for (const auto& line : content.lines) {
    if (!bounds.holds(line)) continue;
    const PixelSegment s{(line.x1 - left) / unit_per_px, height - (line.y1 - low) / unit_per_px,
                         (line.x2 - left) / unit_per_px, height - (line.y2 - low) / unit_per_px};
    if (const auto reason = rejected(line, meaning[line.layer], unknown_is_wall, !options.layers.empty())) {
      plan.vectors->rejected.push_back({s, *reason});
    } else {
      plan.vectors->walls.push_back(s);
      used.insert(line.layer);
    }
  }
  plan.picture = render(*plan.vectors, std::max(width, 1), std::max(height, 1));
  plan.notes.push_back(layer_note(content.layers, used));
  set_scale(content, options, unit_per_px, plan);
  plan.left_out = std::move(content.unread);
  note_doubtful_layers(content, meaning, plan.m_per_px.value_or(0.0) / unit_per_px, plan.left_out);
  if (plan.m_per_px) {
    std::ostringstream origin;
    origin.precision(10);
    origin << "the Map origin is at x = " << left << ", y = " << low << " of the drawing";
    plan.notes.push_back(origin.str());
  }
  return plan;
}

}  // namespace madori::mapping
