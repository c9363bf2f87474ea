// What tar itself makes of the archive.
#include "hmi/server/tar_stream.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <sstream>

#include "mapping/site/atomic_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace madori::hmi {
namespace {

namespace fs = std::filesystem;

TEST(TarStream, TarUnpacksTheSameFiles) {
  const test::TemporaryFolder folder;
  const fs::path in = folder.path() / "in";
  fs::create_directories(in / "tiles" / std::string(60, 'd') / std::string(60, 'e'));
  const std::string long_name = "tiles/" + std::string(60, 'd') + "/" + std::string(60, 'e') + "/file.bin";
  std::string large(200'000, '\0');
  for (std::size_t i = 0; i < large.size(); ++i) large[i] = static_cast<char>(i * 7);
  mapping::write_new_file(in / "empty.csv", "");
  mapping::write_new_file(in / "block.csv", std::string(512, 'x'));
  mapping::write_new_file(in / long_name, large);
  fs::create_symlink("/etc/passwd", in / "link");

  TarStream stream(tar_entries(in, "site/"));
  std::ofstream tar(folder.path() / "a.tar", std::ios::binary);
  for (std::string part = stream.next(); !part.empty(); part = stream.next()) {
    EXPECT_LE(part.size(), 70'000U);
    tar << part;
  }
  tar.close();
  const std::string command =
      "tar -xf " + (folder.path() / "a.tar").string() + " -C " + folder.path().string();
  ASSERT_EQ(std::system(command.c_str()), 0);
  const fs::path out = folder.path() / "site";
  EXPECT_EQ(mapping::file_content(out / "empty.csv"), "");
  EXPECT_EQ(mapping::file_content(out / "block.csv"), std::string(512, 'x'));
  EXPECT_EQ(mapping::file_content(out / long_name), large);
  EXPECT_FALSE(fs::exists(out / "link"));
}

}  // namespace
}  // namespace madori::hmi
