#include "tests/bench/buildings/drive_report.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>

namespace madori::bench {
namespace {

using nlohmann::json;

constexpr const char* kHead =
    "place: seconds to the first place, and its error; tap: taps used; help: further helps; done: "
    "deliveries\n"
    "of asked; hit: contacts moving+standing; LOC DEG AMB LOST: % of the time; LOC2: % of the way after the\n"
    "first lap; raw, aligned: metric error mean/p95/most, aligned: after the best rigid motion of the whole "
    "way;\n"
    "sure: seconds LOCALIZED while more than 1 m off (raw, aligned); station: visits at which every drawn\n"
    "clearance holds within 0.15 m, of those at which a place near by holds them, of all; cpu: seconds.\n";

std::string errors(const json& e) {
  return fmt::format("{:.2f}/{:.2f}/{:.2f}", e["mean_m"].get<double>(), e["p95_m"].get<double>(),
                     e["most_m"].get<double>());
}

double percent(const json& share) {
  return 100.0 * share.get<double>();
}

void add(json& sum, const json& start) {
  for (const char* key : {"taps", "asked", "delivered"}) sum[key] = sum.value(key, 0) + start[key].get<int>();
  sum["helps"] = sum.value("helps", 0) + static_cast<int>(start["helps"].size());
  sum["hits"] = sum.value("hits", 0) + static_cast<int>(start["collisions_moving"].size());
  for (const char* key : {"good", "possible", "judged"})
    sum[key] = sum.value(key, 0) + start["stations"][key].get<int>();
  for (const char* key : {"raw", "aligned"})
    sum[key] = sum.value(key, 0.0) + start[key]["wrongly_sure_s"].get<double>();
  sum["cpu_s"] = sum.value("cpu_s", 0.0) + start["cpu_s"].get<double>();
  sum["placed"] = sum.value("placed", 0) + (start["first_place_s"].is_null() ? 0 : 1);
  sum["starts"] = sum.value("starts", 0) + 1;
}

}  // namespace

void print_head() {
  std::printf("%s\n%-16s %6s %6s %3s %4s %7s %5s %4s %4s %4s %4s %5s %-16s %-16s %11s %9s %5s\n", kHead,
              "start", "place", "off_m", "tap", "help", "done", "hit", "LOC", "DEG", "AMB", "LOST", "LOC2",
              "raw", "aligned", "sure", "station", "cpu");
}

void print_row(const json& f) {
  const std::string name = f["name"];
  if (!f.value("error", "").empty()) {
    std::printf("%-16s %s\n", name.c_str(), f["error"].get<std::string>().c_str());
    return;
  }
  const json& time = f["time_share"];
  const json& stations = f["stations"];
  const std::string place =
      f["first_place_s"].is_null() ? "never" : fmt::format("{:.1f}", f["first_place_s"].get<double>());
  fmt::print("{:16} {:>6} {:6.2f} {:3} {:4} {:3} /{:3} {:2}+{:2} {:4.0f} {:4.0f} {:4.0f} {:4.0f} {:5.1f} ",
             name, place, f["first_place_error_m"].get<double>(), f["taps"].get<int>(), f["helps"].size(),
             f["delivered"].get<int>(), f["asked"].get<int>(), f["collisions_moving"].size(),
             f["collisions_standing"].size(), percent(time["LOCALIZED"]), percent(time["DEGRADED"]),
             percent(time["AMBIGUOUS"]), percent(time["LOST"]),
             percent(f["after_lap_way_share"]["LOCALIZED"]));
  fmt::print("{:16} {:16} {:5.0f} {:5.0f} {:2}/{:2}/{:2} {:5.0f}{}\n", errors(f["raw"]["all"]),
             errors(f["aligned"]["all"]), f["raw"]["wrongly_sure_s"].get<double>(),
             f["aligned"]["wrongly_sure_s"].get<double>(), stations["good"].get<int>(),
             stations["possible"].get<int>(), stations["judged"].get<int>(), f["cpu_s"].get<double>(),
             f["gave_up"].get<bool>() ? " gave up" : "");
  std::fflush(stdout);
}

void print_sums(const std::vector<json>& starts) {
  std::map<std::string, json> sums;
  for (const json& start : starts) {
    if (!start.value("error", "").empty()) continue;
    const std::string name = start["name"];
    for (const std::string& key : {name.substr(0, name.find('/')), std::string("~ all")})
      add(sums.try_emplace(key, json::object()).first->second, start);
  }
  std::printf("\n");
  for (const auto& [name, s] : sums)
    fmt::print(
        "{:16} {} of {} starts found a place, {} taps, {} helps, {} of {} deliveries, {} contacts moving, "
        "LOCALIZED > 1 m off {:.0f} s raw, {:.0f} s aligned, stations {} of {} ({} possible), {:.0f} s cpu\n",
        name, s["placed"].get<int>(), s["starts"].get<int>(), s["taps"].get<int>(), s["helps"].get<int>(),
        s["delivered"].get<int>(), s["asked"].get<int>(), s["hits"].get<int>(), s["raw"].get<double>(),
        s["aligned"].get<double>(), s["good"].get<int>(), s["judged"].get<int>(), s["possible"].get<int>(),
        s["cpu_s"].get<double>());
}

std::string to_csv(const std::vector<json>& starts) {
  static const std::vector<std::string> columns{"/first_place_s",
                                                "/first_place_error_m",
                                                "/taps",
                                                "/asked",
                                                "/delivered",
                                                "/gave_up",
                                                "/driven_m",
                                                "/simulated_s",
                                                "/cpu_s",
                                                "/time_share/LOCALIZED",
                                                "/time_share/DEGRADED",
                                                "/time_share/AMBIGUOUS",
                                                "/time_share/LOST",
                                                "/after_lap_time_share/LOCALIZED",
                                                "/after_lap_way_share/LOCALIZED",
                                                "/after_lap_m",
                                                "/raw/all/mean_m",
                                                "/raw/all/p95_m",
                                                "/raw/all/most_m",
                                                "/raw/localized/mean_m",
                                                "/raw/localized/p95_m",
                                                "/raw/localized/most_m",
                                                "/raw/wrongly_sure_s",
                                                "/aligned/all/mean_m",
                                                "/aligned/all/p95_m",
                                                "/aligned/all/most_m",
                                                "/aligned/localized/mean_m",
                                                "/aligned/localized/p95_m",
                                                "/aligned/localized/most_m",
                                                "/aligned/wrongly_sure_s",
                                                "/stations/good",
                                                "/stations/possible",
                                                "/stations/judged",
                                                "/stations/held",
                                                "/stations/compared"};
  std::string text = "name,source,helps,contacts_moving,contacts_standing";
  for (const auto& column : columns) text += "," + column.substr(1);
  text += '\n';
  for (const json& f : starts) {
    if (!f.value("error", "").empty()) continue;
    text += fmt::format("{},{},{},{},{}", f["name"].get<std::string>(), f["source"].get<std::string>(),
                        f["helps"].size(), f["collisions_moving"].size(), f["collisions_standing"].size());
    for (const auto& column : columns) {
      const json& value = f.at(json::json_pointer(column));
      text += "," + (value.is_null() ? "" : value.dump());
    }
    text += '\n';
  }
  return text;
}

}  // namespace madori::bench
