#include "tests/bench/robustness/drawn_buildings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "localization/drawing_fit/wall_lines.hpp"
#include "localization/memory/memory.hpp"
#include "localization/scan_points.hpp"
#include "mapping/drawing/read_drawing.hpp"
#include "mapping/picture/load_image.hpp"
#include "sensors/carmen/reader.hpp"

namespace madori::bench {

Records load_records(const std::filesystem::path& file) {
  sensors::carmen::CarmenReader log(file);
  Records records;
  while (auto record = log.next()) records.push_back(std::move(*record));
  return records;
}

mapping::Walls picture_walls(const std::filesystem::path& picture, double m_per_px, const PictureHarm& harm) {
  mapping::GrayImage image = mapping::load_image(picture);
  cv::Mat pixels(image.height_px, image.width_px, CV_8UC1, image.pixels.data());
  if (harm.blur_px > 0) cv::GaussianBlur(pixels, pixels, {}, harm.blur_px);
  const int side = 2 * std::abs(harm.thinner_px) + 1;
  const cv::Mat brush = cv::getStructuringElement(cv::MORPH_ELLIPSE, {side, side});
  if (harm.thinner_px > 0) cv::dilate(pixels, pixels, brush);  // paper grows over the ink
  if (harm.thinner_px < 0) cv::erode(pixels, pixels, brush);
  const auto read = mapping::read_drawing(image, {});
  mapping::Walls walls;
  for (const mapping::PixelSegment& s : read.walls) {
    walls.push_back({static_cast<int>(walls.size()),
                     {{s.u1 * m_per_px, (image.height_px - s.v1) * m_per_px},
                      {s.u2 * m_per_px, (image.height_px - s.v2) * m_per_px}},
                     read.probabilities[walls.size()]});
  }
  return walls;
}

mapping::Walls walls_from_log(const Records& log, const std::vector<app::StampedPose>& truth) {
  localization::Memory memory;
  std::size_t scans = 0;
  for (const sensors::LogRecord& record : log) {
    const auto* scan = std::get_if<sensors::ScanRecord>(&record);
    if (scan == nullptr) continue;
    ++scans;
    const auto at = std::find_if(truth.begin(), truth.end(), [&](const app::StampedPose& p) {
      return std::abs(to_seconds(p.stamp - scan->scan.stamp)) < 0.01;
    });
    if (at == truth.end()) continue;
    if (!memory.empty() &&
        distance_m(memory.poses().back().translation(), at->map_from_base.translation()) < 0.4) {
      continue;
    }
    const localization::ScanPoints points = localization::scan_points(scan->scan, scan->base_from_lidar);
    std::vector<Point2<Base>> seen;
    for (std::size_t i = 0; i < points.size(); ++i) seen.push_back(points.point(i));
    memory.add(localization::make_surface_scan(scan->scan.stamp, scan->base_from_lidar.translation(), seen),
               0.0, at->map_from_base, Eigen::Matrix3d::Identity());
  }
  localization::WallLineOptions options;
  const bool dense = static_cast<double>(memory.size()) <
                     0.7 * static_cast<double>(scans);  // else a wall may be in one scan alone
  options.least_sightings = dense ? 3 : 1;
  return localization::wall_lines(localization::memory_cloud(memory), options);
}

namespace {

struct Wave {
  double kx, ky, phase, dx, dy;
};

Point2<Map> bent(const Point2<Map>& p, const std::array<Wave, 4>& waves) {
  Point2<Map> out = p;
  for (const Wave& w : waves) {
    const double s = std::sin(w.kx * p.x_m + w.ky * p.y_m + w.phase);
    out.x_m += w.dx * s;
    out.y_m += w.dy * s;
  }
  return out;
}

Point2<Map> middle_of(const mapping::Walls& walls) {
  double x1 = 1e9;
  double x2 = -1e9;
  double y1 = 1e9;
  double y2 = -1e9;
  for (const mapping::Wall& wall : walls) {
    for (const Point2<Map>& p : {wall.segment.a, wall.segment.b}) {
      x1 = std::min(x1, p.x_m);
      x2 = std::max(x2, p.x_m);
      y1 = std::min(y1, p.y_m);
      y2 = std::max(y2, p.y_m);
    }
  }
  return {0.5 * (x1 + x2), 0.5 * (y1 + y2)};
}

}  // namespace

Point2<Map> scaled_about_middle(const mapping::Walls& walls, const Point2<Map>& p, double scale) {
  const Point2<Map> c = middle_of(walls);
  return {c.x_m + scale * (p.x_m - c.x_m), c.y_m + scale * (p.y_m - c.y_m)};
}

mapping::Walls lie(const mapping::Walls& walls, const Lies& lies, std::mt19937& engine) {
  std::uniform_real_distribution<double> share(0.0, 1.0);
  std::normal_distribution<double> normal;
  std::array<Wave, 4> waves{};
  for (Wave& w : waves) {
    const double k = 2.0 * kPi / (8.0 + 22.0 * share(engine));
    const double heading = 2.0 * kPi * share(engine);
    const double push = 2.0 * kPi * share(engine);
    w = {k * std::cos(heading), k * std::sin(heading), 2.0 * kPi * share(engine),
         0.5 * lies.bend_m * std::cos(push), 0.5 * lies.bend_m * std::sin(push)};
  }
  mapping::Walls out;
  for (const mapping::Wall& wall : walls) {
    const bool missing = share(engine) < lies.missing;
    const double shift = lies.shift_m * normal(engine);
    const double length = wall.segment.length_m();
    if (missing || length < lies.shortest_m) continue;
    Segment2<Map> s = wall.segment;
    const double nx = -(s.b.y_m - s.a.y_m) / length;
    const double ny = (s.b.x_m - s.a.x_m) / length;
    for (Point2<Map>* p : {&s.a, &s.b}) {
      *p = bent(*p, waves);
      *p = scaled_about_middle(walls, {p->x_m + shift * nx, p->y_m + shift * ny}, lies.scale);
    }
    out.push_back({static_cast<int>(out.size()), s, wall.probability});
  }
  return out;
}

}  // namespace madori::bench
