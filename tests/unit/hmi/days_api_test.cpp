// The days kept of the living map, what changed between them, and walls that a person is asked about.
#include <gmock/gmock.h>

#include "hmi/server/standing_walls.hpp"
#include "mapping/days/day_archive.hpp"
#include "mapping/days/day_file.hpp"
#include "mapping/days/map_frame.hpp"
#include "mapping/site/atomic_file.hpp"
#include "mapping/site/site.hpp"
#include "mapping/site/site_transaction.hpp"
#include "mapping/wall_map/wall.hpp"
#include "tests/unit/days/made_up_day.hpp"
#include "tests/unit/hmi/panel_fixture.hpp"

namespace madori::hmi {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

class DaysApiTest : public PanelTest {
 protected:
  void SetUp() override {
    PanelTest::SetUp();
    mapping::Site record;
    record.drawing = {"drawing.png", 1000, 500};
    record.scale.emplace().m_per_px = 0.05;
    record.scale->method = "known";
    mapping::SiteTransaction change(site());
    change.write("site.yaml", mapping::site_yaml(record));
    change.write("walls.csv",
                 mapping::walls_csv({{1, {{0.0, 0.0}, {10.0, 0.0}}}, {2, {{0.0, 5.0}, {7.0, 5.0}}}}));
    change.commit();
    frame_ = mapping::map_frame(site(), mapping::load_site(site()));
  }
  void keep(const std::string& date, const std::vector<std::string>& rows) const {
    mapping::DayMap day = test::made_up_day(date, rows);
    day.frame = frame_;
    mapping::keep_day(site(), day);
  }
  /// The middle of wall 1 is looked through.
  void look_through() {
    std::vector<WallView> seen;
    for (int piece = 0; piece < 10; ++piece) {
      const bool gone = piece >= 4 && piece < 7;
      seen.push_back({1,
                      piece,
                      {{1.0 * piece, 0.0}, {1.0 + piece, 0.0}},
                      gone ? "missing" : "confirmed",
                      gone ? 0.1 : 0.9,
                      0.0,
                      gone ? 12.0 : 0.0,
                      gone});
    }
    vehicle_.see_walls(seen);
  }

