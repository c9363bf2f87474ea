// What it costs to make scans of bytes, on one core.
//   taskset -c 0 build/release/tests/bench/bench_sensors
// Asked: VLP-16 at least 10 million points a second, CoLa B at least 20,000 scans of 541 points a second.
#include <benchmark/benchmark.h>

#include "sensors/lms1xx/encode.hpp"
#include "sensors/s300/encode.hpp"
#include "sensors/vlp16/assembler.hpp"
#include "sensors/vlp16/encode.hpp"

namespace madori::sensors {
namespace {

/// Ten revolutions in which every laser hits something.
std::vector<std::array<std::uint8_t, vlp16::kDataBytes>> revolutions() {
  std::vector<std::array<std::uint8_t, vlp16::kDataBytes>> packets;
  packets.reserve(750);
  unsigned azimuth = 0;
  for (unsigned n = 0; n < 750; ++n) {
    vlp16::DataPacket packet;
    packet.time_us = static_cast<std::uint32_t>(n * 1327.104);
    for (auto& block : packet.blocks) {
      block.azimuth_cdeg = static_cast<std::uint16_t>(azimuth);
      azimuth = (azimuth + 40) % 36'000;
      for (std::size_t i = 0; i < vlp16::kReturns; ++i)
        block.returns[i] = {static_cast<std::uint16_t>(1000 + azimuth % 977 + i),
                            static_cast<std::uint8_t>(i)};
    }
    packets.push_back(vlp16::encode(packet));
  }
  return packets;
}

void vlp16_decode(benchmark::State& state) {
  const auto packets = revolutions();
  std::int64_t points = 0;
  for (auto _ : state) {
    vlp16::Assembler assembler([&](vlp16::Frame& frame) {
      points += static_cast<std::int64_t>(frame.cloud.points.size());
      benchmark::DoNotOptimize(frame.cloud.points.data());
    });
    for (const auto& packet : packets) assembler.push(packet, {});
    assembler.flush();
  }
  state.counters["points/s"] = benchmark::Counter(static_cast<double>(points), benchmark::Counter::kIsRate);
}
BENCHMARK(vlp16_decode)->Unit(benchmark::kMillisecond);

lms1xx::ScanData scan_of_541() {
  lms1xx::ScanData data;
  data.channels16.push_back({{'D', 'I', 'S', 'T', '1'}, 1.0F, 0.0F, -450'000, 5'000, {}});
  for (std::uint16_t i = 0; i < 541; ++i)
    data.channels16[0].values.push_back(static_cast<std::uint16_t>(1000 + 7 * i));
  data.channels8.push_back({{'R', 'S', 'S', 'I', '1'}, 1.0F, 0.0F, -450'000, 5'000, {}});
  data.channels8[0].values.assign(541, 200);
  return data;
}

/// From the TCP stream to a LaserScan with intensities.
void cola_decode(benchmark::State& state, lms1xx::Dialect dialect) {
  const lms1xx::Bytes telegram = lms1xx::encode(dialect, scan_of_541());
  lms1xx::Splitter splitter(dialect);
  for (auto _ : state) {
    splitter.push(telegram);
    const auto data = lms1xx::decode_scan(dialect, *splitter.next());
    auto scan = lms1xx::to_laser_scan(data.value());
    benchmark::DoNotOptimize(scan);
  }
  state.counters["scans/s"] =
      benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}
BENCHMARK_CAPTURE(cola_decode, a, lms1xx::Dialect::A);
BENCHMARK_CAPTURE(cola_decode, b, lms1xx::Dialect::B);

void s300_decode(benchmark::State& state) {
  s300::Telegram telegram;
  telegram.values.assign(541, 700);
  const auto bytes = s300::encode(telegram);
  s300::Stream stream([](const s300::Telegram& t) {
    auto scan = s300::to_laser_scan(t);
    benchmark::DoNotOptimize(scan);
  });
  for (auto _ : state) stream.push(bytes);
  state.counters["scans/s"] =
      benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}
BENCHMARK(s300_decode);

}  // namespace
}  // namespace madori::sensors

BENCHMARK_MAIN();
