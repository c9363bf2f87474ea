#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "core/result.hpp"
#include "mapping/wall_map/import_picture.hpp"
#include "mapping/wall_map/occupancy_map.hpp"
#include "mapping/wall_map/point_map.hpp"
#include "tests/support/temporary_folder.hpp"

namespace madori::mapping {
namespace {

const Walls kSquare{
    {1, {{1, 1}, {4, 1}}}, {2, {{4, 1}, {4, 3}}}, {3, {{4, 3}, {1, 3}}}, {4, {{1, 3}, {1, 1}}}};

double distance_to_square(const Point2<Map>& p) {
  const double dx = std::max({1 - p.x_m, p.x_m - 4, 0.0}), dy = std::max({1 - p.y_m, p.y_m - 3, 0.0});
  const double inside = std::min({p.x_m - 1, 4 - p.x_m, p.y_m - 1, 3 - p.y_m});
  return dx > 0 || dy > 0 ? std::hypot(dx, dy) : inside;
}

TEST(PointMap, SamplesLieOnTheWallsAndCoverThem) {
  const PointMap map = make_point_map(kSquare, 0.02, 0.05);
  EXPECT_EQ(map.sampled, 2U * 151 + 2U * 101);
  EXPECT_GT(map.sampled, map.points.size());
  for (const auto& p : map.points) EXPECT_LT(distance_to_square(p), 0.03);
  for (double x = 1; x <= 4; x += 0.01) {
    double nearest = 1e9;
    for (const auto& p : map.points) nearest = std::min(nearest, distance_m(p, {x, 1.0}));
    EXPECT_LT(nearest, 0.05);
  }
}

TEST(PointMap, RefusesAVoxelThatPclCannotCount) {
  const Walls far{{1, {{0, 0}, {90'000, 90'000}}}};
  EXPECT_THROW((void)make_point_map(far, 1000.0, 0.001), Error);
}

TEST(PointMap, WallsOfAMistakenScaleAreRefusedBeforeTheyTakeTheMemory) {
  const Walls huge{{1, {{0.0, 0.0}, {12e6, 0.0}}}};  // a point pair whose longitude was mistyped
  EXPECT_THROW((void)make_point_map(huge, 0.02, 0.05), Error);
}

TEST(PointMap, WritesAPcdWithEveryPoint) {
  const test::TemporaryFolder folder;
  const PointMap map = make_point_map(kSquare, 0.02, 0.05);
  save_pcd(folder.path() / "walls.pcd", map);
  std::ifstream stream(folder.path() / "walls.pcd", std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  EXPECT_NE(text.find("POINTS " + std::to_string(map.points.size()) + "\n"), std::string::npos);
  EXPECT_THROW(save_pcd(folder.path() / "no/folder.pcd", map), Error);
}

TEST(OccupancyMap, DrawsWallsUprightInMapServerFormat) {
  const Walls walls{{1, {{0.025, 0.975}, {1.975, 0.975}}}};  // near the top of a 2 m x 1 m drawing
  const OccupancyMap map = make_occupancy_map(walls, 2.0, 1.0, 0.05);
  const std::string header = "P5\n40 20\n255\n";
  ASSERT_EQ(map.pgm.substr(0, header.size()), header);
  const std::string cells = map.pgm.substr(header.size());
  ASSERT_EQ(cells.size(), 800U);
  for (std::size_t i = 0; i < cells.size(); ++i)
    EXPECT_EQ(static_cast<unsigned char>(cells[i]), i < 40 ? 0 : 254) << i;
  EXPECT_NE(map.yaml.find("resolution: 0.05\n"), std::string::npos);
}

TEST(ImportPicture, WallsAreBlueRejectedLinesOrangePaperPale) {
  GrayImage drawing{5000, 3000, std::vector<std::uint8_t>(15'000'000, 255), 0};
  std::fill_n(drawing.pixels.begin() + 1000 * 5000, 5000 * 50, std::uint8_t{0});  // a black beam
  const std::vector<PixelSegment> walls{{600, 600, 4400, 600}};
  const std::vector<RejectedSegment> rejected{{{600, 2400, 4400, 2400}, RejectReason::Text}};
  const auto png = import_picture(drawing, walls, rejected, 0.01);
  const cv::Mat picture = cv::imdecode(png, cv::IMREAD_COLOR);
  EXPECT_LE(picture.cols, 2400);
  const double zoom = picture.cols / 5000.0;
  const auto at = [&](double u, double v) {
    return picture.at<cv::Vec3b>(static_cast<int>(v * zoom), static_cast<int>(u * zoom));
  };
  EXPECT_EQ(at(2000, 600), cv::Vec3b(150, 50, 0));       // BGR
  EXPECT_GT(at(2000, 2400)[2], at(2000, 2400)[0] + 60);  // orange
  EXPECT_EQ(at(2000, 1800), cv::Vec3b(255, 255, 255));
  EXPECT_EQ(at(2000, 1025), cv::Vec3b(165, 165, 165));
}

TEST(ImportPicture, TheSmallestAndTheNarrowestDrawingHaveOneToo) {
  for (const auto& [width, height] : {std::pair{1, 1}, {30'000, 2}, {3, 20'000}}) {
    const GrayImage drawing{width, height,
                            std::vector<std::uint8_t>(static_cast<std::size_t>(width) * height, 255), 0};
    EXPECT_FALSE(cv::imdecode(import_picture(drawing, {}, {}, std::nullopt), cv::IMREAD_COLOR).empty());
  }
}

}  // namespace
}  // namespace madori::mapping
