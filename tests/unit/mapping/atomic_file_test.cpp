#include "mapping/site/atomic_file.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <thread>

#include "core/input_file.hpp"
#include "core/result.hpp"
#include "mapping/site/site_transaction.hpp"
#include "tests/support/temporary_folder.hpp"

namespace madori::mapping {
namespace {

namespace fs = std::filesystem;

class AtomicFile : public testing::Test {
 protected:
  [[nodiscard]] fs::path at(const char* name) const { return folder_.path() / name; }
  test::TemporaryFolder folder_;
};

TEST_F(AtomicFile, APipeIsWrittenIntoAndStaysOne) {
  const fs::path pipe = at("pipe");
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  std::string heard;
  std::thread reader([&] {
    const int descriptor = ::open(pipe.c_str(), O_RDONLY);
    std::array<char, 64> bytes{};
    for (ssize_t n = 0; (n = ::read(descriptor, bytes.data(), bytes.size())) > 0;)
      heard.append(bytes.data(), static_cast<std::size_t>(n));
    ::close(descriptor);
  });
  write_file_atomically(pipe, std::string_view("{}"));
  reader.join();
  EXPECT_EQ(heard, "{}");
  EXPECT_TRUE(fs::is_fifo(pipe));
}

TEST_F(AtomicFile, ADeviceIsWrittenIntoAndAFullOneIsAnError) {
  const struct stat before = [] {
    struct stat s {};
    ::stat("/dev/null", &s);
    return s;
  }();
  write_file_atomically("/dev/null", std::string_view("x"));
  struct stat after {};
  ASSERT_EQ(::stat("/dev/null", &after), 0);
  EXPECT_TRUE(S_ISCHR(after.st_mode));
  EXPECT_EQ(after.st_ino, before.st_ino);
  EXPECT_THROW(write_file_atomically("/dev/full", std::string_view("x")), Error);
  EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST_F(AtomicFile, WhetherAFileCanBeWrittenIsSaidWithoutWriting) {
  const fs::path old = folder_.write("old.json", "old");
  for (const fs::path& file : {old, at("new.json"), fs::path("/dev/null")})
    EXPECT_NO_THROW(expect_writable(file)) << file;
  EXPECT_EQ(file_content(old), "old");
  EXPECT_FALSE(fs::exists(at("new.json")));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), {}), 1);
  for (const fs::path& file : {folder_.path(), at("absent/new.json"), at("old.json/new.json")})
    EXPECT_THROW(expect_writable(file), Error) << file;
}

TEST_F(AtomicFile, WhatMayNeverEndOrIsTooLargeIsNotRead) {
  const fs::path pipe = at("pipe"), file = folder_.write("file", "12345");
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_NO_THROW(require_readable(file, 5));
  EXPECT_THROW(require_readable(file, 4), Error);
  for (const fs::path& other : {pipe, fs::path("/dev/zero"), folder_.path(), at("absent")})
    EXPECT_THROW(require_readable(other, 5), Error) << other;
}

TEST_F(AtomicFile, ALinkStaysAndWhatItLeadsToIsReplaced) {
  fs::create_directory(at("far"));
  folder_.write("far/real.json", "old");
  fs::create_symlink("far/real.json", at("middle"));
  fs::create_symlink(at("middle"), at("link"));
  fs::create_symlink("far/later.json", at("dangling"));
  write_file_atomically(at("link"), std::string_view("new"));
  write_file_atomically(at("dangling"), std::string_view("made"));
  EXPECT_TRUE(fs::is_symlink(at("link")));
  EXPECT_TRUE(fs::is_symlink(at("dangling")));
  EXPECT_EQ(file_content(at("far/real.json")), "new");
  EXPECT_EQ(file_content(at("far/later.json")), "made");
}

TEST_F(AtomicFile, WhoMayReadItMayStillAndASecretIsItsOwners) {
  const auto mode = [](const fs::path& file) {
    return static_cast<unsigned>(fs::status(file).permissions());
  };
  for (const unsigned before : {0600U, 0640U, 0664U}) {
    folder_.write("file", "old");
    fs::permissions(at("file"), static_cast<fs::perms>(before));
    write_file_atomically(at("file"), std::string_view("new"));
    EXPECT_EQ(mode(at("file")), before);
    write_file_atomically(at("file"), std::string_view("secret"), Secrecy::OwnerOnly);
    EXPECT_EQ(mode(at("file")), 0600U);
  }
  write_file_atomically(at("fresh"), std::string_view("secret"), Secrecy::OwnerOnly);
  EXPECT_EQ(mode(at("fresh")), 0600U);
}

TEST_F(AtomicFile, WhatCannotBeReadIsNotEmpty) {
  EXPECT_EQ(file_content(at("absent")), "");
  EXPECT_EQ(file_content(at("absent/below")), "");
  EXPECT_THROW((void)file_content(folder_.path()), Error);
  fs::create_symlink("itself", at("itself"));
  EXPECT_THROW((void)file_content(at("itself")), Error);
}

TEST_F(AtomicFile, AFolderIsRefusedAndNothingIsLeft) {
  fs::create_directory(at("folder"));
  EXPECT_THROW(write_file_atomically(at("folder"), std::string_view("x")), Error);
  EXPECT_TRUE(fs::is_empty(at("folder")));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), {}), 1);
}

/// What would make a site that every later command refuses is not committed.
TEST_F(AtomicFile, ATransactionReadsItsSiteBack) {
  const char* good = "madori_site: 1\nname: hall\ndrawing: {file: a.png, width_px: 1000, height_px: 500}\n";
  folder_.write("site.yaml", good);
  folder_.write("walls.csv", "id,x1,y1,x2,y2\n1,0,0,1,0\n");
  for (const auto& [name, text] :
       {std::pair{"site.yaml", std::string(good) + "scale: {m_per_px: 1e-300, method: known}\n"},
        {"walls.csv", std::string("id,x1,y1,x2,y2\n1,nan,0,1,0\n")}}) {
    SiteTransaction change(folder_.path());
    change.write(name, text);
    EXPECT_THROW(change.commit(), Error) << name;
  }
  EXPECT_EQ(file_content(at("site.yaml")), good);
  EXPECT_EQ(file_content(at("walls.csv")), "id,x1,y1,x2,y2\n1,0,0,1,0\n");
}

}  // namespace
}  // namespace madori::mapping
