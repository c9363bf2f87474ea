// A scanner that is asked for each scan, on a real socket.
#include <gtest/gtest.h>

#include <atomic>
#include <vector>

#include "sensors/lidar/registry.hpp"
#include "sensors/lms1xx/client.hpp"
#include "sensors/lms1xx/encode.hpp"
#include "simulation/devices/device_hub.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/temporary_folder.hpp"

namespace madori::simulation {
namespace {

namespace lms1xx = sensors::lms1xx;
using test::eventually;

TEST(Lms1xxClient, AsksForEachScanWhereItIsPolled) {
  DeviceHubOptions options;
  const test::TemporaryFolder folder;
  options.folder = folder.path();
  mapping::SensorRecord scanner;
  scanner.name = "front", scanner.type = "lms1xx", scanner.settings["cola"] = "A";
  options.sensors = {scanner};
  DeviceHub hub(options);
  lms1xx::ScanData data;
  data.channels16.push_back({{'D', 'I', 'S', 'T', '1'}, 1.0F, 0.0F, -450'000, 5'000, {1000, 2000, 3}});
  std::atomic<int> scans = 0;
  lms1xx::Client client({.host = "127.0.0.1",
                         .port = hub.lms_port(),
                         .dialect = lms1xx::Dialect::A,
                         .poll_every = std::chrono::milliseconds(100)},
                        [&](const LaserScan& scan, const lms1xx::ScanData&) {
                          if (scan.ranges_m == std::vector<float>{1.0F, 2.0F, LaserScan::kNoReturn}) ++scans;
                        });
  int sent = 0;
  EXPECT_TRUE(eventually([&] {
    data.telegram_counter = static_cast<std::uint16_t>(++sent);
    data.scan_time_us += 1'000;
    data.transmit_time_us = data.scan_time_us;
    hub.send({Device::Lms1xx, {}, lms1xx::encode(lms1xx::Dialect::A, data), 0});
    (void)hub.poll();
    return scans >= 4;
  }));
  EXPECT_LT(scans * 3, sent) << "it did not get all, but what it asked for";
  EXPECT_EQ(client.counters().lost, 0U) << "what was not asked for is not lost";
}

/// 5 of an LMS5xx: the error's bit and the screen's.
TEST(Lms1xxClient, TellsADirtyScreenFromAnotherError) {
  DeviceHubOptions options;
  const test::TemporaryFolder folder;
  options.folder = folder.path();
  DeviceHub hub(options);
  lms1xx::Client client({.host = "127.0.0.1", .port = hub.lms_port()}, [](const auto&, const auto&) {});
  lms1xx::ScanData data;
  data.channels16.push_back({{'D', 'I', 'S', 'T', '1'}, 1.0F, 0.0F, -450'000, 5'000, {1000, 2000, 3}});
  for (const auto& [status, words] : {std::pair<std::uint8_t, const char*>{5, "too dirty to measure"},
                                      {4, "too dirty to measure"},
                                      {1, "device error"},
                                      {2, "clean it soon"}}) {
    data.status = {0, status};
    EXPECT_TRUE(eventually([&, words = words] {
      ++data.telegram_counter;
      data.transmit_time_us = data.scan_time_us += 1'000;
      hub.send({Device::Lms1xx, {}, lms1xx::encode(lms1xx::Dialect::B, data), 0});
      (void)hub.poll();
      return client.problem().find(words) != std::string::npos;
    })) << client.problem();
  }
}

/// Bytes of a stream that nobody asked for: a decoder takes as many scans as would have been asked for.
TEST(Lms1xxDecoder, TakesOfAStreamWhatWouldBeAskedFor) {
  sensors::LidarSettings settings;
  settings.name = "front";
  settings.values["cola"] = "A";
  settings.values["poll_hz"] = "5";
  int sweeps = 0;
  const auto decoder =
      sensors::lidar_of("lms1xx", "").decoder(settings, [&](sensors::LidarSweep&) { ++sweeps; });
  lms1xx::ScanData data;
  data.channels16.push_back({{'D', 'I', 'S', 'T', '1'}, 1.0F, 0.0F, -450'000, 5'000, {}});
  data.channels16.front().values.assign(541, 3000);
  for (int scan = 0; scan < 100; ++scan) {  // two seconds at 50 Hz
    data.scan_time_us = static_cast<std::uint32_t>(scan) * 20'000U;
    data.transmit_time_us = data.scan_time_us + 15'000U;
    decoder->push(lms1xx::encode(lms1xx::Dialect::A, data), stamp_from_seconds(1.0 + 0.02 * scan));
  }
  EXPECT_EQ(sweeps, 10);
  EXPECT_EQ(decoder->counters().lost, 0U);
}

}  // namespace
}  // namespace madori::simulation
