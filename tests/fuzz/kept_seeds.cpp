#include <string>

#include "app/mapping_drive/drive_journal.hpp"
#include "hmi/server/site_backup.hpp"
#include "localization/memory/memory_file.hpp"
#include "localization/ndt_map/hybrid_map_file.hpp"
#include "localization/wall_reliability/reliability_file.hpp"
#include "localization/warp/warp_file.hpp"
#include "mapping/days/day_file.hpp"
#include "mapping/site/atomic_file.hpp"
#include "mapping/site/site.hpp"
#include "mapping/site/site_transaction.hpp"
#include "tests/fuzz/learned_walls.hpp"
#include "tests/fuzz/seeds.hpp"
#include "tests/support/temporary_folder.hpp"

namespace madori::fuzz {
namespace {

std::string chosen(char choice, const std::string& bytes) {
  return std::string(1, choice) + bytes;
}

void day_seed(const std::filesystem::path& folder) {
  mapping::DayMap map;
  map.day = *mapping::civil_day("2026-11-25");
  map.frame = "1a2b3c";
  map.resize(12, 9);
  map.set(3, 4, {mapping::DayState::Static, 2});
  save(folder / "day", chosen(0, mapping::day_png(map)));
}

void journal_seed(const std::filesystem::path& folder) {
  const test::TemporaryFolder own;
  {
    app::DriveJournal drive(own.path() / "drive.bin", 0);
    drive.add(OdometryReading{});
    drive.add(app::DriveScan{{}, {0.2, 0.0}, {{1.0, 2.0}, {3.0, 1.0}}});
  }
  save(folder / "drive", chosen(0, mapping::file_content(own.path() / "drive.bin")));
}

/// A site that was saved twice, with routes and an aerial photograph.
void backup_seeds(const std::filesystem::path& folder) {
  const test::TemporaryFolder own;
  const auto site = own.path() / "site", file = own.path() / "b.tar";
  const auto text = "madori_site: 1\nname: hall\ndrawing: {file: drawing.png, width_px: 10, height_px: 5}\n";
  for (const char* walls : {"1,0,0,5,0\n", "1,0,0,5,0\n2,5,0,5,4\n"}) {
    mapping::SiteTransaction change(site);
    change.write("site.yaml", text);
    change.write("walls.csv", std::string("id,x1,y1,x2,y2\n") + walls);
    change.write("routes/tree.csv", "ID,EDA\n0,1\n1,0\n");
    change.write("routes/path.csv", "ID,x,y\n0,1,1\n1,4,1\n");
    change.write("tiles/18/5/7.png", "a photograph");
    change.write("reliability.csv", reliability_csv(localization::WallReliability(learned_walls())));
    change.commit();
  }
  hmi::write_backup(site, file);
  for (char choice = 0; choice < 4; ++choice)
    save(folder / std::to_string(choice), chosen(choice, mapping::file_content(file)));
}

std::string memory_seed() {
  localization::Memory memory;
  for (int k = 0; k < 4; ++k) {
    localization::SurfaceScan scan;
    scan.stamp = Stamp(std::chrono::milliseconds(100 * k));
    for (int i = 0; i < 12; ++i) scan.points.push_back({2.0, 0.1 * i - 0.4 * k, 0.6, 0.8});
    if (k == 2) memory.note_break();
    memory.add(scan, 0.5, {0.4 * k, 0.1 * k, 0.05 * k}, 400.0 * Eigen::Matrix3d::Identity());
  }
  return memory_bytes(memory, kLearnedOn);
}

std::string living_map_seed() {
  localization::HybridMap map;
  map.draw(learned_walls());
  for (int look = 1; look < 4; ++look)
    map.look({{}, 0.3, {{2.0F, 0.1F, 0.3F}, {0.1F, 2.0F, 0.3F}}}, {1.0, 1.0, 0.1 * look},
             stamp_from_seconds(10.0 * look));
  return hybrid_map_bytes(map, kLearnedOn);
}

std::string warp_seed() {
  localization::WarpField field;
  field.width = 3, field.height = 2;
  field.control_m.assign(12, 0.1);
  field.sigma_m.assign(6, 0.2);
  localization::WarpFit fit;
  fit.warp = localization::DrawingWarp({1.01, 0.002, 0.3, -0.1}, field, {0.21, 14.0, 0.031, 0.022, 0.7});
  fit.walls.assign(learned_walls().size(), {{{{0.02, 0.02, 1.5, 0.8}, {0.01, 0.03, 0.0, 0.0}}}});
  return warp_text(fit, learned_walls());
}

std::string reliability_seed() {
  localization::WallReliability learned(learned_walls());
  std::vector<localization::WallBelief> beliefs(learned.cells().size());
  for (std::size_t i = 0; i < beliefs.size(); ++i)
    beliefs[i] = {1.0 * static_cast<double>(i % 7), 1.0 * static_cast<double>(i % 3), 2.0, 0.3, 0.05, 0.01};
  learned.set_beliefs(std::move(beliefs));
  return reliability_csv(learned);
}

void learned_seeds(const std::filesystem::path& folder) {
  save(folder / "memory", chosen(0, memory_seed()));
  save(folder / "memory-summed", chosen(4, memory_seed()));
  save(folder / "map", chosen(1, living_map_seed()));
  save(folder / "map-summed", chosen(5, living_map_seed()));
  const std::string warp = warp_seed(), reliability = reliability_seed();
  save(folder / "warp", chosen(2, warp));
  save(folder / "warp-headed", chosen(6, warp.substr(head_of(warp, 2).size())));
  save(folder / "reliability", chosen(3, reliability));
  save(folder / "reliability-headed", chosen(7, reliability.substr(head_of(reliability, 1).size())));
}

}  // namespace

void kept_seeds(const std::filesystem::path& folder) {
  day_seed(folder / "day");
  journal_seed(folder / "drive_journal");
  save(folder / "site/plain.yaml", mapping::site_yaml(mapping::Site{}));
  backup_seeds(folder / "backup");
  learned_seeds(folder / "learned");
}

}  // namespace madori::fuzz
