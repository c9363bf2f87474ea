#include "app/scale_sources.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "core/result.hpp"
#include "mapping/georeference/control_points.hpp"
#include "mapping/georeference/known_lengths.hpp"
#include "mapping/georeference/number_list.hpp"
#include "mapping/georeference/overlay.hpp"
#include "mapping/georeference/scale_choice.hpp"

namespace madori::app {
namespace {

using mapping::ScaleEstimate;
using mapping::Verdict;
using nlohmann::json;

ScaleEstimate paper(const ScaleInputs& inputs, const mapping::Site& site) {
  const bool written = inputs.paper.starts_with("1:");
  const auto ratio = written ? mapping::parse_numbers(inputs.paper.substr(2)) : std::nullopt;
  if (!ratio || ratio->size() != 1)
    throw Error("--paper " + inputs.paper, "is no scale", "write it as on the drawing, e.g. 1:200");
  return mapping::paper_scale(ratio->front(), inputs.dpi.value_or(site.drawing.dpi));
}

std::vector<ScaleEstimate> given_sources(const ScaleInputs& inputs, const mapping::Site& site) {
  std::vector<ScaleEstimate> sources;
  std::vector<mapping::KnownLength> lengths;
  for (const auto& text : inputs.known) lengths.push_back(mapping::parse_known_length(text));
  mapping::require_on_drawing(lengths, site.drawing);
  if (!lengths.empty()) sources.push_back(mapping::fit_known_lengths(lengths));
  std::vector<mapping::ControlPoint> points;
  for (const auto& text : inputs.control) points.push_back(mapping::parse_control_point(text));
  mapping::require_on_drawing(points, site.drawing);
  if (!points.empty()) sources.push_back(mapping::fit_control_points(points, site.drawing.height_px));
  if (!inputs.overlay.empty())
    sources.push_back(mapping::fit_overlay(mapping::parse_overlay(inputs.overlay), site.drawing.width_px,
                                           site.drawing.height_px));
  if (!inputs.paper.empty()) sources.push_back(paper(inputs, site));
  if (inputs.measured) sources.push_back(*inputs.measured);
  return sources;
}

}  // namespace

bool ScaleInputs::empty() const {
  return known.empty() && control.empty() && overlay.empty() && paper.empty() && !measured;
}

ScaleFindings find_scale(const ScaleInputs& inputs, const mapping::Site& site) {
  ScaleFindings found;
  mapping::ScaleChoice choice = mapping::choose_scale(given_sources(inputs, site));
  found.sources = std::move(choice.sources);
  found.best = std::move(choice.best);
  found.disagreements = std::move(choice.disagreements);
  if (site.scale) {
    found.sources.push_back(mapping::recorded_scale(*site.scale));
    found.sources.back().method = "site.yaml:" + site.scale->method;
    found.disagreements = mapping::disagreements(found.sources);
  }
  return found;
}

json to_json(const ScaleEstimate& e) {
  json notes = json::array();
  for (const auto& note : e.notes) notes.push_back(note.text);
  json out{{"method", e.method},
           {"m_per_px", e.m_per_px},
           {"relative_uncertainty", e.relative_uncertainty},
           {"error_m", e.error_m},
           {"verified", e.verified},
           {"inputs", e.inputs},
           {"residuals_m", e.residuals_m},
           {"leave_one_out_m", e.leave_one_out_m},
           {"mirrored", e.mirrored},
           {"outlier", e.outlier ? json(*e.outlier) : json(nullptr)},
           {"stretch", e.stretch ? json(*e.stretch) : json(nullptr)},
           {"verdict", mapping::to_string(e.verdict)},
           {"reason", e.reason},
           {"notes", notes}};
  if (e.georeference)
    out["georeference"] = {{"latitude_deg", e.georeference->latitude_deg},
                           {"longitude_deg", e.georeference->longitude_deg},
                           {"enu_from_map_yaw_deg", e.georeference->enu_from_map_yaw_deg}};
  return out;
}

std::string describe(const ScaleEstimate& e) {
  std::string text =
      fmt::format("{}: {:.6g} m/px +- {:.2f} %", e.method, e.m_per_px, 100.0 * e.relative_uncertainty);
  if (e.error_m > 0.0) text += fmt::format(", error {:.3f} m", e.error_m);
  text += '\n';
  for (std::size_t i = 0; i < e.residuals_m.size(); ++i) {
    text += fmt::format("  {:>2}  {}  residual {:+.3f} m", i + 1, e.inputs[i], e.residuals_m[i]);
    if (i < e.leave_one_out_m.size())
      text += fmt::format(", {:.3f} m off the others' prediction", e.leave_one_out_m[i]);
    text += e.outlier == i ? "  <- contradicts the others\n" : "\n";
  }
  if (e.georeference)
    text += fmt::format("  lower left corner at {:.7f}, {:.7f}; x axis {:.2f} deg north of east\n",
                        e.georeference->latitude_deg, e.georeference->longitude_deg,
                        e.georeference->enu_from_map_yaw_deg);
  for (const auto& note : e.notes) text += "  note: " + note.text + '\n';
  return text + "  " + mapping::to_string(e.verdict) + ": " + e.reason + '\n';
}

}  // namespace madori::app
