#include "hmi/server/api.hpp"
#include "hmi/server/api_support.hpp"
#include "hmi/server/site_files.hpp"
#include "mapping/days/day_archive.hpp"
#include "mapping/days/day_changes.hpp"
#include "mapping/days/day_file.hpp"
#include "mapping/days/map_frame.hpp"

namespace madori::hmi {
namespace {

namespace fs = std::filesystem;
using mapping::CivilDay;
using mapping::DayChange;
using mapping::DayMap;
using nlohmann::json;

std::string frame_of(const fs::path& folder) {
  return mapping::map_frame(folder, mapping::load_site(folder));
}

/// A date of the address. Nothing but a date gets on to a file's name.
CivilDay day_of(const Request& request, std::size_t capture) {
  const std::string& text = request.captures.at(capture);
  const auto day = mapping::civil_day(text);
  if (!day) throw Error("day " + text.substr(0, 40), "is no date", "reload the page");
  return *day;
}

/// Where the picture's corners lie, metres of the Map frame.
json day_json(const DayMap& map) {
  const double x = map.column * map.cell_m, y = map.row * map.cell_m;
  return {{"date", mapping::to_text(map.day)},
          {"extent", {x, y, x + map.width * map.cell_m, y + map.height * map.cell_m}}};
}

const char* word_of(mapping::ChangeKind kind) {
  switch (kind) {
    case mapping::ChangeKind::Gone:
      return "gone";
    case mapping::ChangeKind::New:
      return "new";
    case mapping::ChangeKind::Moved:
      return "moved";
  }
  return "";
}

json change_json(const DayChange& change) {
  json wire{{"kind", word_of(change.kind)},
            {"x", change.centre.x_m},
            {"y", change.centre.y_m},
            {"width_m", change.width_m},
            {"height_m", change.height_m},
            {"cells", change.cells},
            {"from", nullptr},
            {"before", mapping::to_text(change.before)},
            {"since", mapping::to_text(change.since)}};
  if (change.from) wire["from"] = {change.from->x_m, change.from->y_m};
  return wire;
}

json days_json(const fs::path& folder) {
  json wire{{"days", json::array()}, {"skipped", json::array()}, {"of_other_frames", 0}};
  if (!has_site(folder)) return wire;
  const auto loaded = mapping::list_days(folder, frame_of(folder));
  for (const DayMap& day : loaded.days) wire["days"].push_back(day_json(day));
  wire["skipped"] = loaded.skipped;
  wire["of_other_frames"] = loaded.of_other_frames;
  return wire;
}

Response day_picture(const fs::path& folder, const Request& request) {
  const auto day = mapping::load_day(folder, day_of(request, 0));
  if (!day.ok()) return Response::error(404, "not-found", day.reason());
  Response response{200, "image/png", mapping::day_png(day.value()), {}, {}};
  response.headers["Cache-Control"] = "no-store";  // today's is written again and again
  return response;
}

Response changes(const fs::path& folder, const Request& request) {
  const CivilDay first = day_of(request, 0), second = day_of(request, 1);
  const auto [from, to] = std::minmax(first, second);
  std::vector<DayMap> days;
  if (has_site(folder)) days = mapping::load_days(folder, frame_of(folder), from, to).days;
  if (days.empty() || days.front().day != from || days.back().day != to)
    return Response::error(404, "not-found", "there is no map of one of these days");
  const auto another_cell = [&](const DayMap& day) { return day.cell_m != days.back().cell_m; };
  if (another_cell(days.front()))
    return Response::error(404, "not-found", "the map's cells had another size on one of these days");
  std::erase_if(days, another_cell);
  json list = json::array();
  for (const DayChange& change : mapping::changes_between(days)) list.push_back(change_json(change));
  return answer({{"from", mapping::to_text(from)}, {"to", mapping::to_text(to)}, {"changes", list}});
}

}  // namespace

void add_day_routes(Router& router, ApiContext& context) {
  const fs::path folder = context.editor.folder();
  router.add("GET", "/api/site/days", Role::Viewer,
             answering([folder](const Request&) { return days_json(folder); }), Work::Worker);
  router.add("GET", "/api/site/days/*/map.png", Role::Viewer,
             guarded([folder](const Request& r) { return day_picture(folder, r); }), Work::Worker);
  router.add("GET", "/api/site/days/*/against/*", Role::Viewer,
             guarded([folder](const Request& r) { return changes(folder, r); }), Work::Worker);
}

}  // namespace madori::hmi
