#include "app/recording/bag_room.hpp"

#include <algorithm>
#include <numeric>
#include <string>
#include <tuple>
#include <vector>

#include "app/iso_time.hpp"
#include "app/learned/kept_memory.hpp"
#include "core/result.hpp"

namespace madori::app {
namespace {

namespace fs = std::filesystem;

struct Bag {
  fs::path path;
  std::uintmax_t bytes = 0;
  fs::file_time_type written;  ///< by the time of day, which may have been set since
  int number = -1;             ///< of the run that is recorded

  friend bool operator<(const Bag& a, const Bag& b) {
    if (a.number != b.number) return a.number < b.number;
    return std::tie(a.written, a.path) < std::tie(b.written, b.path);
  }
};

void add_bags(const fs::path& folder, bool recorded_now, std::vector<Bag>& bags) {
  if (!fs::is_directory(folder)) return;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const fs::path ending = entry.path().extension();
    if ((ending != ".bag" && ending != ".active") || !entry.is_regular_file()) continue;
    const int number = recorded_now ? bag_number(entry.path()) : -1;
    bags.push_back({entry.path(), entry.file_size(), entry.last_write_time(), number});
  }
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

/// Oldest first, while `must`. Of one that cannot be removed younger ones take the place; it is noted.
template <class Must>
void remove_oldest(std::vector<Bag>& bags, fs::path& stays, Must&& must) {
  std::sort(bags.begin(), bags.end());
  auto next = bags.begin();
  for (std::uintmax_t left = bytes_of(bags); next != bags.end() && must(left); ++next) {
    std::error_code error;
    fs::remove(next->path, error);
    if (error)
      stays = next->path;
    else
      left -= next->bytes;
  }
  bags.erase(bags.begin(), next);
}

void keep_newest_two(std::vector<Bag>& of_this_run) {
  std::sort(of_this_run.begin(), of_this_run.end());
  of_this_run.resize(of_this_run.size() > 2 ? of_this_run.size() - 2 : 0);
}

/// What a run began with is of no use without its first bag.
void remove_remains(const fs::path& run) {
  std::error_code stays;
  if (!fs::exists(run / "000.bag") && !fs::exists(run / "000.bag.active"))
    fs::remove(run / kMemoryFile, stays);
  for (const fs::path& folder : {run / "stops", run})
    if (fs::is_directory(folder) && fs::is_empty(folder)) fs::remove(folder, stays);
}

}  // namespace

int bag_number(const fs::path& bag) {
  const std::string name = bag.filename().string();
  const std::string digits = name.substr(0, name.find('.'));
  const bool numbered =
      !digits.empty() && digits.size() < 9 && digits.find_first_not_of("0123456789") == std::string::npos;
  return numbered ? std::stoi(digits) : -1;
}

fs::path new_run(const fs::path& runs) {
  std::string name = iso_time_utc();
  std::replace(name.begin(), name.end(), ':', '-');
  fs::path run = runs / name;
  for (int again = 2; fs::exists(run); ++again) run = runs / (name + "-" + std::to_string(again));
  return run;
}

void make_room(const fs::path& run, const RoomLimits& limits) {
  if (!fs::is_directory(run))
    throw Error(run.string(), "was removed or renamed while it is recorded into",
                "put the site's folder back, or start the program anew");
  std::vector<Bag> ordinary;
  std::vector<Bag> stops;
  fs::path stays;
  add_bags(run, true, ordinary);
  const std::uintmax_t of_this_run = bytes_of(ordinary);
  keep_newest_two(ordinary);
  const std::uintmax_t fixed = of_this_run - bytes_of(ordinary);
  const auto runs = runs_beside(run);
  for (const fs::path& other : runs) {
    if (other != run) add_bags(other, false, ordinary);
    add_bags(other / "stops", other == run, stops);
  }
  remove_oldest(ordinary, stays, [&](std::uintmax_t left) { return left + fixed > limits.max_bytes; });
  remove_oldest(stops, stays, [&](std::uintmax_t left) { return left > limits.max_stop_bytes; });
  const auto full = [&](std::uintmax_t /*left*/) { return fs::space(run).available < limits.min_free_bytes; };
  remove_oldest(ordinary, stays, full);
  remove_oldest(stops, stays, full);
  for (const fs::path& other : runs)
    if (other != run) remove_remains(other);
  if (!stays.empty())
    throw Error(stays.string(), "cannot be removed to make room for recordings",
                "remove it, or let the user own its folder that runs this program");
}

}  // namespace madori::app
