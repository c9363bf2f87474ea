// What tar itself makes of the archive.
#include "hmi/server/tar_stream.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <array>
#include <cstdio>
#include <fstream>

#include "core/result.hpp"
#include "hmi/server/site_backup.hpp"
#include "hmi/server/site_snapshot.hpp"
#include "mapping/site/atomic_file.hpp"
#include "mapping/site/site_transaction.hpp"
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

/// What a restored backup says whose first file claims to have so many bytes.
std::string claimed(const fs::path& backup, const char* octal, const fs::path& site) {
  std::string bytes = mapping::file_content(backup);
  bytes.replace(124, 11, octal).replace(148, 8, 8, ' ');
  unsigned sum = 0;
  for (int i = 0; i < 512; ++i) sum += static_cast<unsigned char>(bytes[static_cast<std::size_t>(i)]);
  std::array<char, 8> checksum{};
  std::snprintf(checksum.data(), checksum.size(), "%06o", sum);
  bytes.replace(148, 8, checksum.data(), 8);
  mapping::write_new_file(backup, bytes);
  try {
    (void)read_backup(backup, site, false);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(SiteBackup, AFileThatClaimsMoreThanTheWholeIsRefused) {
  const test::TemporaryFolder folder;
  const fs::path site = folder.path() / "site", backup = folder.path() / "b.tar";
  fs::create_directory(site);
  mapping::write_new_file(site / "site.yaml", "name: hall\n");
  mapping::write_new_file(site / "walls.csv", "");
  write_backup(site, backup);
  ASSERT_TRUE(is_backup(backup));
  const std::string said = claimed(backup, "06000000000", folder.path() / "new");  // 805 MB
  EXPECT_NE(said.find("larger than the whole"), std::string::npos) << said;
  EXPECT_FALSE(fs::exists(folder.path() / "new/site.yaml"));
}

/// A site that its commands read, and its text.
void make_site(const fs::path& site, const std::string& walls = "1,0,0,5,0\n") {
  fs::create_directories(site / "routes");
  mapping::write_new_file(
      site / "site.yaml",
      "madori_site: 1\nname: hall\ndrawing: {file: drawing.png, width_px: 10, height_px: 5}\n");
  mapping::write_new_file(site / "walls.csv", "id,x1,y1,x2,y2\n" + walls);
  mapping::write_new_file(site / "routes/tree.csv", "ID,EDA\n0,1\n1,0\n");
  mapping::write_new_file(site / "routes/path.csv", "ID,x,y\n0,1,1\n1,4,1\n");
}

std::string all_of(TarStream stream) {
  std::string bytes;
  for (std::string part = stream.next(); !part.empty(); part = stream.next()) bytes += part;
  return bytes;
}

TEST(SiteBackup, WhatIsSavedWhileItIsReadIsNotInIt) {
  const test::TemporaryFolder folder;
  const fs::path site = folder.path() / "site", back = folder.path() / "back", tar = folder.path() / "b.tar";
  make_site(site);
  TarStream stream(site_snapshot(site));
  std::string bytes = stream.next();  // a slow download has begun
  {
    mapping::SiteTransaction change(site);
    change.write("walls.csv", "id,x1,y1,x2,y2\n1,0,0,9,0\n2,0,0,0,9\n");
    change.write("routes/path.csv", "ID,x,y\n0,2,2\n1,4,2\n");
    change.remove("routes/tree.csv");
    change.commit();
  }
  for (std::string part = stream.next(); !part.empty(); part = stream.next()) bytes += part;
  mapping::write_new_file(tar, bytes);
  (void)read_backup(tar, back, false);
  EXPECT_EQ(mapping::file_content(back / "walls.csv"), "id,x1,y1,x2,y2\n1,0,0,5,0\n");
  EXPECT_EQ(mapping::file_content(back / "routes/path.csv"), "ID,x,y\n0,1,1\n1,4,1\n");
  EXPECT_EQ(mapping::file_content(back / "routes/tree.csv"), "ID,EDA\n0,1\n1,0\n");
}

TEST(SiteBackup, AFileThatEndsTooSoonMakesNoArchive) {
  const test::TemporaryFolder folder;
  const fs::path site = folder.path() / "site";
  make_site(site);
  TarStream stream(site_snapshot(site));
  fs::resize_file(site / "walls.csv", 3);  // in place, as no command does
  EXPECT_THROW((void)all_of(std::move(stream)), Error);
}

/// What read_backup() says of a site that was archived past write_backup().
std::string refusal_of(const fs::path& site, const fs::path& folder) {
  const fs::path tar = folder / "b.tar";
  mapping::write_file_atomically(tar, all_of(TarStream(site_entries(site))));
  try {
    (void)read_backup(tar, folder / "back", false);
  } catch (const Error& error) {
    EXPECT_FALSE(fs::exists(folder / "back/site.yaml"));
    return error.what();
  }
  return "";
}

TEST(SiteBackup, WhatNoCommandWouldReadIsNotRestored) {
  const test::TemporaryFolder folder;
  const fs::path site = folder.path() / "site";
  make_site(site);
  fs::remove(site / "routes/tree.csv");
  EXPECT_NE(refusal_of(site, folder.path()).find("one of the two files of its routes"), std::string::npos);
  mapping::write_new_file(site / "routes/tree.csv", "ID,EDA\n0,7\n");
  EXPECT_NE(refusal_of(site, folder.path()).find("routes/tree.csv:2"), std::string::npos);
  make_site(site);
  fs::remove(site / "walls.csv");
  EXPECT_NE(refusal_of(site, folder.path()).find("holds no walls.csv"), std::string::npos);
  EXPECT_THROW(write_backup(site, folder.path() / "c.tar"), Error);
  make_site(site);
  EXPECT_EQ(refusal_of(site, folder.path()), "");
}

TEST(SiteBackup, NamesThatNoBackupHasAreNotWritten) {
  for (const char* name : {"tiles/a\n- b", "drawing./../pins", "walls.d/a", "versions/objects",
                           "versions/a/b.json", "learned/../pins", "learned/", "pins"})
    EXPECT_FALSE(is_in_backup(name)) << name;
  for (const char* name : {"drawing.png", "walls.pcd", "map.yaml", "routes/tree.csv", "tiles/18/5/7.png",
                           "learned/days/2026-11-25.png", "versions/000001.json", "versions/objects/0a1b-12"})
    EXPECT_TRUE(is_in_backup(name)) << name;
}

TEST(SiteBackup, APipeIsNoneAndIsNotWaitedFor) {
  const test::TemporaryFolder folder;
  const fs::path pipe = folder.path() / "b.tar";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_FALSE(is_backup(pipe));
  EXPECT_FALSE(is_backup("/dev/zero"));
}

}  // namespace
}  // namespace madori::hmi
