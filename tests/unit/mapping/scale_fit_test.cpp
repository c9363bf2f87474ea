#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/result.hpp"
#include "mapping/georeference/control_points.hpp"
#include "mapping/georeference/known_lengths.hpp"
#include "mapping/georeference/local_plane.hpp"
#include "mapping/georeference/overlay.hpp"
#include "mapping/georeference/scale_choice.hpp"

namespace madori::mapping {
namespace {

using ::testing::HasSubstr;

/// The three dimensions that were measured in the shared `office` drawing.
std::vector<KnownLength> office() {
  return {{580.79, 43.40, 80.27, 1024.97, 9.315},
          {2951.32, 368.57, 2809.31, 1349.93, 8.409},
          {258.73, 1426.88, 2624.46, 1625.22, 20.089}};
}

TEST(KnownLengths, OfficeAgreesWithin_0_5_Percent) {
  const ScaleEstimate e = fit_known_lengths(office());
  EXPECT_NEAR(e.m_per_px, 0.00846, 5e-6);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_LT(std::abs(e.residuals_m[i]) / office()[i].metres, 0.005);
  EXPECT_EQ(e.verdict, Verdict::Good) << e.reason;
}

TEST(KnownLengths, AWrongFourthIsNamed) {
  for (const double metres : {3.0, 6.0, 7.5, 9.2, 20.0}) {  // 1000 px are 8.46 m
    auto lengths = office();
    lengths.push_back({100.0, 100.0, 1100.0, 100.0, metres});
    const ScaleEstimate e = fit_known_lengths(lengths);
    ASSERT_TRUE(e.outlier) << metres;
    EXPECT_EQ(*e.outlier, 3U) << metres;
    EXPECT_EQ(e.verdict, Verdict::Refused);
    EXPECT_THAT(e.reason, HasSubstr("input 4"));
  }
}

TEST(KnownLengths, OfTwoItCannotTellWhichIsWrong) {
  auto lengths = office();
  lengths.resize(2);
  lengths[1].metres *= 1.2;
  const ScaleEstimate e = fit_known_lengths(lengths);
  EXPECT_FALSE(e.outlier);
  EXPECT_EQ(e.verdict, Verdict::Refused);
  EXPECT_THAT(e.notes, testing::Contains(testing::Field(&ScaleNote::text, HasSubstr("cannot be told"))));
}

TEST(KnownLengths, OneIsUsableAndUnverified) {
  const ScaleEstimate e = fit_known_lengths({office()[0]});
  EXPECT_EQ(e.verdict, Verdict::Usable);
  EXPECT_THAT(e.reason, HasSubstr("unverified"));
}

/// A hall of 100 m, and a door of 1 m that was clicked a pixel short at both ends.
TEST(KnownLengths, AShortOneIsOffByItsClicksWithoutContradicting) {
  const ScaleEstimate e = fit_known_lengths({{0, 0, 4000, 0, 100.0}, {100, 0, 138, 0, 1.0}});
  EXPECT_NEAR(e.m_per_px, 0.025, 1e-5);
  EXPECT_NE(e.verdict, Verdict::Refused) << e.reason;
  EXPECT_GT(e.relative_uncertainty, 0.005);  // a door says little about a hall
  EXPECT_EQ(fit_known_lengths({{0, 0, 4000, 0, 100.0}, {100, 0, 130, 0, 1.0}}).verdict, Verdict::Refused);
}

TEST(KnownLengths, RefusesWhatIsNone) {
  for (const char* text : {"1,2,3=4", "1,2,3,4", "1,2,3,4=0", "1,2,3,4=-2", "1,2,1,2=3", "1,2,3,4=nan", ""})
    EXPECT_THROW((void)parse_known_length(text), Error) << text;
  EXPECT_DOUBLE_EQ(parse_known_length("0,0,30,40=5").pixels(), 50.0);
  EXPECT_THROW((void)fit_known_lengths({}), Error);
}

/// Control points of a drawing 0.05 m/px whose x axis points 30 degrees north of east.
std::vector<ControlPoint> hall(double u_scale = 1.0) {
  const GeoreferenceRecord truth{35.464478, 136.739235, 30.0};
  std::vector<ControlPoint> points;
  for (const auto& [u, v] :
       {std::pair{100.0, 80.0}, {1900.0, 120.0}, {1850.0, 1300.0}, {150.0, 1350.0}, {900.0, 700.0}})
    points.push_back({u, v, place_of(truth, {u * 0.05 * u_scale, (1400.0 - v) * 0.05})});
  return points;
}

TEST(ControlPoints, FindThePlaceOfTheDrawing) {
  const ScaleEstimate e = fit_control_points(hall(), 1400);
  EXPECT_NEAR(e.m_per_px, 0.05, 1e-9);
  ASSERT_TRUE(e.georeference);
  EXPECT_NEAR(e.georeference->latitude_deg, 35.464478, 1e-9);
  EXPECT_NEAR(e.georeference->longitude_deg, 136.739235, 1e-9);
  EXPECT_NEAR(e.georeference->enu_from_map_yaw_deg, 30.0, 1e-3);
  EXPECT_EQ(e.verdict, Verdict::Good) << e.reason;
}

/// A kilometre at 65 degrees north, the first point far from the Map origin: north turns by 0.02 degrees on
/// the way, a third of a metre at the far end.
TEST(ControlPoints, TheirNorthIsThatOfTheMapOrigin) {
  const GeoreferenceRecord truth{65.0, 25.0, -20.0};
  std::vector<ControlPoint> points;
  for (const auto& [u, v] : {std::pair{2000.0, 10.0}, {1950.0, 900.0}, {20.0, 950.0}, {10.0, 30.0}})
    points.push_back({u, v, place_of(truth, {u * 0.5, (1000.0 - v) * 0.5})});
  const ScaleEstimate e = fit_control_points(points, 1000);
  ASSERT_TRUE(e.georeference);
  for (const auto& p : points)
    EXPECT_LT(geodesic_m(place_of(*e.georeference, {p.u * 0.5, (1000.0 - p.v) * 0.5}), p.place), 0.002);
}

TEST(ControlPoints, TwoAreUnverified) {
  auto points = hall();
  points.resize(2);
  const ScaleEstimate e = fit_control_points(points, 1400);
  EXPECT_NEAR(e.m_per_px, 0.05, 1e-9);
  EXPECT_EQ(e.verdict, Verdict::Usable);
  EXPECT_THAT(e.reason, HasSubstr("unverified"));
  points.resize(1);
  EXPECT_THROW((void)fit_control_points(points, 1400), Error);
}

TEST(ControlPoints, ErrorIsTheOneOfTheFormula) {
  auto points = hall();
  points[4].u += 4.0;
  const ScaleEstimate e = fit_control_points(points, 1400);
  double sum = 0.0;
  for (const double r : e.residuals_m) sum += r * r;
  EXPECT_NEAR(e.error_m, std::sqrt(sum / 3.0), 1e-12);
  EXPECT_GT(e.leave_one_out_m[4], 0.19);  // 4 px of 0.05 m, predicted by the others
}

TEST(ControlPoints, AWrongOneIsNamed) {
  auto points = hall();
  points[2].u -= 200.0;
  const ScaleEstimate e = fit_control_points(points, 1400);
  ASSERT_TRUE(e.outlier);
  EXPECT_EQ(*e.outlier, 2U);
  EXPECT_EQ(e.verdict, Verdict::Refused);
}

TEST(ControlPoints, SeeAStretchedDrawing) {
  const ScaleEstimate e = fit_control_points(hall(1.01), 1400);
  ASSERT_TRUE(e.stretch);
  EXPECT_NEAR(*e.stretch, 0.01, 1e-6);
  EXPECT_FALSE(fit_control_points(hall(), 1400).stretch);
}

/// Clicks scatter a pixel about the line: of a stretch, in every fifth case, or a mirror they say nothing.
TEST(ControlPoints, OnOneLineShowNeitherStretchNorMirror) {
  const GeoreferenceRecord truth{35.464478, 136.739235, 30.0};
  std::mt19937 engine(1);
  std::normal_distribution<double> click(0.0, 1.0);
  for (int round = 0; round < 100; ++round) {
    std::vector<ControlPoint> points;
    for (double u = 100.0; u < 1400.0; u += 250.0)
      points.push_back(
          {u + click(engine), 1400.0 - u + click(engine), place_of(truth, {u * 0.05, u * 0.05})});
    const ScaleEstimate e = fit_control_points(points, 1400);
    EXPECT_FALSE(e.stretch || e.mirrored) << round;
    EXPECT_THAT(e.notes, testing::ElementsAre(testing::Field(&ScaleNote::text, HasSubstr("on one line"))));
  }
}

TEST(ControlPoints, SeeAMirroredDrawing) {
  auto points = hall();
  for (auto& p : points) p.u = 2000.0 - p.u;
  const ScaleEstimate e = fit_control_points(points, 1400);
  EXPECT_TRUE(e.mirrored);
  EXPECT_EQ(e.verdict, Verdict::Refused);
  EXPECT_THAT(e.reason, HasSubstr("mirrored"));
}

TEST(ControlPoints, RefuseWhatIsNone) {
  for (const char* text : {"1,2=3", "1=3,4", "1,2", "1,2=91,0", "1,2=0,181", "1,2=a,b"})
    EXPECT_THROW((void)parse_control_point(text), Error) << text;
}

TEST(ScaleSources, SayWhereTheyDisagree) {
  const ScaleEstimate known = fit_known_lengths(office());
  ScaleEstimate paper = paper_scale(100.0, 300.0);  // 0.008467 m/px
  EXPECT_TRUE(disagreements({known, paper}).empty());
  paper = paper_scale(200.0, 300.0);
  EXPECT_THAT(disagreements({known, paper}), testing::ElementsAre(HasSubstr("disagree by 100")));
  EXPECT_THROW((void)paper_scale(200.0, 0.0), Error);
  EXPECT_THROW((void)paper_scale(0.0, 300.0), Error);
}

TEST(ScaleSources, AScaleThatWasVerifiedIsNotCalledUnverifiedLater) {
  const ScaleEstimate known = fit_known_lengths(office());
  ScaleRecord record{known.m_per_px, "known", known.relative_uncertainty, known.error_m, "", known.inputs};
  EXPECT_EQ(recorded_scale(record).verdict, Verdict::Good) << recorded_scale(record).reason;
  record.residual_m = 0.0;
  EXPECT_EQ(recorded_scale(record).verdict, Verdict::Usable);
}

/// Laid over a photograph 4 % too large; a measured length gives the scale, and the middle of the drawing
/// stays where it was laid.
TEST(ScaleSources, ThePlaceOnEarthIsThatOfTheChosenScale) {
  const ScaleEstimate known = fit_known_lengths(office());
  Overlay overlay;
  overlay.zoom = 18;
  overlay.place = {-33.9, 18.4};
  overlay.photo_zoom = 1.0;
  overlay.layout_zoom = 1.04 * known.m_per_px / (tile_side_m(-33.9, 18) / kTilePixels);
  overlay.rotation_deg = 40.0;
  overlay.placed = true;
  const ScaleChoice choice = choose_scale({fit_overlay(overlay, 3000, 2000), known});
  ASSERT_EQ(choice.best.method, "known");
  ASSERT_TRUE(choice.best.georeference);
  const LatLon middle =
      place_of(*choice.best.georeference, {1500.0 * known.m_per_px, 1000.0 * known.m_per_px});
  EXPECT_LT(geodesic_m(middle, overlay.place), 0.001);
}

}  // namespace
}  // namespace madori::mapping
