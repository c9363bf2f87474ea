#include "app/trajectory_score.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>

#include "app/number_table.hpp"
#include "core/input_file.hpp"
#include "core/result.hpp"

namespace madori::app {
namespace {

using nlohmann::json;

// Which estimate belongs to a stamp.
constexpr double kMaxDtS = 0.05;   ///< largest distance to the nearest estimate
constexpr double kMaxGapS = 10.0;  ///< with relations: largest interval that is interpolated over
constexpr double kWithinM = 0.5;
constexpr double kWithinRad = to_rad(10.0);

/// Ordered by time, one pose a stamp (the last written).
std::vector<StampedPose> in_order(std::vector<StampedPose> poses) {
  std::stable_sort(poses.begin(), poses.end(),
                   [](const StampedPose& a, const StampedPose& b) { return a.stamp < b.stamp; });
  std::vector<StampedPose> unique;
  for (const StampedPose& pose : poses) {
    if (!unique.empty() && unique.back().stamp == pose.stamp) {
      unique.back() = pose;
    } else {
      unique.push_back(pose);
    }
  }
  return unique;
}

Transform2<Map, Base> between(const StampedPose& a, const StampedPose& b, Stamp stamp) {
  const double f = to_seconds(stamp - a.stamp) / to_seconds(b.stamp - a.stamp);
  const auto& p = a.map_from_base;
  const auto& q = b.map_from_base;
  return {p.x_m() + f * (q.x_m() - p.x_m()), p.y_m() + f * (q.y_m() - p.y_m()),
          p.yaw_rad() + f * wrap_angle(q.yaw_rad() - p.yaw_rad())};
}

/// The estimate at `stamp`: interpolated between two poses at most `max_gap_s` apart, else the nearest within
/// kMaxDtS; nothing otherwise.
std::optional<Transform2<Map, Base>> sample(const std::vector<StampedPose>& poses, Stamp stamp,
                                            double max_gap_s, bool interpolate) {
  if (poses.empty()) return std::nullopt;
  const auto after = std::lower_bound(poses.begin(), poses.end(), stamp,
                                      [](const StampedPose& pose, Stamp t) { return pose.stamp < t; });
  const auto last = static_cast<std::ptrdiff_t>(poses.size()) - 1;
  const std::ptrdiff_t high =
      std::clamp<std::ptrdiff_t>(after - poses.begin(), std::min<std::ptrdiff_t>(1, last), last);
  const StampedPose& b = poses[static_cast<std::size_t>(high)];
  const StampedPose& a = poses[static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, high - 1))];
  if (interpolate && a.stamp <= stamp && stamp <= b.stamp && a.stamp < b.stamp &&
      to_seconds(b.stamp - a.stamp) <= max_gap_s) {
    return between(a, b, stamp);
  }
  const double to_a = std::abs(to_seconds(stamp - a.stamp));
  const double to_b = std::abs(to_seconds(stamp - b.stamp));
  if (std::min(to_a, to_b) >= kMaxDtS) {
    return std::nullopt;
  }
  return to_a <= to_b ? a.map_from_base : b.map_from_base;
}

double mean(const std::vector<double>& v) {
  return std::accumulate(v.begin(), v.end(), 0.0) / static_cast<double>(v.size());
}

/// Linear between the neighbouring ranks.
double percentile(std::vector<double> v, double share) {
  std::sort(v.begin(), v.end());
  const double rank = share * static_cast<double>(v.size() - 1);
  const auto low = static_cast<std::size_t>(rank);
  const std::size_t high = std::min(low + 1, v.size() - 1);
  return v[low] + (rank - static_cast<double>(low)) * (v[high] - v[low]);
}

std::vector<double> squares(std::vector<double> v) {
  for (double& x : v) x *= x;
  return v;
}

double median_interval_s(const std::vector<StampedPose>& poses) {
  std::vector<double> gaps;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    gaps.push_back(to_seconds(poses[i].stamp - poses[i - 1].stamp));
  }
  return gaps.empty() ? 0.0 : percentile(gaps, 0.5);
}

json spread(const std::vector<double>& v) {
  const double m = mean(v);
  const double variance = mean(squares(v)) - m * m;
  return {{"mean", m},
          {"std", std::sqrt(std::max(0.0, variance))},
          {"max", *std::max_element(v.begin(), v.end())}};
}

json position_json(const std::vector<double>& v) {
  return {{"mean", mean(v)},
          {"median", percentile(v, 0.5)},
          {"rmse", std::sqrt(mean(squares(v)))},
          {"p95", percentile(v, 0.95)},
          {"max", *std::max_element(v.begin(), v.end())}};
}

std::string number(const json& value, const char* format) {
  std::array<char, 48> text{};
  std::snprintf(text.data(), text.size(), format, value.get<double>());
  return text.data();
}

}  // namespace

std::vector<Relation> load_relations(const std::filesystem::path& file) {
  std::vector<Relation> relations;
  for (const NumberRow& row : load_number_table(file, 8)) {
    const auto& v = row.values;
    relations.push_back({stamp_from_seconds(v[0]), stamp_from_seconds(v[1]), {v[2], v[3], v[7]}});
  }
  return relations;
}

