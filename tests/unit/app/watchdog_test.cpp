#include "app/runner/watchdog.hpp"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <mutex>
#include <string>
#include <vector>

#include "tests/support/eventually.hpp"
#include "tests/support/temporary_folder.hpp"

namespace madori::app {
namespace {

using std::chrono::milliseconds;

/// systemd's end of sd_notify(3): a datagram socket that the environment names.
class NotifySocket {
 public:
  explicit NotifySocket(const std::string& path) : socket_(::socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strncpy(address.sun_path, path.c_str(), sizeof address.sun_path - 1);
    EXPECT_EQ(::bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    ::setenv("NOTIFY_SOCKET", path.c_str(), 1);
  }
  NotifySocket(const NotifySocket&) = delete;
  NotifySocket& operator=(const NotifySocket&) = delete;
  ~NotifySocket() {
    ::unsetenv("NOTIFY_SOCKET");
    ::close(socket_);
  }
  /// What came since the last call.
  std::vector<std::string> heard() {
    std::vector<std::string> all;
    char text[256];
    for (ssize_t size = 0; (size = ::recv(socket_, text, sizeof text, 0)) > 0;)
      all.emplace_back(text, static_cast<std::size_t>(size));
    return all;
  }

 private:
  int socket_;
};

TEST(Watchdog, SystemdHearsOfAThreadThatComesRoundAndOfNoOther) {
  const test::TemporaryFolder folder;
  NotifySocket systemd(folder.path() / "notify");
  std::mutex mutex;
  std::vector<std::string> told;
  const auto said = [&] {
    const std::scoped_lock lock(mutex);
    return told;
  };
  {
    Watchdog dog({milliseconds(300), milliseconds(20), milliseconds(20), [&](const std::string& text) {
                    const std::scoped_lock lock(mutex);
                    told.push_back(text);
                  }});
    std::vector<std::string> heard;
    ASSERT_TRUE(test::eventually([&] {
      dog.beat();
      for (auto& word : systemd.heard()) heard.push_back(std::move(word));
      return heard.size() > 5;
    }));
    EXPECT_EQ(heard.front(), "READY=1");
    EXPECT_EQ(heard.back(), "WATCHDOG=1");
    EXPECT_TRUE(said().empty());
    ASSERT_TRUE(test::eventually([&] {  // this thread does not come round; its socket is read on
      (void)systemd.heard();
      return said().size() == 1;
    }));
    EXPECT_NE(said().front().find("has not come round"), std::string::npos) << said().front();
    EXPECT_NE(said().front().find("(it "), std::string::npos) << said().front();
    (void)systemd.heard();
    std::this_thread::sleep_for(milliseconds(150));
    EXPECT_TRUE(systemd.heard().empty());
    dog.beat();
    ASSERT_TRUE(test::eventually([&] {
      dog.beat();
      (void)systemd.heard();
      return said().size() == 2;
    }));
    EXPECT_EQ(said().back(), "the thread that hung comes round again");
  }
  EXPECT_EQ(systemd.heard().back(), "STOPPING=1");
}

}  // namespace
}  // namespace madori::app
