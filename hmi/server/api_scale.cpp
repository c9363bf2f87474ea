#include <fmt/format.h>

#include <sstream>

#include "hmi/server/api.hpp"
#include "hmi/server/api_support.hpp"
#include "mapping/georeference/apply_scale.hpp"
#include "mapping/georeference/control_points.hpp"
#include "mapping/georeference/known_lengths.hpp"
#include "mapping/georeference/overlay.hpp"
#include "mapping/georeference/scale_choice.hpp"
#include "mapping/site/site.hpp"

namespace madori::hmi {
namespace {

namespace fs = std::filesystem;
using mapping::ScaleEstimate;
using nlohmann::json;

/// known: [u1, v1, u2, v2, metres] each.
mapping::ScaleEstimate fit_known(const json& rows, const mapping::DrawingRecord& drawing) {
  std::vector<mapping::KnownLength> lengths;
  for (const auto& row : rows) {
    std::ostringstream text;
    text.precision(10);
    text << row.at(0).get<double>() << ',' << row.at(1).get<double>() << ',' << row.at(2).get<double>() << ','
         << row.at(3).get<double>() << '=' << row.at(4).get<double>();
    lengths.push_back(mapping::parse_known_length(text.str()));
  }
  mapping::require_on_drawing(lengths, drawing);
  return mapping::fit_known_lengths(lengths);
}

/// control: [u, v, latitude, longitude] each.
mapping::ScaleEstimate fit_control(const json& rows, const mapping::DrawingRecord& drawing) {
  std::vector<mapping::ControlPoint> points;
  for (const auto& row : rows) {
    std::ostringstream text;
    text.precision(12);
    text << row.at(0).get<double>() << ',' << row.at(1).get<double>() << '=' << row.at(2).get<double>() << ','
         << row.at(3).get<double>();
    points.push_back(mapping::parse_control_point(text.str()));
  }
  mapping::require_on_drawing(points, drawing);
  return mapping::fit_control_points(points, drawing.height_px);
}

/// Overlay of hmi/schema, by the same parser and limits as `madori scale --overlay`.
mapping::Overlay overlay_from(const json& o) {
  std::string text = fmt::format("zoom={},lat={:.12g},lon={:.12g},layout={:.12g},photo={:.12g}",
                                 whole_number<int>(o.at("zoom")), o.at("latitude_deg").get<double>(),
                                 o.at("longitude_deg").get<double>(), o.at("layout_zoom").get<double>(),
                                 o.at("photo_zoom").get<double>());
  if (o.contains("tile_px")) text += fmt::format(",tile={:.12g}", o["tile_px"].get<double>());
  for (const char* key : {"rotation_deg", "east_m", "north_m", "u", "v"})
    if (o.contains(key)) text += fmt::format(",{}={:.12g}", key, o[key].get<double>());
  return mapping::parse_overlay(text);
}

const char* verdict_of(const mapping::ScaleEstimate& estimate) {
  if (estimate.verdict == mapping::Verdict::Refused) return "refused";
  if (!estimate.verified) return "unverified";
  return estimate.verdict == mapping::Verdict::Good ? "good" : "usable";
}

/// The published numbers for a scale: Z_m = U * R_t * Z_p / L_t, Eq. (9) of the layout-map paper.
json overlay_to_wire(double m_per_px, const mapping::Overlay& view) {
  const double side_m = mapping::tile_side_m(view.place.latitude_deg, view.zoom);
  return {{"zoom", view.zoom},
          {"tile_side_m", side_m},
          {"tile_px", view.tile_pixels},
          {"photo_zoom", view.photo_zoom},
          {"layout_zoom", m_per_px * view.tile_pixels * view.photo_zoom / side_m}};
}

json residuals_to_wire(const ScaleEstimate& estimate) {
  json residuals = json::array();
  for (std::size_t i = 0; i < estimate.residuals_m.size(); ++i)
    residuals.push_back({{"label", i < estimate.inputs.size() ? estimate.inputs[i] : ""},
                         {"residual_m", estimate.residuals_m[i]},
                         {"outlier", estimate.outlier == i}});
  return residuals;
}

/// A code for the panel's catalogues beside the reason in English.
Notice reason_of(const ScaleEstimate& e, bool disagreement) {
  const auto percent = fmt::format("{:.2g}", 100.0 * e.relative_uncertainty);
  const std::string number = e.outlier ? std::to_string(*e.outlier + 1) : "";
  if (disagreement) return {"scale-disagreement", {}, e.reason};
  if (e.mirrored) return {"scale-mirrored", {}, e.reason};
  if (e.outlier) return {"scale-outlier", {{"number", number}}, e.reason};
  if (e.verdict == mapping::Verdict::Refused) return {"scale-uncertain", {{"percent", percent}}, e.reason};
  if (!e.verified) return {"scale-unverified", {{"percent", percent}}, e.reason};
  return {
      e.verdict == mapping::Verdict::Good ? "scale-good" : "scale-usable", {{"percent", percent}}, e.reason};
}

json to_wire(const mapping::ScaleChoice& choice, const std::optional<mapping::Overlay>& view, bool applied) {
  const ScaleEstimate& best = choice.best;
  json notes = json::array();
  std::string text = best.reason;
  for (const auto& note : best.notes) {
    notes.push_back(to_wire(Notice{note.code, note.values, note.text}));
    text += (text.empty() ? "" : ". ") + note.text;
  }
  json georeference = nullptr;
  if (const auto& g = best.georeference)
    georeference = {{"latitude_deg", g->latitude_deg},
                    {"longitude_deg", g->longitude_deg},
                    {"enu_from_map_yaw_deg", g->enu_from_map_yaw_deg}};
  return {{"method", best.method},
          {"m_per_px", best.m_per_px},
          {"relative_uncertainty", best.relative_uncertainty},
          {"residuals", residuals_to_wire(best)},
          {"verdict", verdict_of(best)},
          {"reason", to_wire(reason_of(best, !choice.disagreements.empty()))},
          {"notes", notes},
          {"text", text},
          {"mirrored", best.mirrored},
          {"georeference", georeference},
          {"overlay", view ? overlay_to_wire(best.m_per_px, *view) : json(nullptr)},
          {"disagreements", choice.disagreements},
          {"applied", applied}};
}

/// The photograph at its own size, at the zoom that most sources end with.
mapping::Overlay view_at(const mapping::GeoreferenceRecord& place) {
  mapping::Overlay view;
  view.zoom = 18;
  view.place = {place.latitude_deg, place.longitude_deg};
  view.photo_zoom = 1.0;
  return view;
}

bool given(const json& request, const char* name) {
  return request.contains(name) && !request[name].empty();
}

json measure(ApiContext& context, const json& request) {
  const fs::path& folder = context.editor.folder();
  const mapping::Site site = mapping::load_site(folder);
  std::optional<mapping::Overlay> view;
  std::vector<ScaleEstimate> sources;
  if (given(request, "known")) sources.push_back(fit_known(request["known"], site.drawing));
  if (given(request, "control")) sources.push_back(fit_control(request["control"], site.drawing));
  if (given(request, "overlay")) {
    view = overlay_from(request["overlay"]);
    sources.push_back(mapping::fit_overlay(*view, site.drawing.width_px, site.drawing.height_px));
  }
  if (sources.empty())
    throw Error("the scale", "needs at least one measurement", "tap both ends of a known length");
  if (const auto g = sources.front().georeference; g && !view) view = view_at(*g);
  const mapping::ScaleChoice choice = mapping::choose_scale(std::move(sources));
  const bool apply = request.at("apply").get<bool>();
  if (apply) {
    if (choice.best.verdict == mapping::Verdict::Refused && !request.value("force", false))
      throw Error("the scale", "is refused: " + choice.best.reason, "measure again");
    mapping::apply_scale(folder, choice.best, context.iso_time(), context.stage_scaled);
  }
  return to_wire(choice, view, apply);
}

}  // namespace

void add_scale_routes(Router& router, ApiContext& context) {
  const auto ask = answering([&](const Request& r) { return measure(context, body_of(r)); });
  const auto change =
      changing(context.vehicle, [&](const Request& r) { return measure(context, body_of(r)); });
  router.add("POST", "/api/site/scale", Role::Integrator, guarded([ask, change](const Request& r) {
               return body_of(r).at("apply").get<bool>() ? change(r) : ask(r);
             }),
             Work::Worker);
}

}  // namespace madori::hmi
