#include "sensors/rosbag/bag_file.hpp"

#include <algorithm>
#include <iterator>
#include <system_error>
#include <tuple>

#include "sensors/rosbag/unpack_chunk.hpp"

namespace madori::sensors::rosbag_bridge {
namespace {

constexpr std::string_view kFirstLine = "#ROSBAG V2.0\n";
constexpr std::uint32_t kNoChunk = 0xFFFFFFFFU;
enum RecordKind : std::uint8_t {  // the format's "op"
  kMessage = 2,
  kBagHeader = 3,
  kChunkIndex = 4,
  kChunk = 5,
  kChunkInfo = 6,
  kConnection = 7
};

std::uint64_t take_time_ns(BagBytes& in) {
  const auto seconds = in.number<std::uint32_t>();
  return seconds * std::uint64_t{1'000'000'000} + in.number<std::uint32_t>();
}

}  // namespace

/// A record of the file: what its header says, and where its data lie.
struct BagFile::Record {
  BagFields header;
  std::uint64_t data = 0, data_bytes = 0;

  [[nodiscard]] std::uint64_t end() const { return data + data_bytes; }
};

BagFile::BagFile(const std::filesystem::path& file) : stream_(file, std::ios::binary) {
  std::error_code none;
  size_ = stream_ ? std::filesystem::file_size(file, none) : 0;
  if (!stream_ || none) throw std::runtime_error("it cannot be opened");
  const auto first = read(0, std::min<std::uint64_t>(size_, kFirstLine.size()));
  if (!std::ranges::equal(first, kFirstLine))
    throw std::runtime_error("it does not begin as one of format 2.0");
  const BagFields header = record_at(kFirstLine.size(), kBagHeader).header;
  if (!header.text("encryptor").empty()) throw std::runtime_error("it is encrypted");
  const auto index = header.number<std::uint64_t>("index_pos");
  if (index == 0) throw std::runtime_error("it has no index");
  unpacked_chunk_ = kNoChunk;
  read_index(index, header.number<std::uint32_t>("conn_count"), header.number<std::uint32_t>("chunk_count"));
}

std::vector<std::uint8_t> BagFile::read(std::uint64_t at, std::uint64_t size) {
  if (at > size_ || size > size_ - at) throw std::runtime_error("it ends too soon");
  std::vector<std::uint8_t> bytes(size);
  stream_.seekg(static_cast<std::streamoff>(at));
  if (!stream_.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size)))
    throw std::runtime_error("it cannot be read");
  return bytes;
}

BagFile::Record BagFile::record_at(std::uint64_t at, std::uint8_t kind) {
  const auto number_at = [this](std::uint64_t place) {
    return BagBytes(read(place, sizeof(std::uint32_t))).number<std::uint32_t>();
  };
  const std::uint64_t header = at + sizeof(std::uint32_t);
  const std::uint64_t header_bytes = number_at(at);
  Record record{BagFields(read(header, header_bytes)), header + header_bytes + sizeof(std::uint32_t), 0};
  record.data_bytes = number_at(header + header_bytes);
  if (record.header.number<std::uint8_t>("op") != kind)
    throw std::runtime_error("another record stands where its index says");
  if (record.data_bytes > size_ - record.data) throw std::runtime_error("it ends too soon");
  return record;
}

/// Chunks follow each other: two that share bytes of the file would let a small file ask for any memory.
void BagFile::read_index(std::uint64_t at, std::uint32_t connections, std::uint32_t chunks) {
  for (std::uint32_t i = 0; i < connections; ++i) {
    const Record record = record_at(at, kConnection);
    const BagFields says(read(record.data, record.data_bytes));
    connections_[record.header.number<std::uint32_t>("conn")] = {record.header.text("topic"),
                                                                 says.text("type"), says.text("md5sum")};
    at = record.end();
  }
  std::map<std::uint64_t, std::uint32_t> infos;  // where a chunk begins -> how many connections it has
  for (std::uint32_t i = 0; i < chunks; ++i) {
    const Record record = record_at(at, kChunkInfo);
    infos[record.header.number<std::uint64_t>("chunk_pos")] = record.header.number<std::uint32_t>("count");
    at = record.end();
  }
  std::uint64_t end = 0;
  for (const auto& [begin, count] : infos) {
    if (begin < end) throw std::runtime_error("its chunks overlap");
    end = read_chunk_index(begin, count);
  }
}

std::uint64_t BagFile::read_chunk_index(std::uint64_t at, std::uint32_t connections) {
  const Record chunk = record_at(at, kChunk);
  const auto number = static_cast<std::uint32_t>(chunks_.size());
  chunks_.push_back({chunk.data, chunk.data_bytes, chunk.header.number<std::uint32_t>("size"),
                     chunk.header.text("compression")});
  at = chunk.end();
  for (std::uint32_t i = 0; i < connections; ++i) {
    const Record record = record_at(at, kChunkIndex);
    const auto connection = record.header.number<std::uint32_t>("conn");
    const auto bytes = read(record.data, record.data_bytes);
    for (BagBytes in(bytes); !in.empty();) {
      const std::uint64_t recorded_ns = take_time_ns(in);
      places_.push_back({recorded_ns, connection, number, in.number<std::uint32_t>()});
    }
    at = record.end();
  }
  return at;
}

std::vector<BagFile::Place> BagFile::places(const std::set<std::uint32_t>& connections) const {
  std::vector<Place> found;
  std::ranges::copy_if(places_, std::back_inserter(found),
                       [&](const Place& place) { return connections.contains(place.connection); });
  std::ranges::sort(
      found, {}, [](const Place& place) { return std::tuple(place.recorded_ns, place.chunk, place.offset); });
  return found;
}

void BagFile::unpack(std::uint32_t chunk) {
  if (chunk == unpacked_chunk_) return;
  unpacked_chunk_ = kNoChunk;
  const Chunk& which = chunks_.at(chunk);
  unpacked_ = unpacked(read(which.begin, which.packed_bytes), which.compression, which.bytes);
  unpacked_chunk_ = chunk;
}

Bytes BagFile::message(const Place& place) {
  unpack(place.chunk);
  BagBytes in(unpacked_);
  (void)in.take(place.offset);
  const BagFields header(in.counted());
  if (header.number<std::uint8_t>("op") != kMessage ||
      header.number<std::uint32_t>("conn") != place.connection)
    throw std::runtime_error("another record stands where its index says");
  return in.counted();
}

}  // namespace madori::sensors::rosbag_bridge
