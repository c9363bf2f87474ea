#include "mapping/drawing/import_drawing.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <fstream>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "core/result.hpp"
#include "mapping/georeference/apply_scale.hpp"
#include "mapping/georeference/local_plane.hpp"
#include "mapping/site/atomic_file.hpp"
#include "mapping/wall_map/wall_files.hpp"
#include "tests/support/temporary_folder.hpp"

namespace madori::mapping {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

/// A room of 8 m x 5 m with a door, 0.02 m/px.
fs::path draw_room(const test::TemporaryFolder& folder, const std::string& name = "room.png") {
  cv::Mat picture(350, 500, CV_8UC1, cv::Scalar(255));
  cv::rectangle(picture, {50, 50}, {450, 300}, 0, 5);
  cv::rectangle(picture, {200, 290}, {250, 310}, 255, cv::FILLED);
  cv::imwrite((folder.path() / name).string(), picture);
  return folder.path() / name;
}

std::string refusal(const ImportOptions& options) {
  try {
    import_drawing(options);
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

class ImportDrawing : public testing::Test {
 protected:
  [[nodiscard]] ImportOptions options(const fs::path& drawing) const {
    ImportOptions o;
    o.drawing = drawing;
    o.site = folder_.path() / "site";
    return o;
  }
  /// The drawing is refused with the text, and no trace of a site is left.
  void expect_refused(const fs::path& drawing, const std::string& text) const {
    EXPECT_THAT(refusal(options(drawing)), HasSubstr(text));
    EXPECT_THAT(refusal(options(drawing)), HasSubstr(drawing.filename().string()));
    EXPECT_FALSE(fs::exists(folder_.path() / "site"));
  }
  test::TemporaryFolder folder_;
};

TEST_F(ImportDrawing, ASiteThatCannotBeLookedAtIsSaidWithItsRemedy) {
  ImportOptions o = options(draw_room(folder_));
  o.site = folder_.path() / std::string(300, 'a');
  const std::string said = refusal(o);  // of Error: what the library throws says no remedy
  EXPECT_THAT(said, HasSubstr("cannot be looked at: File name too long - name another --site"));
}

TEST_F(ImportDrawing, MakesAWholeSite) {
  ImportOptions o = options(draw_room(folder_));
  o.m_per_px = 0.02;
  const ImportReport report = import_drawing(o);
  for (const char* name : {"site.yaml", "drawing.png", "walls.csv", "other_lines.csv", "walls.pcd", "map.pgm",
                           "map.yaml", "import.png"})
    EXPECT_TRUE(fs::exists(o.site / name)) << name;
  EXPECT_EQ(file_content(o.site / "drawing.png"), file_content(o.drawing));
  EXPECT_GT(report.points.sampled, report.points.points.size());
  const Site site = load_scaled_site(o.site);
  EXPECT_EQ(site.drawing.width_px, 500);
  for (const auto& wall : load_walls(o.site / "walls.csv")) {
    EXPECT_GT(wall.segment.a.x_m, 0.8);  // 50 px of margin
    EXPECT_LT(wall.segment.a.y_m, 6.2);
  }
}

TEST_F(ImportDrawing, WhatIsDrawnAndNoWallIsKeptAndScaled) {
  const fs::path drawing = draw_room(folder_);
  cv::Mat picture = cv::imread(drawing.string(), cv::IMREAD_GRAYSCALE);
  cv::rectangle(picture, {300, 120}, {380, 170}, 110, 1);  // a machine
  cv::imwrite(drawing.string(), picture);
  const ImportOptions o = options(drawing);
  import_drawing(o);
  const Walls unscaled = load_other_lines(o.site);
  const auto front = std::ranges::find_if(unscaled, [](const Wall& line) {
    const auto& [a, b] = line.segment;
    return std::abs(a.y_m - 180.0) < 1.5 && std::abs(b.y_m - 180.0) < 1.5 && std::abs(a.x_m - b.x_m) > 70.0;
  });
  ASSERT_NE(front, unscaled.end());
  EXPECT_LT(front->probability, 0.5);
  ScaleEstimate estimate;
  estimate.m_per_px = 0.02;
  estimate.method = "option";
  apply_scale(o.site, estimate, "2026-11-27T00:00:00Z", {});
  const Walls scaled = load_other_lines(o.site);
  ASSERT_EQ(scaled.size(), unscaled.size());
  for (std::size_t i = 0; i < scaled.size(); ++i)
    EXPECT_NEAR(scaled[i].segment.b.x_m, 0.02 * unscaled[i].segment.b.x_m, 2e-6);
}

/// It was laid on a photograph about its middle, and then measured: the middle stays.
TEST_F(ImportDrawing, AnotherScaleKeepsTheMiddleInItsPlaceOnEarth) {
  ImportOptions o = options(draw_room(folder_));
  o.m_per_px = 0.02;
  import_drawing(o);
  Site site = load_site(o.site);
  site.georeference = GeoreferenceRecord{35.464478, 136.739235, 30.0};
  save_site(o.site, site);
  const LatLon before = place_of(*site.georeference, {250 * 0.02, 175 * 0.02});
  ScaleEstimate estimate;
  estimate.m_per_px = 0.022;
  estimate.method = "known";
  apply_scale(o.site, estimate, "2026-11-27T00:00:00Z", {});
  const LatLon now = place_of(*load_site(o.site).georeference, {250 * 0.022, 175 * 0.022});
  EXPECT_LT(geodesic_m(before, now), 0.001);
}

TEST_F(ImportDrawing, WithoutScaleNothingMayDriveOnIt) {
  const ImportOptions o = options(draw_room(folder_));
  import_drawing(o);
  EXPECT_FALSE(load_site(o.site).scale);
  EXPECT_THROW((void)load_scaled_site(o.site), Error);
}

TEST_F(ImportDrawing, APrintedScaleNeedsTheResolution) {
  ImportOptions o = options(draw_room(folder_));
  o.paper_scale = 100;
  o.m_per_px.reset();
  o.drawing = draw_room(folder_, "room.bmp");
  o.plan.dpi = 127;  // 0.2 mm of paper a pixel
  import_drawing(o);
  const Site site = load_scaled_site(o.site);
  EXPECT_NEAR(site.scale->m_per_px, 0.02, 1e-12);
  EXPECT_EQ(site.scale->method, "paper");
  EXPECT_GT(site.scale->relative_uncertainty, 0.0);
  EXPECT_EQ(site.scale->residual_m, 0.0);
}

/// The units of a viewBox are no length of paper: a printed scale needs more.
TEST_F(ImportDrawing, AnSvgThatStatesNoPaperHasNoResolution) {
  const auto room = [this](const std::string& size) {
    return folder_.write("room.svg", "<svg xmlns='http://www.w3.org/2000/svg' " + size +
                                         " viewBox='0 0 100 70'><path d='M10 10H90V60H10Z' fill='none' "
                                         "stroke='#000' stroke-width='1'/></svg>");
  };
  EXPECT_NEAR(load_plan(room("width='100mm' height='70mm'"), {}).picture.dpi, 5000 / 100.0 * 25.4, 1e-6);
  EXPECT_EQ(load_plan(room("width='100%'"), {}).picture.dpi, 0);
}

TEST_F(ImportDrawing, BadInputIsRefusedWithoutATrace) {
  expect_refused(folder_.path() / "nowhere.png", "does not exist");
  expect_refused(folder_.write("text.png", "this is no image"), "text.png");
  expect_refused(folder_.write("plan.dwg", "AC1027"), "save it as DXF");
  expect_refused(folder_.write("plan.pdf", "%PDF-1.4 and nothing else"), "no readable PDF");
  expect_refused(folder_.write("plan.svg", "<svg"), "no readable SVG");
  const std::string whole = file_content(draw_room(folder_));
  expect_refused(folder_.write("truncated.png", whole.substr(0, whole.size() / 2)), "truncated.png");
  cv::imwrite((folder_.path() / "white.png").string(), cv::Mat(300, 300, CV_8UC1, cv::Scalar(255)));
  expect_refused(folder_.path() / "white.png", "no wall was found");
  cv::imwrite((folder_.path() / "black.png").string(), cv::Mat(300, 300, CV_8UC1, cv::Scalar(0)));
  expect_refused(folder_.path() / "black.png", "no wall was found");
}

TEST_F(ImportDrawing, AFolderIsNoDrawing) {
  fs::create_directory(folder_.path() / "plans");
  EXPECT_THAT(refusal(options(folder_.path() / "plans")), HasSubstr("is a folder"));
}

TEST_F(ImportDrawing, AProtectedPdfIsRefused) {
  expect_refused(fs::path(MADORI_SOURCE_DIR) / "tests/unit/mapping/locked.pdf", "password");
}

TEST_F(ImportDrawing, PagesOutOfRangeAreRefused) {
  ImportOptions o = options(fs::path(MADORI_SOURCE_DIR) / "data/sample_factory/factory.pdf");
  o.plan.page = 2;
  EXPECT_THAT(refusal(o), HasSubstr("has no page 2"));
  o.plan.page = 1;
  o.plan.dpi = 5000;
  EXPECT_THAT(refusal(o), HasSubstr("choose a lower --dpi"));
}

/// A PDF of two pages, a room on each.
const std::string kTwoPages =
    "%PDF-1.4\n1 0 obj<</Type/Catalog/Pages 2 0 R>>endobj\n"
    "2 0 obj<</Type/Pages/Kids[3 0 R 4 0 R]/Count 2/MediaBox[0 0 400 300]>>endobj\n"
    "3 0 obj<</Type/Page/Parent 2 0 R/Contents 5 0 R>>endobj\n"
    "4 0 obj<</Type/Page/Parent 2 0 R/Contents 5 0 R>>endobj\n"
    "5 0 obj<</Length 49>>stream\n40 40 320 220 re 48 48 304 204 re f*             \nendstream endobj\n"
    "trailer<</Root 1 0 R>>\n";

TEST_F(ImportDrawing, SaysWhichPageOfSeveralWasRead) {
  ImportOptions o = options(folder_.write("two.pdf", kTwoPages));
  o.plan.dpi = 100;
  EXPECT_THAT(import_drawing(o).notes, testing::ElementsAre(HasSubstr("page 1 of 2 was read; --page")));
  o.plan.page = 2;
  o.force = true;
  EXPECT_THAT(import_drawing(o).notes, testing::ElementsAre(HasSubstr("page 2 of 2")));
  o.drawing = fs::path(MADORI_SOURCE_DIR) / "data/sample_factory/factory.pdf";
  o.plan.page = 1;
  EXPECT_THAT(import_drawing(o).notes, testing::IsEmpty());
}

TEST_F(ImportDrawing, AnExistingSiteIsOnlyReplacedOnRequest) {
  ImportOptions o = options(draw_room(folder_));
  o.m_per_px = 0.02;
  import_drawing(o);
  fs::create_directory(o.site / "routes");
  std::ofstream(o.site / "routes/tree.csv") << "ID,EDA\n";
  const std::string before = file_content(o.site / "walls.csv");
  EXPECT_THAT(refusal(o), HasSubstr("--force"));
  o.drawing = folder_.write("bad.png", "no image");
  o.force = true;
  EXPECT_NE(refusal(o), "");
  EXPECT_EQ(file_content(o.site / "walls.csv"), before);
  o.drawing = draw_room(folder_, "again.png");
  o.m_per_px = 0.04;
  import_drawing(o);
  EXPECT_NE(file_content(o.site / "walls.csv"), before);
  EXPECT_EQ(file_content(o.site / "routes/tree.csv"), "ID,EDA\n");
}

/// Exit 0 where the import failed with an Error although every file may only have `limit` bytes.
int import_with_file_limit(const ImportOptions& options, rlim_t limit) {
  const pid_t child = ::fork();
  if (child == 0) {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit bytes{limit, limit};
    ::setrlimit(RLIMIT_FSIZE, &bytes);
    ::_exit(refusal(options).empty() ? 1 : 0);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST_F(ImportDrawing, AFullDiskLosesNothing) {
  ImportOptions o = options(draw_room(folder_));
  o.m_per_px = 0.02;
  EXPECT_EQ(import_with_file_limit(o, 500), 0);
  EXPECT_FALSE(fs::exists(o.site / "site.yaml"));
  import_drawing(o);
  const std::string before = file_content(o.site / "walls.csv");
  o.force = true;
  o.m_per_px = 0.05;
  EXPECT_EQ(import_with_file_limit(o, 500), 0);
  EXPECT_EQ(file_content(o.site / "walls.csv"), before);
}

TEST_F(ImportDrawing, AFolderThatCannotBeWrittenIsSaid) {
  if (::geteuid() == 0) {
    ImportOptions o = options(draw_room(folder_));
    o.site = "/proc/madori-site";  // not even root may make a folder there
    EXPECT_THAT(refusal(o), HasSubstr("cannot be made"));
    return;
  }
  const test::TemporaryFolder locked;
  fs::permissions(locked.path(), fs::perms::owner_read | fs::perms::owner_exec);
  ImportOptions o = options(draw_room(folder_));
  o.site = locked.path() / "site";
  EXPECT_THAT(refusal(o), HasSubstr("cannot be made"));
}

/// Root reads everything, so root plays nobody meanwhile.
TEST_F(ImportDrawing, AFileThatMayNotBeReadIsSaid) {
  constexpr uid_t kNobody = 65534;
  const fs::path drawing = draw_room(folder_);
  fs::permissions(folder_.path(), fs::perms::all);
  fs::permissions(drawing, fs::perms::none);
  const bool root = ::geteuid() == 0;
  if (root && ::seteuid(kNobody) != 0) GTEST_SKIP() << "root cannot become another user here";
  const std::string said = refusal(options(drawing));
  if (root) {
    ASSERT_EQ(::seteuid(0), 0);
  }
  EXPECT_THAT(said, HasSubstr("cannot be read"));
}

}  // namespace
}  // namespace madori::mapping
