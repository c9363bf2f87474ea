#include "localization/ndt_map/hybrid_map_file.hpp"

#include "core/fnv1a.hpp"
#include "localization/byte_stream.hpp"

namespace madori::localization {
namespace {

constexpr std::string_view kMagic = "MADORILM";
constexpr std::uint32_t kVersion = 2;
constexpr std::size_t kLeastBytes = 36;  // of a cell

void put_gaussian(ByteWriter& out, const CellGaussian& g) {
  out.put(g.samples);
  if (g.empty()) return;
  out.put(g.x_m);
  out.put(g.y_m);
  for (const float v : {g.xx_m2, g.xy_m2, g.yy_m2, g.z_m, g.zz_m2}) out.put(v);
}

CellGaussian get_gaussian(ByteReader& in) {
  CellGaussian g;
  g.samples = in.get<float>();
  if (g.empty()) return g;
  g.x_m = in.metres<double>();
  g.y_m = in.metres<double>();
  for (float* v : {&g.xx_m2, &g.xy_m2, &g.yy_m2, &g.z_m, &g.zz_m2}) *v = in.metres<float>();
  return g;
}

void put_cell(ByteWriter& out, const CellPlace& place, const MapCell& cell) {
  const CellLayers& l = cell.layers;
  out.put(place.column);
  out.put(place.row);
  out.put(static_cast<std::int64_t>(l.seen.time_since_epoch().count()));
  for (const float v : {l.now, l.stands, l.permanent}) out.put(v);
  put_gaussian(out, cell.gaussian);
  put_gaussian(out, cell.lasting);
}

MapCell get_cell(ByteReader& in) {
  MapCell cell;
  CellLayers& l = cell.layers;
  l.seen = Stamp(Duration(in.get<std::int64_t>()));
  for (float* v : {&l.now, &l.stands, &l.permanent}) *v = in.get<float>();
  cell.gaussian = get_gaussian(in);
  cell.lasting = get_gaussian(in);
  return cell;
}

bool is_possible(const CellGaussian& g) {
  return g.samples >= 0.0F && g.xx_m2 >= 0.0F && g.yy_m2 >= 0.0F && g.zz_m2 >= 0.0F;
}

/// Only cells that were seen are kept, and no clock tells a time before 1970.
bool is_possible(const MapCell& cell) {
  return cell.layers.seen > Stamp{} && is_possible(cell.gaussian) && is_possible(cell.lasting);
}

}  // namespace

std::string hybrid_map_bytes(const HybridMap& map, std::uint64_t walls) {
  const CellTree& cells = map.cells();
  std::uint32_t seen = 0;
  for (CellTree::Index i = 0; i < cells.size(); ++i) seen += cells[i].layers.was_seen() ? 1U : 0U;
  ByteWriter out;
  out.put(kMagic);
  out.put(kVersion);
  out.put(walls);
  out.put(map.options().cell_m);
  out.put(seen);
  for (CellTree::Index i = 0; i < cells.size(); ++i)
    if (cells[i].layers.was_seen()) put_cell(out, cells.place(i), cells[i]);
  return out.take();
}

Result<KeptHybridMap> parse_hybrid_map(std::string_view bytes, const HybridMapOptions& options) {
  const auto refuse = [](const char* reason) { return Result<KeptHybridMap>::failure(reason); };
  if (!bytes.starts_with(kMagic) || bytes.size() < kMagic.size() + sizeof(std::uint64_t))
    return refuse("it is no living map of Madori");
  const std::string_view body = bytes.substr(0, bytes.size() - sizeof(std::uint64_t));
  ByteReader end(bytes.substr(body.size()));
  ByteReader in(body.substr(kMagic.size()));
  if (in.get<std::uint32_t>() != kVersion) return refuse("it was written by another version");
  if (end.get<std::uint64_t>() != fnv1a(body)) return refuse("it is damaged");
  KeptHybridMap kept{HybridMap(options), in.get<std::uint64_t>()};
  if (in.get<double>() != options.cell_m) return refuse("its cells have another size");
  const std::uint32_t cells = in.count(kLeastBytes);
  if (cells > options.most_cells) return refuse("it holds more cells than are kept");
  for (std::uint32_t i = 0; i < cells; ++i) {
    const auto column = in.get<std::int32_t>();
    const auto row = in.get<std::int32_t>();
    const MapCell cell = get_cell(in);
    if (!in.ok() || !is_possible(cell)) return refuse("it is damaged");
    kept.map.restore({column, row}, cell);
  }
  if (!in.at_end()) return refuse("it is damaged");
  return kept;
}

}  // namespace madori::localization
