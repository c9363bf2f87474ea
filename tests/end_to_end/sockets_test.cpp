// A run recorded through real UDP, TCP and pseudo-terminals equals the in-process transport, byte for byte
// and scan for scan. Both factories take the same steps and the same drive commands; nothing here looks at a
// clock except to give up waiting for the kernel.
#include <arpa/inet.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <functional>
#include <thread>

#include "simulation/devices/device_hub.hpp"
#include "simulation/factory.hpp"
#include "tests/support/receiver.hpp"
#include "tests/support/small_hall.hpp"
#include "tests/support/temporary_folder.hpp"

namespace madori::simulation {
namespace {

namespace lms1xx = sensors::lms1xx;
namespace wire = control::wire;
using Bytes = std::vector<std::uint8_t>;
using std::chrono::milliseconds;
using test::Receiver;

constexpr milliseconds kStep(5);

/// A file descriptor that closes itself.
struct Handle {
  int fd;
  explicit Handle(int given) : fd(given) {}
  ~Handle() { ::close(fd); }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
};

sockaddr_in loopback(std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

sockaddr* generic(sockaddr_in& address) {
  return reinterpret_cast<sockaddr*>(&address);
}

/// Whatever can be read now without waiting.
Bytes read_some(int fd) {
  std::array<std::uint8_t, 65'536> buffer;
  const ssize_t count = ::read(fd, buffer.data(), buffer.size());
  return count > 0 ? Bytes(buffer.begin(), buffer.begin() + count) : Bytes{};
}

bool wait_for(const std::function<bool()>& done) {
  for (int i = 0; i < 3000; ++i) {
    if (done()) return true;
    std::this_thread::sleep_for(milliseconds(1));
  }
  return false;
}

/// The PC's ends of all wires.
class RealWires {
 public:
  RealWires()
      : udp_(::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK, 0)), tcp_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in any = loopback(0);
    EXPECT_EQ(::bind(udp_.fd, generic(any), sizeof any), 0);
    socklen_t size = sizeof any;
    EXPECT_EQ(::getsockname(udp_.fd, generic(any), &size), 0);
    const int large = 4 << 20;
    ::setsockopt(udp_.fd, SOL_SOCKET, SO_RCVBUF, &large, sizeof large);
    DeviceHubOptions options;
    options.vlp16_port = ntohs(any.sin_port);
    options.folder = folder_.path();
    hub_.emplace(options);
    sockaddr_in server = loopback(hub_->lms_port());
    EXPECT_EQ(::connect(tcp_.fd, generic(server), sizeof server), 0);
    ::fcntl(tcp_.fd, F_SETFL, O_NONBLOCK);
    s300_.emplace(::open(hub_->s300_link().c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK));
    drive_.emplace(::open(hub_->drive_link().c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK));
    EXPECT_GE(s300_->fd, 0);
    EXPECT_GE(drive_->fd, 0);
  }

  /// The start-up dialogue; true when every message was answered and scans were granted.
  bool start_lms() {
    lms1xx::Splitter splitter(lms1xx::Dialect::B);
    for (const lms1xx::Message& message : lms1xx::start_dialogue(true)) {
      const Bytes bytes = lms1xx::encode(lms1xx::Dialect::B, message);
      if (::write(tcp_.fd, bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size())) return false;
      std::string answered;
      const bool heard = wait_for([&] {
        (void)hub_->poll();
        splitter.push(read_some(tcp_.fd));
        if (const auto payload = splitter.next())
          if (const auto head = lms1xx::head_of(*payload)) answered = head->name;
        return !answered.empty();
      });
      if (!heard || answered != message.name) return false;
    }
    return true;
  }