  std::string frame_;
};

const std::vector<std::string> kWith{"........", "..ssss..", "..s##s..", "........"};
const std::vector<std::string> kWithout{"........", "........", "........", "........"};

TEST_F(DaysApiTest, DaysAreListedWithTheirPlaces) {
  keep("2026-11-24", kWith);
  keep("2026-11-25", kWithout);
  mapping::write_file_atomically(site() / mapping::kDaysFolder / "2026-11-23.png", std::string("no picture"));
  const json days = get("/api/site/days");
  ASSERT_EQ(days["days"].size(), 2U);
  EXPECT_EQ(days["days"][0], json({{"date", "2026-11-24"}, {"extent", {-0.5, 0.75, 1.5, 1.75}}}));
  ASSERT_EQ(days["skipped"].size(), 1U);
  EXPECT_THAT(days["skipped"][0].get<std::string>(), HasSubstr("2026-11-23.png"));
  EXPECT_EQ(days["of_other_frames"], 0);
}

TEST_F(DaysApiTest, ADayIsServedAsAPicture) {
  keep("2026-11-24", kWith);
  const auto picture = call("GET", "/api/site/days/2026-11-24/map.png");
  EXPECT_EQ(picture.status, 200);
  const auto day = mapping::parse_day(picture.body);
  ASSERT_TRUE(day.ok()) << day.reason();
  EXPECT_EQ(day.value().at(1, 4).state, mapping::DayState::Static);
  EXPECT_EQ(call("GET", "/api/site/days/2026-11-25/map.png").status, 404);
}

TEST_F(DaysApiTest, OnlyDatesAreDates) {
  keep("2026-11-24", kWith);
  for (const char* date : {"2026-11-31", "2026-1-24", "x", "2026-11-24.png", "..%2f..%2fsite.yaml", "%2e%2e",
                           "....-..-..", "2026-11-24%00", "-026-11-24"}) {
    const std::string begin = std::string("/api/site/days/") + date;
    for (const std::string& target : {begin + "/map.png", begin + "/against/2026-11-24",
                                      "/api/site/days/2026-11-24/against/" + std::string(date)}) {
      const int status = call("GET", target).status;
      EXPECT_TRUE(status == 400 || status == 404 || status == 422) << target << ": " << status;
    }
  }
}

TEST_F(DaysApiTest, ChangesNameWhatIsGoneAndWhen) {
  keep("2026-11-18", kWith);
  keep("2026-11-21", kWith);
  keep("2026-11-24", kWithout);
  keep("2026-11-25", kWithout);
  const json changes = get("/api/site/days/2026-11-25/against/2026-11-18");  // whichever comes first
  EXPECT_EQ(changes["from"], "2026-11-18");
  EXPECT_EQ(changes["to"], "2026-11-25");
  ASSERT_EQ(changes["changes"].size(), 1U);
  const json& gone = changes["changes"][0];
  EXPECT_EQ(gone["kind"], "gone");
  EXPECT_EQ(gone["cells"], 8);
  EXPECT_EQ(gone["from"], nullptr);
  EXPECT_EQ(gone["before"], "2026-11-21");
  EXPECT_EQ(gone["since"], "2026-11-24");
  EXPECT_EQ(get("/api/site/days/2026-11-24/against/2026-11-25")["changes"], json::array());
  EXPECT_EQ(get("/api/site/days/2026-11-25/against/2026-11-25")["changes"], json::array());
  EXPECT_EQ(call("GET", "/api/site/days/2026-11-25/against/2026-11-19").status, 404);
}

TEST_F(DaysApiTest, AWallThatIsLookedThroughIsAskedAboutUntilAPersonAnswers) {
  EXPECT_EQ(get("/api/site/walls/doubted"), json::array());
  look_through();
  const json asked = get("/api/site/walls/doubted");
  ASSERT_EQ(asked.size(), 1U);
  EXPECT_EQ(asked[0]["segments"], json({{4.0, 0.0, 7.0, 0.0}}));
  EXPECT_EQ(asked[0]["length_m"], 3.0);
  EXPECT_EQ(asked[0]["looks"], 12.0);
  const json answer{{"segments", asked[0]["segments"]}};
  EXPECT_EQ(call("POST", "/api/site/walls/standing", answer.dump()).status, 200);
  EXPECT_EQ(get("/api/site/walls/doubted"), json::array());
  EXPECT_EQ(call("POST", "/api/site/walls/standing", answer.dump()).status, 404);  // nobody asks any more
  EXPECT_EQ(standing_walls(site(), frame_).size(), 1U);
  EXPECT_THAT(mapping::file_content(site() / kStandingFile), HasSubstr("2026-01-01T00:00:00Z"));
}

TEST_F(DaysApiTest, OnlyWhatIsAskedCanBeAnswered) {
  look_through();
  for (const char* body : {R"({"segments": [[0, 0, 10, 0]]})", R"({"segments": []})", R"({"segments": 7})"})
    EXPECT_EQ(call("POST", "/api/site/walls/standing", body).status, 404) << body;
  EXPECT_EQ(call("POST", "/api/site/walls/standing", "{}").status, 400);
  for (const char* body : {"[]", "", R"({"segments")"})
    EXPECT_EQ(call("POST", "/api/site/walls/standing", body).status, 422) << body;
  EXPECT_FALSE(std::filesystem::exists(site() / kStandingFile));
}

TEST_F(DaysApiTest, AFolderWithoutASiteHasNoDays) {
  std::filesystem::remove_all(site());
  EXPECT_EQ(get("/api/site/days")["days"], json::array());
  EXPECT_EQ(get("/api/site/walls/doubted"), json::array());
  EXPECT_EQ(call("GET", "/api/site/days/2026-11-24/against/2026-11-25").status, 404);
}

}  // namespace
}  // namespace madori::hmi
