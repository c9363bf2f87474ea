#include "mapping/drawing/vector/bounded_load.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <thread>

#include "core/result.hpp"
#include "mapping/drawing/vector/load_dxf.hpp"
#include "tests/support/temporary_folder.hpp"

namespace madori::mapping {
namespace {

using ::testing::HasSubstr;

/// What load_bounded says of a `load` that does not end well. On a busy machine a second of the processor
/// takes many.
std::string error_of(const std::function<Plan()>& load, double wall_s = 60.0) {
  try {
    (void)load_bounded("plan.svg", load, {.processor_s = 1, .wall_s = wall_s, .bytes = 100'000'000});
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

TEST(BoundedLoad, APlanIsHandedOverWhole) {
  const auto file = std::filesystem::path(MADORI_SOURCE_DIR) / "data/sample_factory/factory.dxf";
  const Plan direct = load_dxf(file, {});
  const Plan plan = load_plan(file, {});
  EXPECT_EQ(plan.picture.pixels, direct.picture.pixels);
  EXPECT_EQ(plan.picture.width_px, direct.picture.width_px);
  ASSERT_TRUE(plan.vectors && direct.vectors);
  EXPECT_EQ(plan.vectors->walls, direct.vectors->walls);
  EXPECT_EQ(plan.vectors->rejected.size(), direct.vectors->rejected.size());
  EXPECT_EQ(plan.m_per_px, direct.m_per_px);
  EXPECT_EQ(plan.scale_method, direct.scale_method);
  EXPECT_EQ(plan.notes, direct.notes);
  EXPECT_EQ(plan.left_out, direct.left_out);
}

TEST(BoundedLoad, TimeAndMemoryAreBoundedAndSaid) {
  volatile unsigned busy = 0;
  EXPECT_THAT(error_of([&]() -> Plan {
                while (true) busy = busy + 1;
              }),
              HasSubstr("plan.svg: takes more than 1 s"));
  EXPECT_THAT(error_of(
                  []() -> Plan {
                    std::this_thread::sleep_for(std::chrono::hours(1));
                    return {};
                  },
                  3.0),
              HasSubstr("takes more than 3 s"));
  EXPECT_THAT(error_of([]() -> Plan {
                std::vector<std::string> hoard;
                while (true) hoard.emplace_back(1'000'000, 'x');
              }),
              HasSubstr("takes more than 100 MB"));
}

TEST(BoundedLoad, ALibraryThatBreaksDownDoesNotTakeTheProgramWithIt) {
  EXPECT_THAT(error_of([]() -> Plan { std::abort(); }), HasSubstr("plan.svg: "));
  EXPECT_THAT(error_of([]() -> Plan { throw Error("plan.svg", "is none", "draw it"); }),
              "plan.svg: is none - draw it");
}

/// Each block holds the one before ten times: 10^9 lines.
TEST(BoundedLoad, BlocksWithinBlocksEnd) {
  const auto insert = [](int block, int at) {
    return "0\nINSERT\n8\n0\n2\nB" + std::to_string(block) + "\n10\n" + std::to_string(at) + "\n20\n0\n";
  };
  std::string text = "0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n4\n0\nENDSEC\n0\nSECTION\n2\nBLOCKS\n";
  for (int b = 0; b < 10; ++b) {
    text += "0\nBLOCK\n8\n0\n2\nB" + std::to_string(b) + "\n70\n0\n10\n0\n20\n0\n30\n0\n3\nB" +
            std::to_string(b) + "\n";
    if (b == 0) text += "0\nLINE\n8\n0\n10\n0\n20\n0\n11\n1000\n21\n0\n";
    for (int k = 0; b > 0 && k < 10; ++k) text += insert(b - 1, 2000 * k);
    text += "0\nENDBLK\n";
  }
  text += "0\nENDSEC\n0\nSECTION\n2\nENTITIES\n" + insert(9, 0) + "0\nENDSEC\n0\nEOF\n";
  const test::TemporaryFolder folder;
  const auto file = folder.write("nested.dxf", text);
  EXPECT_THAT(error_of([&] { return load_dxf(file, {}); }), HasSubstr("takes more than"));
}

}  // namespace
}  // namespace madori::mapping