Transform2<Map, Map> load_map_from_reference(const std::filesystem::path& file) {
  require_readable(file, 1'000'000);
  try {
    const YAML::Node root = YAML::LoadFile(file.string());
    const YAML::Node node = root["map_from_reference"] ? root["map_from_reference"] : root;
    const Transform2<Map, Map> transform(node["x_m"].as<double>(), node["y_m"].as<double>(),
                                         to_rad(node["yaw_deg"].as<double>()));
    if (transform.is_finite()) return transform;
  } catch (const YAML::Exception&) {  // said below, in words that help
  }
  throw Error(file.string(), "holds no map_from_reference with x_m, y_m and yaw_deg", "check the file");
}

json score_against_truth(std::vector<StampedPose> estimate, std::vector<StampedPose> truth) {
  const std::vector<StampedPose> poses = in_order(std::move(estimate));
  const std::vector<StampedPose> stations = in_order(std::move(truth));
  const bool denser =
      poses.size() > 1 && (stations.size() < 2 || median_interval_s(poses) < median_interval_s(stations));
  std::vector<double> metres;
  std::vector<double> degrees;
  std::size_t good = 0;
  for (const StampedPose& t : stations) {
    const auto at = sample(poses, t.stamp, 10.0 * kMaxDtS, denser);
    if (!at) continue;
    const double d = distance_m(at->translation(), t.map_from_base.translation());
    const double h = std::abs(wrap_angle(at->yaw_rad() - t.map_from_base.yaw_rad()));
    metres.push_back(d);
    degrees.push_back(to_deg(h));
    good += d < kWithinM && h < kWithinRad ? 1 : 0;
  }
  if (metres.empty()) {
    throw Error("evaluate", "no estimate lies near a stamp of the truth", "are both of the same log?");
  }
  const auto matched = static_cast<double>(metres.size());
  return {{"mode", "truth"},
          {"matched", metres.size()},
          {"truth_poses", stations.size()},
          {"coverage", matched / static_cast<double>(stations.size())},
          {"interpolated", denser},
          {"position_m", position_json(metres)},
          {"heading_deg",
           {{"mean", mean(degrees)},
            {"p95", percentile(degrees, 0.95)},
            {"max", *std::max_element(degrees.begin(), degrees.end())}}},
          {"within",
           {{"metres", kWithinM},
            {"degrees", to_deg(kWithinRad)},
            {"share", static_cast<double>(good) / matched}}}};
}

json score_against_relations(std::vector<StampedPose> estimate, const std::vector<Relation>& relations) {
  const std::vector<StampedPose> poses = in_order(std::move(estimate));
  std::vector<double> metres;
  std::vector<double> degrees;
  for (const Relation& r : relations) {
    const auto from = sample(poses, r.from, kMaxGapS, true);
    const auto to = sample(poses, r.to, kMaxGapS, true);
    if (!from || !to) continue;
    const Transform2<Base, Base> motion = from->inverse() * *to;
    metres.push_back(std::hypot(motion.x_m() - r.motion.x_m(), motion.y_m() - r.motion.y_m()));
    degrees.push_back(to_deg(std::abs(wrap_angle(motion.yaw_rad() - r.motion.yaw_rad()))));
  }
  if (metres.empty()) {
    throw Error("evaluate", "no relation has both stamps inside the estimate", "are both of the same log?");
  }
  return {{"mode", "relations"},
          {"matched", metres.size()},
          {"relations", relations.size()},
          {"estimate_interval_s", median_interval_s(poses)},
          {"translation_m", spread(metres)},
          {"translation_m2", spread(squares(metres))},
          {"rotation_deg", spread(degrees)},
          {"rotation_deg2", spread(squares(degrees))}};
}

std::string score_text(const json& s) {
  if (s.at("mode") == "relations") {
    return std::to_string(s.at("matched").get<int>()) + " of " +
           std::to_string(s.at("relations").get<int>()) + " relations scored; translation " +
           number(s.at("translation_m").at("mean"), "%.4f") + " +- " +
           number(s.at("translation_m").at("std"), "%.4f m") + ", rotation " +
           number(s.at("rotation_deg").at("mean"), "%.3f") + " +- " +
           number(s.at("rotation_deg").at("std"), "%.3f deg");
  }
  const json& p = s.at("position_m");
  return std::to_string(s.at("matched").get<int>()) + " of " +
         std::to_string(s.at("truth_poses").get<int>()) + " poses matched; position median " +
         number(p.at("median"), "%.3f") + " p95 " + number(p.at("p95"), "%.3f") + " rmse " +
         number(p.at("rmse"), "%.4f") + " max " + number(p.at("max"), "%.3f m") + ", heading mean " +
         number(s.at("heading_deg").at("mean"), "%.2f deg") + ", " +
         number(100.0 * s.at("within").at("share").get<double>(), "%.1f %%") + " within " +
         number(s.at("within").at("metres"), "%.1f m") + " and " +
         number(s.at("within").at("degrees"), "%.0f deg");
}

}  // namespace madori::app
