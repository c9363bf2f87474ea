// What a site has learned, as a backup may bring it. The first byte chooses: memory, living map, warp or
// reliability, as the file is (0 to 3), or with a right checksum or head (4 to 7). What is taken must be of
// use.
#include <cmath>
#include <string>
#include <string_view>

#include "localization/byte_stream.hpp"
#include "localization/memory/memory_file.hpp"
#include "localization/ndt_map/hybrid_map_file.hpp"
#include "localization/wall_reliability/reliability_file.hpp"
#include "localization/wall_reliability/wall_weights.hpp"
#include "localization/warp/warp_file.hpp"
#include "tests/fuzz/fuzz_file.hpp"
#include "tests/fuzz/learned_walls.hpp"

namespace {

using namespace madori;
using namespace madori::localization;

void require_finite(const mapping::Walls& walls) {
  for (const mapping::Wall& wall : walls) {
    const auto& [a, b] = wall.segment;
    fuzz::require(std::isfinite(a.x_m + a.y_m + b.x_m + b.y_m));
  }
}

/// The last eight bytes become the checksum of those before.
std::string with_sum(std::string_view text) {
  if (text.size() < sizeof(std::uint64_t)) return std::string(text);
  ByteWriter out;
  out.put(text.substr(0, text.size() - sizeof(std::uint64_t)));
  return out.take();
}

void fuzz_memory(const std::string& bytes) {
  const auto parsed = parse_memory(bytes, fuzz::kLearnedOn);
  if (!parsed) return;
  const Memory& memory = parsed.value();
  const auto again = parse_memory(memory_bytes(memory, fuzz::kLearnedOn), fuzz::kLearnedOn);
  fuzz::require(again && again.value().size() == memory.size());
  if (memory.empty()) return;
  (void)memory.recent_map(memory.poses().back().translation());
  (void)memory.whole_map(memory.poses().front().translation());
  Memory thinned = memory;
  thinned.fuse();
  thinned.keep_piece(thinned.pieces().front());
}

void fuzz_living_map(const std::string& bytes) {
  auto parsed = parse_hybrid_map(bytes);
  if (!parsed) return;
  fuzz::require(parse_hybrid_map(hybrid_map_bytes(parsed.value().map, 1)).ok());
  HybridMap map = std::move(parsed).value().map;
  map.draw(fuzz::learned_walls());
  map.look({{}, 0.3, {{2.0F, 0.1F, 0.3F}, {0.1F, 9.0F, 0.3F}}}, {1.0, 1.0, 0.3}, map.newest());
  for (CellTree::Index i = 0; i < map.cells().size(); ++i) (void)map.state(i);
}

void fuzz_warp(const std::string& bytes) {
  static const fuzz::MemoryFile file(".warp");
  file.write(bytes);
  WarpFit fit;
  if (!load_warp(file.path(), fuzz::learned_walls(), fit).empty()) return;
  const Point2<Map> there = fit.warp.map(fit.warp.building(Point2<Map>{3.0, 2.0}));
  fuzz::require(std::isfinite(there.x_m + there.y_m + fit.warp.sigma_m(there)));
  require_finite(walls_in_building(fuzz::learned_walls(), fit));
}

void fuzz_reliability(const std::string& bytes) {
  static const fuzz::MemoryFile file(".csv");
  file.write(bytes);
  WallReliability learned(fuzz::learned_walls());
  if (!load_reliability(file.path(), learned).empty()) return;
  const WallWeights weights = wall_weights(fuzz::learned_walls(), learned);
  require_finite(weights.walls);
  for (std::size_t i = 0; i < learned.cells().size(); ++i)
    fuzz::require(learned.share_in_place(i) >= 0.0 && learned.share_in_place(i) <= 1.0);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string text(reinterpret_cast<const char*>(data) + 1, size - 1);
  const bool right = data[0] % 8 >= 4;
  switch (data[0] % 4) {
    case 0:
      fuzz_memory(right ? with_sum(text) : text);
      break;
    case 1:
      fuzz_living_map(right ? with_sum(text) : text);
      break;
    case 2:
      fuzz_warp(right ? fuzz::head_of(warp_text({}, fuzz::learned_walls()), 2) + text : text);
      break;
    default:
      fuzz_reliability(
          right ? fuzz::head_of(reliability_csv(WallReliability(fuzz::learned_walls())), 1) + text : text);
  }
  return 0;
}
