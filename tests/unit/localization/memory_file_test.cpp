#include "localization/memory/memory_file.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "localization/byte_stream.hpp"
#include "mapping/wall_map/wall_fingerprint.hpp"

namespace madori::localization {
namespace {

Memory some_memory() {
  std::mt19937 engine(3);
  std::uniform_real_distribution<double> any(-5.0, 5.0);
  Memory memory;
  for (int k = 0; k < 12; ++k) {
    SurfaceScan scan;
    scan.stamp = Stamp(std::chrono::milliseconds(100 * k));
    scan.sensor = {0.2, -0.1};
    for (int i = 0; i < 30; ++i) scan.points.push_back({any(engine), any(engine), 0.6, 0.8});
    if (k == 7) memory.note_break();
    memory.add(std::move(scan), 0.5, {0.4 * k, 0.1 * k, 0.05 * k}, 400.0 * Eigen::Matrix3d::Identity());
  }
  return memory;
}

TEST(MemoryFile, WhatIsReadBackIsWhatWasWritten) {
  const Memory memory = some_memory();
  const Result<Memory> back = parse_memory(memory_bytes(memory, 77), 77);
  ASSERT_TRUE(back.ok()) << back.reason();
  ASSERT_EQ(back.value().size(), memory.size());
  ASSERT_EQ(back.value().factors().size(), memory.factors().size());
  for (std::size_t i = 0; i < memory.size(); ++i) {
    EXPECT_EQ(back.value().poses()[i].x_m(), memory.poses()[i].x_m());
    EXPECT_EQ(back.value().keyframes()[i].path_m, memory.keyframes()[i].path_m);
    EXPECT_EQ(back.value().keyframes()[i].after_break, i == 7);
    const auto& a = back.value().keyframes()[i].scan->points;
    const auto& b = memory.keyframes()[i].scan->points;
    ASSERT_EQ(a.size(), b.size());
    EXPECT_NEAR(a[4].x_m, b[4].x_m, 1e-6);
  }
  EXPECT_EQ(memory_bytes(back.value(), 77).size(), memory_bytes(memory, 77).size());
}

TEST(MemoryFile, OtherWallsAndDamageAreRefusedWithTheReason) {
  const std::string bytes = memory_bytes(some_memory(), 77);
  EXPECT_NE(parse_memory(bytes, 78).reason().find("walls have changed"), std::string::npos);
  EXPECT_NE(parse_memory("PNG", 77).reason().find("no memory"), std::string::npos);
  for (std::size_t at = 9; at < bytes.size(); at += 97) {
    std::string bad = bytes;
    bad[at] = static_cast<char>(bad[at] ^ 0x20);
    EXPECT_FALSE(parse_memory(bad, 77).ok()) << "byte " << at;
    EXPECT_FALSE(parse_memory(std::string_view(bytes).substr(0, at), 77).ok()) << "cut at " << at;
  }
}

/// A right checksum does not make a memory: a backup brings what anybody wrote.
TEST(MemoryFile, APoseThatIsNoPlaceIsRefused) {
  const std::string bytes = memory_bytes(some_memory(), 77);
  const auto with = [&](double x_m) {
    std::string body = bytes.substr(0, bytes.size() - sizeof(std::uint64_t));
    std::memcpy(body.data() + 24, &x_m, sizeof x_m);  // of the first pose
    ByteWriter out;
    out.put(body);
    return parse_memory(out.take(), 77);
  };
  EXPECT_TRUE(with(-3.5).ok());
  EXPECT_FALSE(with(1e300).ok());
}

TEST(MemoryFile, AnyMovedWallChangesTheFingerprint) {
  mapping::Walls walls{{0, {{0.0, 0.0}, {5.0, 0.0}}}, {1, {{5.0, 0.0}, {5.0, 3.0}}}};
  const std::uint64_t before = mapping::walls_checksum(walls);
  EXPECT_EQ(before, mapping::walls_checksum(walls));
  walls[1].segment.b.y_m += 1e-6;
  EXPECT_NE(before, mapping::walls_checksum(walls));
}

}  // namespace
}  // namespace madori::localization
