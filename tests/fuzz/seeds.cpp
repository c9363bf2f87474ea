// What every fuzz target begins with, of our own encoders: a search that begins with nothing does not get
// past a length, a signature or a checksum. Usage: fuzz_seeds FOLDER; writes FOLDER/TARGET/NAME.
#include "tests/fuzz/seeds.hpp"

#include <cstdio>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "control/drive_link/wire.hpp"
#include "mapping/site/atomic_file.hpp"
#include "sensors/lms1xx/encode.hpp"
#include "sensors/rosbag/bag_file.hpp"
#include "sensors/rosbag/writer.hpp"
#include "sensors/s300/encode.hpp"
#include "sensors/vlp16/encode.hpp"
#include "tests/support/temporary_folder.hpp"

namespace {

using namespace madori;
using fuzz::Bytes;
using fuzz::save;

template <class Container>
void append(Bytes& to, const Container& more) {
  to.insert(to.end(), more.begin(), more.end());
}

/// As many packets before azimuth 0 as behind it.
Bytes vlp16_packets(sensors::vlp16::ReturnMode mode, int count) {
  namespace vlp16 = sensors::vlp16;
  Bytes bytes;
  const int packet_cdeg = mode == vlp16::ReturnMode::Dual ? 240 : 480;
  int azimuth_cdeg = 36'000 - packet_cdeg * count / 2;
  for (int i = 0; i < count; ++i) {
    vlp16::DataPacket packet;
    packet.mode = mode;
    packet.time_us = static_cast<std::uint32_t>(i * vlp16::packet_us(mode));
    for (std::size_t b = 0; b < vlp16::kBlocks; ++b) {
      packet.blocks[b].azimuth_cdeg = static_cast<std::uint16_t>(azimuth_cdeg % 36'000);
      for (auto& r : packet.blocks[b].returns) r = {static_cast<std::uint16_t>(1000 + 7 * b), 40};
      if (mode != vlp16::ReturnMode::Dual || b % 2 == 1) azimuth_cdeg += 40;
    }
    append(bytes, vlp16::encode(packet));
  }
  return bytes;
}

void vlp16_seeds(const std::filesystem::path& folder) {
  namespace vlp16 = sensors::vlp16;
  for (std::uint8_t choice = 0; choice < 3; ++choice) {
    Bytes bytes{choice};
    append(bytes, vlp16_packets(vlp16::ReturnMode::Dual, 4));
    save(folder / ("dual-" + std::to_string(choice)), bytes);
  }
  Bytes bytes{0};
  append(bytes, vlp16_packets(vlp16::ReturnMode::Strongest, 6));
  save(folder / "strongest", bytes);
  bytes = {0};
  append(bytes, vlp16::encode(vlp16::PositionPacket{
                    12'000'000, 2, "$GPRMC,220516,A,5133.82,N,00042.24,W,0,0,130998,0,W*70"}));
  save(folder / "position", bytes);
}

void s300_seeds(const std::filesystem::path& folder) {
  namespace s300 = sensors::s300;
  for (const auto variant : {s300::Variant::V0201, s300::Variant::V0301, s300::Variant::V0301WithFields})
    for (const auto content :
         {s300::Content::Distances, s300::Content::InputsOutputs, s300::Content::Reflectors}) {
      s300::Telegram telegram;
      telegram.variant = variant;
      telegram.content = content;
      telegram.values.assign(content == s300::Content::Distances ? 541 : 12, 0x4123);
      const std::string name =
          std::to_string(static_cast<int>(variant)) + "-" + std::to_string(static_cast<int>(content));
      save(folder / name, s300::encode(telegram));
    }
}

void cola_seeds(const std::filesystem::path& folder, sensors::lms1xx::Dialect dialect) {
  namespace lms = sensors::lms1xx;
  lms::ScanData data;
  data.channels16 = {
      {{'D', 'I', 'S', 'T', '1'}, 1.0F, 0.0F, -450'000, 5'000, std::vector<std::uint16_t>(541, 2500)}};
  data.channels8 = {
      {{'R', 'S', 'S', 'I', '1'}, 1.0F, 0.0F, -450'000, 5'000, std::vector<std::uint8_t>(541, 90)}};
  Bytes stream = lms::encode(dialect, data);
  data.encoders = {{77, 3}};
  data.channels16.front().values.resize(8);
  data.channels8.clear();
  append(stream, lms::encode(dialect, data));
  save(folder / "two-scans", stream);
  lms::Splitter splitter(dialect);
  splitter.push(stream);
  save(folder / "payload", *splitter.next());
  save(folder / "message", lms::encode(dialect, lms::Message{"sAN", "SetAccessMode", {{1, 1, false, 0}}}));
}

/// A capture of one UDP packet over Ethernet.
void pcap_seed(const std::filesystem::path& folder) {
  Bytes packet{2,    0,    0,    0,    0, 1,  2, 0, 0,  0,  0, 2, 8,   0,  // Ethernet
               0x45, 0,    0,    36,   0, 1,  0, 0, 64, 17, 0, 0, 192, 168, 1, 201,
               255,  255,  255,  255,                                               // IPv4
               0x09, 0x40, 0x09, 0x40, 0, 16, 0, 0, 1,  2,  3, 4, 5,   6,   7, 8};  // UDP
  save(folder / "frame", packet);
  const auto put32 = [](Bytes& to, std::uint32_t value) {
    for (int shift = 0; shift < 32; shift += 8) to.push_back(static_cast<std::uint8_t>(value >> shift));
  };
  Bytes file;
  for (const std::uint32_t word : {0xA1B2C3D4U, 0x0004'0002U, 0U, 0U, 65'535U, 1U}) put32(file, word);
  for (std::uint32_t i = 0; i < 2; ++i) {
    for (const auto word : {1'700'000'000U + i, 5U, static_cast<std::uint32_t>(packet.size()),
                            static_cast<std::uint32_t>(packet.size())})
      put32(file, word);
    append(file, packet);
  }
  save(folder / "file", file);
}

void drive_link_seed(const std::filesystem::path& folder) {
  namespace wire = control::wire;
  Bytes stream;
  std::uint8_t frame[wire::kMaxFrame];
  for (std::uint16_t i = 0; i < 20; ++i) {
    const std::size_t command = wire::encode(wire::Command{i, i > 1, 2'000'000, 2'100'000}, frame);
    stream.insert(stream.end(), frame, frame + command);
    const std::size_t status = wire::encode(wire::Status{.sequence = i,
                                                         .command_sequence = i,
                                                         .time_us = i * 10'000U,
                                                         .left_angle = static_cast<std::uint16_t>(i * 50)},
                                            frame);
    stream.insert(stream.end(), frame, frame + status);
  }
  save(folder / "both-ways", stream);
}

void carmen_seed(const std::filesystem::path& folder) {
  std::string text =
      "PARAM robot_front_laser_max 80\nODOM 1.25 -2.5 0.5 0.1 0 0 976052857.337246 robot 976052857.4\n";
  for (const std::string kind : {"FLASER 180", "RAWLASER1 0 -1.570796 3.14159 0.017453 80 0.01 0 180"}) {
    text += kind;
    for (int i = 0; i < 180; ++i) text += " 2.5";
    if (kind.front() == 'F')
      text += " 1.5 2 0.25 1 2 0.25 976052857.5 robot 976052857.6\n";
    else
      text += " 0 976052857.5 robot 976052857.6\n";
  }
  save(folder / "log", text);
}

/// A bag by our writer, and its messages alone, each behind its type.
void bag_seeds(const std::filesystem::path& folder) {
  const test::TemporaryFolder own;
  const auto file = own.path() / "run.bag";
  const auto at = [](double seconds) { return stamp_from_seconds(1'700'000'000.0 + seconds); };
  sensors::RawPacket packet;
  const Bytes vlp16 = vlp16_packets(sensors::vlp16::ReturnMode::Strongest, 1);
  packet.bytes.assign(vlp16.begin(), vlp16.end());
  {
    sensors::BagWriter bag(file);
    bag.write(
        "/scan",
        LaserScan{
            at(0.01), std::chrono::microseconds(27), -1.5, 0.01, 30.0, {1.0F, LaserScan::kNoReturn}, {}});
    bag.write("/points", PointCloud<Lidar>{at(0.02), {{1.0F, 2.0F, 0.5F, 0.001F, 7, 3}, {4.0F, 5.0F, 0.5F}}});
    bag.write("/odom", OdometryReading{at(0.03), {1.0, 2.0, 0.5}});
    bag.write("/events", "started", at(0.04));
    bag.write("/packets", std::vector<sensors::RawPacket>{packet}, 0, at(0.05));
    bag.close();
  }
  save(folder / "file", std::string(1, '\0') + mapping::file_content(file));
  sensors::rosbag_bridge::BagFile bag(file);
  std::string messages;
  for (const auto& place : bag.places({0, 1, 2, 3, 4})) {
    const auto bytes = bag.message(place);
    messages += static_cast<char>(place.connection);
    messages.append(bytes.begin(), bytes.end());
    messages += '\xff';
  }
  for (const char packing : {'\1', '\2'})
    save(folder / std::to_string(packing), std::string(1, packing) + messages);
}

/// A small room with an inner wall and a door, as a picture and as a drawing.
void drawing_seeds(const std::filesystem::path& image, const std::filesystem::path& dxf) {
  cv::Mat picture(120, 160, CV_8UC1, cv::Scalar(255));
  cv::rectangle(picture, {15, 15}, {144, 104}, cv::Scalar(0), 3);
  cv::line(picture, {80, 15}, {80, 60}, cv::Scalar(0), 3);
  for (const std::string ending : {".png", ".jpg", ".tif", ".bmp"}) {
    Bytes bytes;
    cv::imencode(ending, picture, bytes);
    save(image / ("room" + ending), bytes);
  }
  std::string text = "0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n4\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n";
  const int corners[][4] = {
      {0, 0, 9000, 0}, {9000, 0, 9000, 6000}, {9000, 6000, 0, 6000}, {0, 6000, 0, 0}, {4000, 0, 4000, 3000}};
  for (const auto& [x1, y1, x2, y2] : corners)
    text += "0\nLINE\n8\nWALLS\n10\n" + std::to_string(x1) + "\n20\n" + std::to_string(y1) + "\n11\n" +
            std::to_string(x2) + "\n21\n" + std::to_string(y2) + "\n";
  text += "0\nARC\n8\nDOORS\n10\n4000\n20\n3000\n40\n900\n50\n0\n51\n90\n0\nENDSEC\n0\nEOF\n";
  save(dxf / "room", text);
}

}  // namespace

int main(int count, char** words) {
  if (count != 2) return std::fputs("usage: fuzz_seeds FOLDER\n", stderr), 2;
  const std::filesystem::path folder = words[1];
  vlp16_seeds(folder / "vlp16");
  s300_seeds(folder / "s300");
  cola_seeds(folder / "cola_a", sensors::lms1xx::Dialect::A);
  cola_seeds(folder / "cola_b", sensors::lms1xx::Dialect::B);
  pcap_seed(folder / "pcap");
  drive_link_seed(folder / "drive_link");
  carmen_seed(folder / "carmen");
  bag_seeds(folder / "bag");
  drawing_seeds(folder / "image", folder / "dxf");
  fuzz::kept_seeds(folder);
}
