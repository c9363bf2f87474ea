#include "localization/warp/warp_file.hpp"

#include <gtest/gtest.h>

#include <random>

#include "mapping/site/atomic_file.hpp"
#include "tests/support/made_up_buildings.hpp"
#include "tests/support/temporary_folder.hpp"

namespace madori::localization {
namespace {

WarpFit made_up_fit(std::size_t walls) {
  std::mt19937 engine(4);
  std::uniform_real_distribution<double> any(-0.3, 0.3);
  WarpField field;
  field.origin = {-4.0, 2.0};
  field.width = 5;
  field.height = 3;
  for (int i = 0; i < 15; ++i) {
    field.control_m.push_back(any(engine));
    field.control_m.push_back(any(engine));
    field.sigma_m.push_back(0.3 + any(engine));
  }
  WarpFit fit;
  fit.warp = DrawingWarp({1.01, 0.002, 0.3, -0.1}, field, {0.21, 14.0, 0.031, 0.022, 0.7});
  fit.residual_m = 0.044;
  fit.evidence_nats = 123.4;
  fit.walls_seen = 56.0;
  for (std::size_t i = 0; i < walls; ++i)
    fit.walls.push_back({{{{any(engine), 0.02, 1.5, 0.8}, {any(engine), 0.03, 0.0, 0.0}}}});
  return fit;
}

TEST(WarpFile, ComesBackToTheBit) {
  const test::TemporaryFolder folder;
  const mapping::Walls walls = test::laboratory_hall();
  const WarpFit fit = made_up_fit(walls.size());
  save_warp(folder.path() / "warp.txt", fit, walls);
  WarpFit back;
  EXPECT_EQ(load_warp(folder.path() / "warp.txt", walls, back), "");
  EXPECT_TRUE(back.warp == fit.warp);
  EXPECT_EQ(warp_text(back, walls), warp_text(fit, walls));
  EXPECT_EQ(back.walls[3].sides[0].offset_m, fit.walls[3].sides[0].offset_m);
}

TEST(WarpFile, OfOtherWallsOrDamagedIsNotTakenAndSaysWhy) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "warp.txt";
  mapping::Walls walls = test::laboratory_hall();
  const std::string text = warp_text(made_up_fit(walls.size()), walls);
  WarpFit back;
  EXPECT_EQ(load_warp(file, walls, back), "");  // none yet
  mapping::Walls others = walls;
  others[0].segment.b.x_m += 0.01;
  mapping::write_file_atomically(file, text);
  EXPECT_NE(load_warp(file, others, back).find("the walls have changed"), std::string::npos);
  // Cut short anywhere, or a number spoilt: nothing is taken.
  for (std::size_t length = 0; length + 1 < text.size(); length += 97) {
    mapping::write_file_atomically(file, text.substr(0, length));
    EXPECT_NE(load_warp(file, walls, back).find("is damaged"), std::string::npos) << length;
  }
  std::string spoilt = text;
  spoilt.replace(spoilt.find("control ") + 8, 3, "nan");
  mapping::write_file_atomically(file, spoilt);
  EXPECT_NE(load_warp(file, walls, back).find("is damaged"), std::string::npos);
  EXPECT_TRUE(back.warp.is_identity());
}

TEST(WarpFile, AFieldThatFoldsIsRefused) {
  const test::TemporaryFolder folder;
  const mapping::Walls walls = test::laboratory_hall();
  WarpFit fit = made_up_fit(walls.size());
  WarpField field = fit.warp.field();
  field.control_m[4] += 5.0;
  fit.warp = DrawingWarp(fit.warp.similarity(), field, fit.warp.statistics());
  mapping::write_file_atomically(folder.path() / "warp.txt", warp_text(fit, walls));
  WarpFit back;
  EXPECT_NE(load_warp(folder.path() / "warp.txt", walls, back).find("is damaged"), std::string::npos);
}

TEST(WarpFile, ALatticeIsOfWholeNumbersOfControlPoints) {
  const test::TemporaryFolder folder;
  const mapping::Walls walls = test::laboratory_hall();
  const std::string text = warp_text(WarpFit{}, walls);
  const std::size_t field = text.find("field "), end = text.find('\n', field);
  for (const char* lattice : {"field 0 0 2 1e300 0", "field 0 0 2 0 -1e300", "field 0 0 2 0.5 0"}) {
    mapping::write_file_atomically(folder.path() / "warp.txt",
                                   std::string(text).replace(field, end - field, lattice));
    WarpFit back;
    EXPECT_NE(load_warp(folder.path() / "warp.txt", walls, back).find("is damaged"), std::string::npos)
        << lattice;
  }
}

TEST(WarpFile, NumbersThatLeadNowhereAreRefused) {
  const test::TemporaryFolder folder;
  const mapping::Walls walls = test::laboratory_hall();
  const std::string text = warp_text(WarpFit{}, walls);
  const std::size_t line = text.find("similarity "), end = text.find('\n', line);
  for (const char* similarity :
       {"similarity 1e308 0 0 0", "similarity 1e-308 0 0 0", "similarity 1 0 1e308 0"}) {
    mapping::write_file_atomically(folder.path() / "warp.txt",
                                   std::string(text).replace(line, end - line, similarity));
    WarpFit back;
    EXPECT_NE(load_warp(folder.path() / "warp.txt", walls, back).find("is damaged"), std::string::npos)
        << similarity;
  }
}

}  // namespace
}  // namespace madori::localization