  void send(const std::vector<DevicePacket>& packets) {
    for (const DevicePacket& p : packets) hub_->send(p);
  }
  /// Writes to the drive's port and waits until the device has it.
  Bytes to_drive(const Bytes& bytes) {
    EXPECT_EQ(::write(drive_->fd, bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
    Bytes arrived;
    EXPECT_TRUE(wait_for([&] {
      const Bytes more = hub_->poll();
      arrived.insert(arrived.end(), more.begin(), more.end());
      return arrived.size() >= bytes.size();
    }));
    return arrived;
  }
  /// Records whatever has come in.
  void record(Stamp received) {
    (void)hub_->poll();
    for (Bytes packet = read_some(udp_.fd); !packet.empty(); packet = read_some(udp_.fd))
      recorded.push_back({Device::Vlp16, received, std::move(packet)});
    const auto stream = [&](Device device, int fd) {
      for (Bytes chunk = read_some(fd); !chunk.empty(); chunk = read_some(fd))
        recorded.push_back({device, received, std::move(chunk)});
    };
    stream(Device::Lms1xx, tcp_.fd);
    stream(Device::S300, s300_->fd);
    stream(Device::Drive, drive_->fd);
  }

  std::vector<DevicePacket> recorded;

 private:
  test::TemporaryFolder folder_;
  Handle udp_, tcp_;
  std::optional<DeviceHub> hub_;
  std::optional<Handle> s300_, drive_;
};

Bytes bytes_of(const std::vector<DevicePacket>& packets, Device device) {
  Bytes all;
  for (const DevicePacket& p : packets)
    if (p.device == device) all.insert(all.end(), p.bytes.begin(), p.bytes.end());
  return all;
}

Bytes command(std::uint16_t sequence) {
  std::array<std::uint8_t, wire::kMaxFrame> frame{};
  const bool enable = sequence > 1;
  const std::size_t size = wire::encode(wire::Command{sequence, enable, 4'000'000, 5'500'000}, frame.data());
  return {frame.begin(), frame.begin() + static_cast<std::ptrdiff_t>(size)};
}

FactorySetup noisy_hall() {
  FactorySetup setup = test::small_hall(30.0, 20.0, 8.0, 8.0);
  setup.scenario.vehicle = {};
  setup.scenario.vlp16 = {};
  setup.scenario.lms1xx = {};
  setup.scenario.s300 = {};
  MoverSpec person;
  person.path = {{14.0, 4.0}, {14.0, 16.0}};
  setup.scenario.movers = {person};
  return setup;
}

void expect_same_scans(const std::deque<LaserScan>& a, const std::deque<LaserScan>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].ranges_m, b[i].ranges_m) << i;
    EXPECT_EQ(a[i].intensities, b[i].intensities) << i;
    EXPECT_EQ(a[i].angle_min_rad, b[i].angle_min_rad);
  }
}

TEST(Sockets, CarryTheSameBytesAndScansAsTheInProcessTransport) {
  const FactorySetup setup = noisy_hall();
  Factory inside(setup), outside(setup);
  std::vector<DevicePacket> direct;
  RealWires wires;
  ASSERT_TRUE(wires.start_lms());
  for (std::uint16_t step = 1; step <= 300; ++step) {
    if (step % 4 == 1) {
      const Bytes bytes = command(static_cast<std::uint16_t>(step / 4 + 1));
      inside.drive_write(bytes);
      outside.drive_write(wires.to_drive(bytes));
    }
    inside.step(kStep), outside.step(kStep);
    for (auto& p : inside.take_packets()) direct.push_back(std::move(p));
    wires.send(outside.take_packets());
    wires.record(outside.now());
  }
  const auto complete = [&](Device device) {
    const std::size_t expected = bytes_of(direct, device).size();
    return wait_for([&] {
      wires.record(outside.now());
      return bytes_of(wires.recorded, device).size() >= expected;
    });
  };
  for (const Device device : {Device::Vlp16, Device::Lms1xx, Device::S300, Device::Drive}) {
    EXPECT_TRUE(complete(device)) << to_string(device);
    EXPECT_EQ(bytes_of(wires.recorded, device), bytes_of(direct, device)) << to_string(device);
  }
  EXPECT_EQ(inside.truth().map_from_base.x_m(), outside.truth().map_from_base.x_m());
  EXPECT_GT(inside.distance_driven_m(), 0.5);

  Receiver from_sockets({}), from_memory({});
  from_sockets.push(wires.recorded), from_memory.push(direct);
  ASSERT_EQ(from_sockets.clouds.size(), from_memory.clouds.size());
  EXPECT_GE(from_memory.clouds.size(), 14U);
  for (std::size_t i = 0; i < from_memory.clouds.size(); ++i)
    EXPECT_EQ(from_sockets.clouds[i].points, from_memory.clouds[i].points) << i;
  EXPECT_GE(from_memory.lms_scans.size(), 74U);
  expect_same_scans(from_sockets.lms_scans, from_memory.lms_scans);
  expect_same_scans(from_sockets.s300_scans, from_memory.s300_scans);
  const auto a = from_sockets.latest_odometry().odom_from_base,
             b = from_memory.latest_odometry().odom_from_base;
  EXPECT_EQ(a.x_m(), b.x_m());
  EXPECT_EQ(a.yaw_rad(), b.yaw_rad());
}

TEST(Sockets, SerialPortsDisappearWithTheirFactory) {
  const test::TemporaryFolder folder;
  DeviceHubOptions options;
  options.folder = folder.path();
  {
    const DeviceHub hub(options);
    EXPECT_TRUE(std::filesystem::is_symlink(folder.path() / "drive"));
  }
  EXPECT_FALSE(std::filesystem::exists(std::filesystem::symlink_status(folder.path() / "drive")));
}

}  // namespace
}  // namespace madori::simulation
