#include <algorithm>
#include <chrono>
#include <fstream>
#include <iterator>
#include <thread>

#include "hmi/server/api.hpp"
#include "hmi/server/api_support.hpp"
#include "mapping/georeference/apply_scale.hpp"
#include "mapping/georeference/control_points.hpp"
#include "mapping/georeference/known_lengths.hpp"
#include "mapping/georeference/tile_store.hpp"
#include "mapping/site/site.hpp"

namespace madori::hmi {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// known: [u1, v1, u2, v2, metres] each.
mapping::ScaleEstimate fit_known(const json& rows) {
  std::vector<mapping::KnownLength> lengths;
  for (const auto& row : rows) {
    std::ostringstream text;
    text.precision(10);
    text << row.at(0).get<double>() << ',' << row.at(1).get<double>() << ',' << row.at(2).get<double>() << ','
         << row.at(3).get<double>() << '=' << row.at(4).get<double>();
    lengths.push_back(mapping::parse_known_length(text.str()));
  }
  return mapping::fit_known_lengths(lengths);
}

/// control: [u, v, latitude, longitude] each.
mapping::ScaleEstimate fit_control(const json& rows, int height_px) {
  std::vector<mapping::ControlPoint> points;
  for (const auto& row : rows) {
    std::ostringstream text;
    text.precision(12);
    text << row.at(0).get<double>() << ',' << row.at(1).get<double>() << '=' << row.at(2).get<double>() << ','
         << row.at(3).get<double>();
    points.push_back(mapping::parse_control_point(text.str()));
  }
  return mapping::fit_control_points(points, height_px);
}

const char* verdict_of(const mapping::ScaleEstimate& estimate) {
  if (estimate.verdict == mapping::Verdict::Refused) return "refused";
  if (!estimate.verified) return "unverified";
  return estimate.verdict == mapping::Verdict::Good ? "good" : "usable";
}

json to_wire(const mapping::ScaleEstimate& estimate, bool applied) {
  json residuals = json::array();
  for (std::size_t i = 0; i < estimate.residuals_m.size(); ++i)
    residuals.push_back({{"label", i < estimate.inputs.size() ? estimate.inputs[i] : ""},
                         {"residual_m", estimate.residuals_m[i]},
                         {"outlier", estimate.outlier == i}});
  std::string text = estimate.reason;
  for (const auto& note : estimate.notes) text += (text.empty() ? "" : ". ") + note;
  return {{"m_per_px", estimate.m_per_px},
          {"relative_uncertainty", estimate.relative_uncertainty},
          {"residuals", residuals},
          {"verdict", verdict_of(estimate)},
          {"text", text},
          {"mirrored", estimate.mirrored},
          {"applied", applied}};
}

json measure(ApiContext& context, const json& request) {
  const fs::path& folder = context.editor.folder();
  const mapping::Site site = mapping::load_site(folder);
  const bool by_photo = request.contains("control") && !request["control"].empty();
  if (!by_photo && (!request.contains("known") || request["known"].empty()))
    throw Error("the scale", "needs at least one measurement", "tap both ends of a known length");
  const auto estimate =
      by_photo ? fit_control(request["control"], site.drawing.height_px) : fit_known(request["known"]);
  const bool apply = request.at("apply").get<bool>();
  if (apply) {
    if (estimate.verdict == mapping::Verdict::Refused)
      throw Error("the scale", "is refused: " + estimate.reason, "measure again");
    mapping::apply_scale(folder, estimate, context.iso_time(), context.stage_scaled);
    (void)context.vehicle.reload_site();
  }
  return to_wire(estimate, apply);
}

/// The tiles on the disk and whom to name for them.
json saved_tiles(const fs::path& folder) {
  json wire{{"source", ""}, {"attribution", ""}, {"zoom", 0}, {"tiles", json::array()}};
  std::ifstream stream(folder / "source.json");
  const json source = json::parse(stream, nullptr, false);
  if (!source.is_object()) return wire;
  wire["source"] = source.value("name", "");
  wire["attribution"] = source.value("attribution", "");
  std::error_code missing;
  for (const auto& file : fs::recursive_directory_iterator(folder, missing)) {
    const std::string extension = file.path().extension().string();
    if (extension != ".jpg" && extension != ".png") continue;
    const auto column = file.path().parent_path();
    const int zoom = std::atoi(column.parent_path().filename().c_str());
    if (zoom < wire["zoom"].get<int>()) continue;
    if (zoom > wire["zoom"].get<int>()) wire["tiles"].clear();
    wire["zoom"] = zoom;
    wire["tiles"].push_back({std::atoi(column.filename().c_str()), std::atoi(file.path().stem().c_str())});
  }
  return wire;
}

bool is_number(const std::string& text) {
  return !text.empty() && text.size() < 10 &&
         std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
}

Response tile(const fs::path& folder, const Request& request) {
  if (!std::ranges::all_of(request.captures, is_number))
    return Response::error(404, "not-found", "there is no such tile");
  const fs::path file = folder / request.captures[0] / request.captures[1] / request.captures[2];
  for (const auto& [extension, type] : {std::pair(".jpg", "image/jpeg"), std::pair(".png", "image/png")}) {
    std::ifstream stream(file.string() + extension, std::ios::binary);
    if (!stream) continue;
    Response response{200, type, {std::istreambuf_iterator<char>(stream), {}}, {}};
    response.headers["Cache-Control"] = "private, max-age=86400";
    return response;
  }
  return Response::error(404, "not-found", "this tile was not saved");
}

Response fetch_tiles(ApiContext& context, const json& wanted) {
  const mapping::LatLon place{wanted.at("latitude_deg").get<double>(),
                              wanted.at("longitude_deg").get<double>()};
  const auto tiles =
      mapping::tiles_around(place, wanted.at("radius_m").get<double>(), wanted.at("zoom").get<int>());
  const mapping::TileSource source = mapping::find_tile_source(wanted.at("source").get<std::string>());
  const fs::path folder = context.editor.folder() / "tiles";
  const bool started = context.job.start("tiles", [folder, source, tiles](const Job::Progress& progress) {
    const mapping::TileStore store(folder, source);
    const auto report = mapping::download_tiles(
        store, tiles, mapping::http_fetcher(), [](auto pause) { std::this_thread::sleep_for(pause); }, {},
        [&](std::size_t done, std::size_t all) {
          progress(source.name,
                   static_cast<double>(done) / static_cast<double>(std::max<std::size_t>(all, 1)));
        });
    return std::to_string(report.fetched) + " tiles";
  });
  if (!started) return Response::error(409, "busy", "the server is busy with other work");
  return answer(context.job.state());
}

}  // namespace

void add_scale_routes(Router& router, ApiContext& context) {
  const fs::path tiles = context.editor.folder() / "tiles";
  router.add("POST", "/api/site/scale", Role::Integrator,
             guarded([&context](const Request& r) { return answer(measure(context, body_of(r))); }), true);
  router.add("GET", "/api/site/tiles", Role::Viewer,
             [tiles](const Request&) { return answer(saved_tiles(tiles)); });
  router.add("POST", "/api/site/tiles", Role::Integrator,
             guarded([&context](const Request& r) { return fetch_tiles(context, body_of(r)); }));
  router.add("GET", "/api/site/tiles/*/*/*", Role::Viewer,
             [tiles](const Request& r) { return tile(tiles, r); });
}

}  // namespace madori::hmi
