#include "app/landmarks/landmark_files.hpp"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "app/plot/map_canvas.hpp"

namespace madori::app {
namespace {

namespace lm = localization::landmarks;

/// Calls `edge(from, to)` once an edge, from < to.
void for_each_edge(const lm::LandmarkHub& hub, const std::function<void(int, int)>& edge) {
  for (int from = 0; from < hub.map().size(); ++from)
    for (lm::NodeSet rest = hub.map().graph().neighbours(from); !rest.empty();)
      if (const int to = rest.take_first(); from < to) edge(from, to);
}

Point2<Map> place(const std::vector<PlacedLandmark>& landmarks, int i) {
  return landmarks[static_cast<std::size_t>(i)].map_from_landmark.translation();
}

double sigma(const PlacedLandmark& l, int axis) {
  return std::sqrt(std::max(0.0, l.covariance(axis, axis)));
}

}  // namespace

std::vector<PlacedLandmark> place_landmarks(const lm::LandmarkHub& hub,
                                            const Transform2<Map, Map>& map_from_origin) {
  const auto published = lm::published_landmarks(hub);
  const lm::Matrix3 turn{{{map_from_origin.cos_yaw(), -map_from_origin.sin_yaw(), 0.0},
                          {map_from_origin.sin_yaw(), map_from_origin.cos_yaw(), 0.0},
                          {0.0, 0.0, 1.0}}};
  std::vector<PlacedLandmark> placed;
  for (int i = 0; i < hub.map().size(); ++i) {
    const lm::FullPose landmark = hub.landmark(i);
    const lm::ScalarUncertainty& scalar = published[static_cast<std::size_t>(i)].uncertainty;
    placed.push_back({map_from_origin * Transform2<Map, Base>(landmark.motion.x_m, landmark.motion.y_m,
                                                              landmark.motion.yaw_rad),
                      lm::carried(turn, landmark.uncertainty.covariance), std::sqrt(scalar.position_m2),
                      std::sqrt(scalar.yaw_rad2)});
  }
  return placed;
}

std::string landmarks_csv(const std::vector<PlacedLandmark>& landmarks) {
  std::string text =
      "id,x_m,y_m,yaw_deg,sigma_x_m,sigma_y_m,sigma_yaw_deg,published_sigma_m,published_sigma_deg\n";
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    const PlacedLandmark& l = landmarks[i];
    text += fmt::format("{},{:.6f},{:.6f},{:.5f},{:.6f},{:.6f},{:.5f},{:.6f},{:.5f}\n", i,
                        l.map_from_landmark.x_m(), l.map_from_landmark.y_m(),
                        to_deg(l.map_from_landmark.yaw_rad()), sigma(l, 0), sigma(l, 1), to_deg(sigma(l, 2)),
                        l.published_sigma_m, to_deg(l.published_sigma_rad));
  }
  return text;
}

std::string landmarks_geojson(const std::vector<PlacedLandmark>& landmarks, const lm::LandmarkHub& hub) {
  nlohmann::json features = nlohmann::json::array();
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    const PlacedLandmark& l = landmarks[i];
    features.push_back(
        {{"type", "Feature"},
         {"geometry",
          {{"type", "Point"}, {"coordinates", {l.map_from_landmark.x_m(), l.map_from_landmark.y_m()}}}},
         {"properties",
          {{"kind", "landmark"},
           {"id", i},
           {"yaw_deg", to_deg(l.map_from_landmark.yaw_rad())},
           {"sigma_x_m", sigma(l, 0)},
           {"sigma_y_m", sigma(l, 1)},
           {"sigma_yaw_deg", to_deg(sigma(l, 2))}}}});
  }
  for_each_edge(hub, [&](int from, int to) {
    const Point2<Map> a = place(landmarks, from), b = place(landmarks, to);
    features.push_back(
        {{"type", "Feature"},
         {"geometry", {{"type", "LineString"}, {"coordinates", {{a.x_m, a.y_m}, {b.x_m, b.y_m}}}}},
         {"properties", {{"kind", "edge"}, {"from", from}, {"to", to}}}});
  });
  return nlohmann::json{{"type", "FeatureCollection"}, {"frame", "Map, metres"}, {"features", features}}.dump(
             1) +
         "\n";
}

std::string landmarks_dot(const std::vector<PlacedLandmark>& landmarks, const lm::LandmarkHub& hub) {
  std::string text = "graph landmarks {\n";
  for (std::size_t i = 0; i < landmarks.size(); ++i)
    text +=
        fmt::format("  {} [pos=\"{:.1f},{:.1f}\", label=\"{}\\n{:.3f} m\"];\n", i,
                    72.0 * landmarks[i].map_from_landmark.x_m(), 72.0 * landmarks[i].map_from_landmark.y_m(),
                    i, std::hypot(sigma(landmarks[i], 0), sigma(landmarks[i], 1)) / std::sqrt(2.0));
  for_each_edge(hub, [&](int from, int to) {
    const lm::FullPose edge = hub.map().graph().edge(from, to);
    text += fmt::format("  {} -- {} [label=\"{:.2f} m, {:.3f} m\"];\n", from, to,
                        std::hypot(edge.motion.x_m, edge.motion.y_m), lm::position_sigma_m(edge.uncertainty));
  });
  return text + "}\n";
}

std::vector<std::uint8_t> landmarks_picture(const std::vector<PlacedLandmark>& landmarks,
                                            const lm::LandmarkHub& hub,
                                            const std::vector<std::vector<StampedPose>>& ways,
                                            const mapping::Walls& walls) {
  std::vector<Point2<Map>> shown;
  for (const auto& way : ways)
    for (const StampedPose& pose : way) shown.push_back(pose.map_from_base.translation());
  for (int i = 0; i < hub.map().size(); ++i) shown.push_back(place(landmarks, i));
  MapCanvas canvas(walls, shown);
  canvas.walls(walls, colours::kGrey);
  const Colour of_agent[3] = {colours::kSky, colours::kGreen, colours::kPurple};
  for (std::size_t agent = 0; agent < ways.size(); ++agent)
    for (std::size_t i = 1; i < ways[agent].size(); ++i)
      canvas.line(
          {ways[agent][i - 1].map_from_base.translation(), ways[agent][i].map_from_base.translation()},
          of_agent[agent % 3]);
  for_each_edge(hub, [&](int from, int to) {
    canvas.line({place(landmarks, from), place(landmarks, to)}, colours::kOrange, 2);
  });
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    const lm::Matrix3& c = landmarks[i].covariance;
    const Point2<Map> at = landmarks[i].map_from_landmark.translation();
    Eigen::Matrix2d position;
    position << c(0, 0), c(0, 1), c(1, 0), c(1, 1);
    canvas.ellipse(at, position, 2.0, 20.0, colours::kVermillion);
    canvas.dot(at, colours::kVermillion);
    canvas.text(at, std::to_string(i), colours::kInk);
  }
  canvas.title("Landmarks, seen from landmark 0");
  canvas.legend({{Mark::Dot, colours::kVermillion, 2, "landmark"},
                 {Mark::Ellipse, colours::kVermillion, 1, "2 sigma"},
                 {Mark::Line, colours::kOrange, 2, "measured between two landmarks"},
                 {Mark::Line, colours::kSky, 1, "way of the first agent"}});
  return canvas.png();
}

}  // namespace madori::app
