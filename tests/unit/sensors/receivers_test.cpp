// The sensors behind real sockets and a pseudo-terminal.
#include <gtest/gtest.h>

#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ip/udp.hpp>
#include <boost/asio/write.hpp>
#include <string>
#include <thread>
#include <vector>

#include "core/result.hpp"
#include "sensors/lidar/registry.hpp"
#include "sensors/lms1xx/client.hpp"
#include "sensors/lms1xx/encode.hpp"
#include "sensors/s300/encode.hpp"
#include "sensors/s300/receiver.hpp"
#include "sensors/vlp16/encode.hpp"
#include "sensors/vlp16/receiver.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/pseudo_terminal.hpp"

namespace madori::sensors {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using asio::ip::udp;
using test::eventually;

TEST(Vlp16Receiver, TheLidarsOwnAddressIsNotTakenForABusyPort) {
  const vlp16::ReceiverOptions lidars_own{.address = "192.0.2.201", .data_port = 0, .position_port = 0};
  try {
    const vlp16::Receiver receiver(lidars_own, [](vlp16::Frame&) {});
    ADD_FAILURE() << "listens on an address that no computer has";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("is no address of this computer"), std::string::npos) << e.what();
  }
}

TEST(Vlp16Receiver, CutsRevolutionsFromUdp) {
  std::atomic<int> frames = 0, tapped = 0;
  std::atomic<std::size_t> points = 0;
  const vlp16::ReceiverOptions options{.address = "127.0.0.1", .data_port = 0, .position_port = 0};
  vlp16::Receiver receiver(
      options,
      [&](vlp16::Frame& frame) {
        points = frame.cloud.points.size();
        ++frames;
      },
      [&](auto, auto) { ++tapped; });
  asio::io_context context;
  udp::socket socket(context, udp::v4());
  const auto to = [](std::uint16_t port) { return udp::endpoint(asio::ip::make_address("127.0.0.1"), port); };
  vlp16::DataPacket packet;
  for (int i = 0; i < 76; ++i) {
    for (std::size_t b = 0; b < vlp16::kBlocks; ++b) {
      packet.blocks[b].azimuth_cdeg =
          static_cast<std::uint16_t>((i * 12 + static_cast<int>(b)) * 40 % 36'000);
      packet.blocks[b].returns.fill({500, 1});
    }
    packet.time_us = static_cast<std::uint32_t>(1327 * i);
    socket.send_to(asio::buffer(vlp16::encode(packet)), to(receiver.data_port()));
    ASSERT_TRUE(eventually([&] { return tapped == i + 1; }));  // UDP may lose what nobody waits for
  }
  EXPECT_TRUE(eventually([&] { return frames == 1; }));
  EXPECT_EQ(points, 28'800U);
  EXPECT_TRUE(eventually([&] { return receiver.counters().packets == 76U; }));
  EXPECT_EQ(receiver.foreign_sensor(), "");
  socket.send_to(asio::buffer(vlp16::encode(vlp16::PositionPacket{5, 2, "$GPRMC,1"})),
                 to(receiver.position_port()));
  EXPECT_TRUE(eventually([&] { return receiver.position() && receiver.position()->gprmc == "$GPRMC,1"; }));
  EXPECT_THROW(vlp16::Receiver({.address = "no address"}, [](vlp16::Frame&) {}), Error);
}

/// A VLP-16 that sends from a socket of its own, one packet after the other.
class UdpLidar {
 public:
  UdpLidar() : socket_(context_, udp::endpoint(asio::ip::make_address("127.0.0.1"), 0)) {}
  void send(std::uint16_t port) {
    for (std::size_t b = 0; b < vlp16::kBlocks; ++b) {
      packet_.blocks[b].azimuth_cdeg =
          static_cast<std::uint16_t>(azimuth_cdeg_ = (azimuth_cdeg_ + 40) % 36'000);
      packet_.blocks[b].returns.fill({500, 1});
    }
    packet_.time_us += 1327;
    const auto bytes = vlp16::encode(packet_);
    send(port, {bytes.begin(), bytes.end()});
  }
  void send(std::uint16_t port, const std::vector<std::uint8_t>& bytes) {
    socket_.send_to(asio::buffer(bytes), udp::endpoint(asio::ip::make_address("127.0.0.1"), port));
  }
  [[nodiscard]] std::string name() const {
    return "127.0.0.1:" + std::to_string(socket_.local_endpoint().port());
  }

 private:
  asio::io_context context_;
  udp::socket socket_;
  vlp16::DataPacket packet_;
  int azimuth_cdeg_ = 0;
};

TEST(Vlp16Receiver, HearsTheFirstSenderAloneAndAnotherOnceThatOneIsSilent) {
  std::atomic<int> tapped = 0;
  vlp16::Receiver receiver(
      {.address = "127.0.0.1", .data_port = 0, .position_port = 0}, [](auto&) {},
      [&](auto, auto) { ++tapped; });
  UdpLidar lidar, stranger;
  const auto taken = [&] { return receiver.counters().packets; };
  const std::uint16_t port = receiver.data_port();
  for (std::uint64_t i = 1; i <= 50; ++i) {
    stranger.send(i > 10 ? port : 9);  // valid packets, from another sender
    lidar.send(port);
    ASSERT_TRUE(eventually([&] { return taken() == i; })) << i;
  }
  EXPECT_TRUE(eventually([&] { return receiver.stranger() == stranger.name(); }));
  EXPECT_EQ(receiver.counters().late + receiver.counters().duplicates + receiver.counters().refused, 0U);
  EXPECT_EQ(tapped, 50);
  lidar.send(port, std::vector<std::uint8_t>(1000, 7));  // of a wrong length: refused, and not recorded
  ASSERT_TRUE(eventually([&] { return receiver.counters().refused == 1; }));
  EXPECT_EQ(tapped, 50);
  EXPECT_TRUE(eventually([&] { return receiver.silence() > std::chrono::milliseconds(1'100); }));
  stranger.send(port);
  EXPECT_TRUE(eventually([&] { return taken() == 51; })) << "the first one has gone";
}

TEST(Vlp16Receiver, ASecondProgramOnItsPortIsRefused) {
  vlp16::Receiver first({.address = "127.0.0.1", .data_port = 0, .position_port = 0}, [](auto&) {});
  for (const char* address : {"127.0.0.1", "0.0.0.0"})
    EXPECT_THROW(vlp16::Receiver({.address = address, .data_port = first.data_port(), .position_port = 0},
                                 [](auto&) {}),
                 Error);
}

TEST(Vlp16Driver, TellsAnotherModelOfTheMakerAndAStandingRotorFromSilence) {
  LidarSettings settings;
  settings.name = "top";
  settings.address = "127.0.0.1:0";
  settings.values["position_port"] = "0";
  const auto driver = lidar_of("vlp16", "").open(settings, [](LidarSweep&) {}, {});
  const auto says = [&](const char* words) {
    return driver->health().problem.find(words) != std::string::npos;
  };
  EXPECT_TRUE(says("no packets on UDP"));
  UdpLidar lidar;
  vlp16::DataPacket packet;
  packet.product = 0x24;  // Puck Hi-Res
  const auto send = [&] {
    const auto bytes = vlp16::encode(packet);
    lidar.send(driver->port(), {bytes.begin(), bytes.end()});
  };
  send();
  EXPECT_TRUE(eventually([&] { return says("is no VLP-16"); })) << driver->health().problem;
  packet.product = 0x22;
  EXPECT_TRUE(eventually([&] {
    packet.time_us += 1327;
    send();
    return says("its rotor does not turn");
  })) << driver->health().problem;
}

/// An LMS1xx that answers each command, sends three scans, and hangs up.
class FakeScanner {
 public:
  enum class Refuses { Nothing, ByAnswer, ByErrorCode };
  explicit FakeScanner(lms1xx::Dialect dialect, Refuses refuses = Refuses::Nothing)
      : dialect_(dialect),
        refuses_(refuses),
        acceptor_(context_, tcp::endpoint(asio::ip::make_address("127.0.0.1"), 0)) {
    thread_ = std::thread([this] {
      while (!stop_) serve();
    });
  }
  ~FakeScanner() {
    stop_ = true;
    asio::io_context context;
    boost::system::error_code ignored;
    tcp::socket(context).connect(acceptor_.local_endpoint(), ignored);  // wakes accept()
    thread_.join();
  }
  FakeScanner(const FakeScanner&) = delete;
  FakeScanner& operator=(const FakeScanner&) = delete;
  [[nodiscard]] std::uint16_t port() const { return acceptor_.local_endpoint().port(); }

 private:
  void serve() {
    tcp::socket socket = acceptor_.accept();
    lms1xx::Splitter splitter(dialect_);
    std::array<std::uint8_t, 512> buffer{};
    boost::system::error_code problem;
    while (!stop_) {
      const std::size_t count = socket.read_some(asio::buffer(buffer), problem);
      if (problem) return;
      splitter.push(std::span(buffer).first(count));
      while (const auto payload = splitter.next())
        if (!answer(socket, *payload)) return;
    }
  }
  bool answer(tcp::socket& socket, std::span<const std::uint8_t> payload) {
    const auto head = lms1xx::head_of(payload);
    boost::system::error_code problem;
    const bool refused = head->name == "SetAccessMode" && refuses_ != Refuses::Nothing;
    if (refused && refuses_ == Refuses::ByErrorCode)
      return asio::write(socket, asio::buffer(encode(dialect_, lms1xx::Message{"sFA", "", {{1, 2}}})),
                         problem) > 0;
    std::vector<lms1xx::Argument> result{{head->name == "LMCstartmeas" || refused ? 0U : 1U, 1}};
    if (head->kind == "sWN") result.clear();
    const std::string kind = head->kind == "sMN" ? "sAN" : head->kind == "sWN" ? "sWA" : "sEA";
    asio::write(socket,
                asio::buffer(encode(dialect_, lms1xx::Message{kind, std::string(head->name), result})),
                problem);
    if (head->kind != "sEN") return !problem;
    for (std::uint16_t i = 0; i < 6; i = static_cast<std::uint16_t>(i + 2)) {
      lms1xx::ScanData data;
      data.telegram_counter = i;  // every other one is lost
      data.scan_time_us = i * 20'000U;
      data.transmit_time_us = data.scan_time_us + 15'000U;
      data.channels16.push_back({{'D', 'I', 'S', 'T', '1'}, 1.0F, 0.0F, -450'000, 5'000, {1000, 2000, 3}});
      asio::write(socket, asio::buffer(lms1xx::encode(dialect_, data)), problem);
    }
    return false;
  }

  lms1xx::Dialect dialect_;
  Refuses refuses_;
  asio::io_context context_;
  tcp::acceptor acceptor_;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

TEST(Lms1xxClient, StartsReadsAndComesBackAfterALoss) {
  for (const auto dialect : {lms1xx::Dialect::A, lms1xx::Dialect::B}) {
    FakeScanner scanner(dialect);
    std::atomic<int> scans = 0, wrong = 0;
    lms1xx::Client client(
        {.host = "127.0.0.1",
         .port = scanner.port(),
         .dialect = dialect,
         .reconnect_after = std::chrono::milliseconds(5)},
        [&](const LaserScan& scan, const lms1xx::ScanData&) {
          const bool right = scan.ranges_m == std::vector<float>{1.0F, 2.0F, LaserScan::kNoReturn};
          ++(right ? scans : wrong);
        });
    EXPECT_TRUE(eventually([&] { return scans >= 9; }));
    EXPECT_EQ(wrong, 0);
    EXPECT_GE(client.counters().connections, 3U);
    EXPECT_GE(client.counters().lost, 4U);
    EXPECT_EQ(client.counters().damaged + client.counters().refused, 0U);
  }
}

TEST(Lms1xxClient, SaysWhatTheScannerRefuses) {
  using enum FakeScanner::Refuses;
  for (const auto dialect : {lms1xx::Dialect::A, lms1xx::Dialect::B})
    for (const auto how : {ByAnswer, ByErrorCode}) {
      FakeScanner scanner(dialect, how);
      lms1xx::Client client({.host = "127.0.0.1", .port = scanner.port(), .dialect = dialect},
                            [](const auto&, const auto&) {});
      EXPECT_TRUE(eventually([&] {
        return client.problem().find("refuses SetAccessMode") != std::string::npos;
      })) << client.problem();
    }
}

TEST(Lms1xxClient, SaysThatSomebodyElseAnswers) {
  asio::io_context context;
  tcp::acceptor acceptor(context, tcp::endpoint(asio::ip::address_v4::loopback(), 0));
  std::jthread other([&] {
    boost::system::error_code problem;
    tcp::socket socket(context);
    acceptor.accept(socket, problem);
    asio::write(socket, asio::buffer(std::string(200, 'x')), problem);
    std::array<char, 64> rest{};
    while (!problem) socket.read_some(asio::buffer(rest), problem);
  });
  lms1xx::Client client({.host = "127.0.0.1",
                         .port = acceptor.local_endpoint().port(),
                         .reconnect_after = std::chrono::seconds(20)},
                        [](const auto&, const auto&) {});
  EXPECT_TRUE(eventually([&] { return client.problem().find("does not speak CoLa B") != std::string::npos; }))
      << client.problem();
}

TEST(S300Receiver, SaysThatAnotherDeviceOrAnotherFieldOfViewIsThere) {
  test::PseudoTerminal cable;
  std::atomic<int> scans = 0;
  s300::Receiver receiver({.device = cable.name(), .stale_after = std::chrono::milliseconds(150)},
                          [&](const LaserScan&, const s300::Fields&) { ++scans; });
  EXPECT_TRUE(eventually([&] {
    cable.write(std::vector<std::uint8_t>(60, 0x55));
    return receiver.stop_reason().find("no telegram of a safety scanner") != std::string::npos;
  })) << receiver.stop_reason();
  s300::Telegram telegram;
  const auto sends = [&](std::size_t values, const char* words) {
    telegram.values.assign(values, 500);
    return eventually([&] {
      ++telegram.scan_number;
      cable.write(s300::encode(telegram));
      return receiver.stop_reason().find(words) != std::string::npos;
    });
  };
  telegram.values.assign(541, 500);
  EXPECT_TRUE(sends(541, "")) << receiver.stop_reason();
  EXPECT_TRUE(eventually([&] { return scans > 0; }));
  EXPECT_TRUE(sends(361, "sends 361 distances instead of 541")) << receiver.stop_reason();
}

TEST(S300Receiver, StopsTheVehicleOnTheFieldAndOnSilence) {
  test::PseudoTerminal cable;
  std::atomic<int> scans = 0;
  s300::Receiver receiver({.device = cable.name(), .stale_after = std::chrono::milliseconds(150)},
                          [&](const LaserScan&, const s300::Fields&) { ++scans; });
  EXPECT_TRUE(receiver.must_stop());
  s300::Telegram telegram;
  const auto send_until = [&](auto condition) {
    return eventually([&] {
      ++telegram.scan_number;
      cable.write(s300::encode(telegram));
      return condition();
    });
  };
  telegram.values.assign(541, 500);
  EXPECT_TRUE(send_until([&] { return !receiver.must_stop(); })) << receiver.stop_reason();
  telegram.values[7] |= s300::kProtectiveField;
  EXPECT_TRUE(
      send_until([&] { return receiver.stop_reason() == "something stands in the protective field"; }));
  telegram.values.assign(541, s300::kStandbyValue);
  EXPECT_TRUE(send_until([&] { return receiver.stop_reason().find("standby") != std::string::npos; }));
  telegram.values.assign(541, 500);
  EXPECT_TRUE(send_until([&] { return !receiver.must_stop(); }));
  EXPECT_TRUE(eventually([&] { return receiver.stop_reason().find("silent") != std::string::npos; }));
  EXPECT_GE(scans, 4);
}

}  // namespace
}  // namespace madori::sensors
