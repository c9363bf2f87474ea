#include "sensors/lidar/registry.hpp"

#include <algorithm>

#include "core/result.hpp"
#include "sensors/lms1xx/driver.hpp"
#include "sensors/s300/driver.hpp"
#include "sensors/vlp16/driver.hpp"

namespace madori::sensors {
namespace {

std::vector<LidarRow>& rows() {
  static std::vector<LidarRow> all{vlp16::row(), lms1xx::row(), s300::row()};
  return all;
}

}  // namespace

const std::vector<LidarRow>& lidar_rows() {
  return rows();
}

const LidarRow* find_lidar(const std::string& type) {
  const auto found = std::ranges::find(rows(), type, &LidarRow::type);
  return found == rows().end() ? nullptr : &*found;
}

const LidarRow& lidar_of(const std::string& type, const std::string& where) {
  if (const LidarRow* row = find_lidar(type)) return *row;
  throw Error(where, "\"" + type + "\" is no known sensor", "use " + lidar_types());
}

std::string lidar_types() {
  std::string text;
  for (std::size_t i = 0; i < rows().size(); ++i)
    text += (i == 0 ? "" : i + 1 == rows().size() ? " or " : ", ") + rows()[i].type;
  return text;
}

void add_lidar(LidarRow row) {
  std::erase_if(rows(), [&](const LidarRow& old) { return old.type == row.type; });
  rows().push_back(std::move(row));
}

}  // namespace madori::sensors
