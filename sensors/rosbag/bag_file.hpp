#pragma once

#include <filesystem>
#include <fstream>
#include <map>
#include <set>

#include "sensors/rosbag/bag_bytes.hpp"

namespace madori::sensors::rosbag_bridge {

/// A bag of format 2.0 (http://wiki.ros.org/Bags/Format/2.0), by its index: messages as bytes. Nothing that
/// the file says of itself is believed before it is seen to lie within the file: no size is allocated, and no
/// place read, that does not. Every function throws std::runtime_error with the reason.
class BagFile {
 public:
  struct Connection {
    std::string topic, type, md5sum;
  };
  /// Where a message lies.
  struct Place {
    std::uint64_t recorded_ns = 0;
    std::uint32_t connection = 0;
    std::uint32_t chunk = 0;   ///< its number in the order of the file
    std::uint32_t offset = 0;  ///< in the chunk, unpacked
  };

  explicit BagFile(const std::filesystem::path& file);

  /// By their numbers.
  [[nodiscard]] const std::map<std::uint32_t, Connection>& connections() const { return connections_; }
  /// Where the messages of some connections lie, in the order of recording.
  [[nodiscard]] std::vector<Place> places(const std::set<std::uint32_t>& connections) const;
  /// A message's bytes, good until the next call.
  [[nodiscard]] Bytes message(const Place& place);

 private:
  struct Record;
  struct Chunk {
    std::uint64_t begin = 0, packed_bytes = 0;
    std::uint32_t bytes = 0;
    std::string compression;
  };
  [[nodiscard]] std::vector<std::uint8_t> read(std::uint64_t at, std::uint64_t size);
  [[nodiscard]] Record record_at(std::uint64_t at, std::uint8_t kind);
  void read_index(std::uint64_t at, std::uint32_t connections, std::uint32_t chunks);
  [[nodiscard]] std::uint64_t read_chunk_index(std::uint64_t at, std::uint32_t connections);
  void unpack(std::uint32_t chunk);

  std::ifstream stream_;
  std::uint64_t size_ = 0;
  std::map<std::uint32_t, Connection> connections_;
  std::vector<Chunk> chunks_;
  std::vector<Place> places_;
  std::vector<std::uint8_t> unpacked_;  ///< the chunk read last
  std::uint32_t unpacked_chunk_ = 0;
};

}  // namespace madori::sensors::rosbag_bridge
