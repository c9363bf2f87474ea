#include "app/recording/bag_room.hpp"

#include <algorithm>
#include <numeric>
#include <string>
#include <tuple>
#include <vector>

#include "core/result.hpp"

namespace madori::app {
namespace {

namespace fs = std::filesystem;

struct Bag {
  fs::path path;
  std::uintmax_t bytes = 0;
  fs::file_time_type written;

  friend bool operator<(const Bag& a, const Bag& b) {
    return std::tie(a.written, a.path) < std::tie(b.written, b.path);
  }
};

void add_bags(const fs::path& folder, std::vector<Bag>& bags) {
  if (!fs::is_directory(folder)) return;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".bag" || entry.path().extension() == ".active")
      bags.push_back({entry.path(), entry.file_size(), entry.last_write_time()});
}

std::vector<fs::path> runs_beside(const fs::path& run) {
  if (run.parent_path().filename() != "runs") return {run};
  std::vector<fs::path> runs;
  for (const auto& entry : fs::directory_iterator(run.parent_path()))
    if (entry.is_directory()) runs.push_back(entry.path());
  return runs;
}

std::uintmax_t bytes_of(const std::vector<Bag>& bags) {
  return std::accumulate(bags.begin(), bags.end(), std::uintmax_t{0},
                         [](std::uintmax_t sum, const Bag& bag) { return sum + bag.bytes; });
}

/// Oldest first, while `must`.
template <class Must>
void remove_oldest(std::vector<Bag>& bags, Must&& must) {
  std::sort(bags.begin(), bags.end());
  auto next = bags.begin();
  for (std::uintmax_t left = bytes_of(bags); next != bags.end() && must(left); ++next) {
    fs::remove(next->path);
    left -= next->bytes;
  }
  bags.erase(bags.begin(), next);
}

void keep_newest_two(std::vector<Bag>& of_this_run) {
  std::sort(of_this_run.begin(), of_this_run.end());
  of_this_run.resize(of_this_run.size() > 2 ? of_this_run.size() - 2 : 0);
}

void remove_empty(const fs::path& run) {
  for (const fs::path& folder : {run / "stops", run})
    if (fs::is_directory(folder) && fs::is_empty(folder)) fs::remove(folder);
}

}  // namespace

void make_room(const fs::path& run, const RoomLimits& limits) {
  if (!fs::is_directory(run))
    throw Error(run.string(), "was removed or renamed while it is recorded into",
                "put the site's folder back, or start the program anew");
  std::vector<Bag> ordinary;
  std::vector<Bag> stops;
  add_bags(run, ordinary);
  const std::uintmax_t of_this_run = bytes_of(ordinary);
  keep_newest_two(ordinary);
  const std::uintmax_t fixed = of_this_run - bytes_of(ordinary);
  const auto runs = runs_beside(run);
  for (const fs::path& other : runs) {
    if (other != run) add_bags(other, ordinary);
    add_bags(other / "stops", stops);
  }
  remove_oldest(ordinary, [&](std::uintmax_t left) { return left + fixed > limits.max_bytes; });
  remove_oldest(stops, [&](std::uintmax_t left) { return left > limits.max_stop_bytes; });
  const auto full = [&](std::uintmax_t /*left*/) { return fs::space(run).available < limits.min_free_bytes; };
  remove_oldest(ordinary, full);
  remove_oldest(stops, full);
  for (const fs::path& other : runs)
    if (other != run) remove_empty(other);
}

}  // namespace madori::app
