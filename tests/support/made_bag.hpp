#pragma once

#include <bzlib.h>

#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

#include "sensors/rosbag/messages.hpp"

namespace madori::test {

/// Bytes of a little-endian number.
template <class Number>
std::string number_bytes(Number value) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}

/// A record of a bag: fields "name=value" and data, each behind its size.
inline std::string bag_record(const std::vector<std::string>& fields, const std::string& data) {
  std::string header;
  for (const std::string& field : fields)
    header += number_bytes(static_cast<std::uint32_t>(field.size())) + field;
  return number_bytes(static_cast<std::uint32_t>(header.size())) + header +
         number_bytes(static_cast<std::uint32_t>(data.size())) + data;
}

inline std::string packed_by_bz2(std::string bytes) {
  std::string packed(bytes.size() + bytes.size() / 100 + 600, '\0');
  auto size = static_cast<unsigned>(packed.size());
  if (BZ2_bzBuffToBuffCompress(packed.data(), &size, bytes.data(), static_cast<unsigned>(bytes.size()), 1, 0,
                               0) != BZ_OK)
    throw std::runtime_error("bzip2 failed");
  packed.resize(size);
  return packed;
}

/// A message as it lies in a bag: its type's place among kMessageTypes, and its bytes.
struct MadeMessage {
  std::size_t type = 0;
  std::string bytes;
};

/// A bag of one chunk, with a topic "/0", "/1" ... for each type of which it has messages; `compression` is
/// "none" or "bz2".
inline std::string made_bag(const std::vector<MadeMessage>& messages, const std::string& compression) {
  using namespace sensors::rosbag_bridge;
  const auto field32 = [](const char* name, std::size_t value) {
    return name + number_bytes(static_cast<std::uint32_t>(value));
  };
  const auto op = [](char kind) { return std::string("op=") + kind; };
  std::string chunk, connections, index;
  std::vector<std::string> of_type(std::size(kMessageTypes));
  for (std::size_t i = 0; i < messages.size(); ++i) {
    const auto& [type, bytes] = messages[i];
    const std::string time = number_bytes(static_cast<std::uint32_t>(i + 1)) + number_bytes(0U);
    of_type[type] += time + number_bytes(static_cast<std::uint32_t>(chunk.size()));
    chunk += bag_record({op(2), field32("conn=", type), "time=" + time}, bytes);
  }
  std::size_t topics = 0;
  for (std::size_t type = 0; type < of_type.size(); ++type) {
    if (of_type[type].empty()) continue;
    ++topics;
    const std::string topic = "topic=/" + std::to_string(type);
    const std::string says = bag_record({std::string("type=") + kMessageTypes[type].name,
                                         std::string("md5sum=") + kMessageTypes[type].md5sum},
                                        "");
    connections += bag_record({op(7), field32("conn=", type), topic}, says.substr(4, says.size() - 8));
    index += bag_record(
        {op(4), field32("ver=", 1), field32("conn=", type), field32("count=", of_type[type].size() / 12)},
        of_type[type]);
  }
  const std::string packed = compression == "bz2" ? packed_by_bz2(chunk) : chunk;
  const std::string body =
      bag_record({op(5), "compression=" + compression, field32("size=", chunk.size())}, packed) + index;
  const std::string first = "#ROSBAG V2.0\n";
  const auto head = [&](std::uint64_t index_at) {
    return first + bag_record({op(3), "index_pos=" + number_bytes(index_at), field32("conn_count=", topics),
                               field32("chunk_count=", 1)},
                              "");
  };
  const std::uint64_t begin = head(0).size();
  return head(begin + body.size()) + body + connections +
         bag_record(
             {op(6), field32("ver=", 1), "chunk_pos=" + number_bytes(begin), field32("count=", topics)}, "");
}

}  // namespace madori::test
