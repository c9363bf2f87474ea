#include "app/statistics/statistics_store.hpp"

#include <array>

#include "app/orders/sqlite.hpp"

namespace madori::app {
namespace {

constexpr int kBusyMs = 5000;

constexpr std::array kTables{
    "CREATE TABLE IF NOT EXISTS sums (name TEXT PRIMARY KEY, value REAL NOT NULL)",
    "CREATE TABLE IF NOT EXISTS standstills (code TEXT PRIMARY KEY, count INTEGER NOT NULL, seconds REAL NOT "
    "NULL)",
};

sqlite3* open(const std::filesystem::path& file) {
  sqlite3* database = nullptr;
  if (sqlite3_open(file.c_str(), &database) == SQLITE_OK) return database;
  sqlite3_close(database);
  throw Error(file.string(), "cannot be opened", "check the folder and its permissions");
}

void add_sum(sqlite3* database, const char* name, double value) {
  Statement(database,
            "INSERT INTO sums VALUES (?, ?) ON CONFLICT (name) DO UPDATE SET value = value + excluded.value")
      .bind(std::string(name), value)
      .run();
}

double sum_of(sqlite3* database, const char* name) {
  Statement query(database, "SELECT value FROM sums WHERE name = ?");
  query.bind(std::string(name));
  return query.step() ? query.real(0) : 0.0;
}

}  // namespace

void Work::add(const Work& other) {
  distance_m += other.distance_m;
  driving_s += other.driving_s;
  standing_s += other.standing_s;
  for (const auto& [cause, stood] : other.causes) {
    causes[cause].count += stood.count;
    causes[cause].seconds += stood.seconds;
  }
}

void StatisticsStore::Close::operator()(sqlite3* database) const {
  sqlite3_close(database);
}

StatisticsStore::StatisticsStore(const std::filesystem::path& file) : database_(open(file)) {
  sqlite3_busy_timeout(database_.get(), kBusyMs);
  Statement(database_.get(), "PRAGMA journal_mode=WAL").run();
  for (const char* sql : kTables) Statement(database_.get(), sql).run();
}

StatisticsStore::~StatisticsStore() = default;

void StatisticsStore::add(const Work& work, Stamp now) {
  Transaction transaction(database_.get());
  Statement(database_.get(), "INSERT OR IGNORE INTO sums VALUES ('since_s', ?)").bind(to_seconds(now)).run();
  add_sum(database_.get(), "distance_m", work.distance_m);
  add_sum(database_.get(), "driving_s", work.driving_s);
  add_sum(database_.get(), "standing_s", work.standing_s);
  for (const auto& [cause, stood] : work.causes)
    Statement(database_.get(),
              "INSERT INTO standstills VALUES (?, ?, ?) ON CONFLICT (code) DO UPDATE SET "
              "count = count + excluded.count, seconds = seconds + excluded.seconds")
        .bind(cause, stood.count, stood.seconds)
        .run();
  transaction.commit();
}

Work StatisticsStore::sums() const {
  sqlite3* database = database_.get();
  Work work{
      sum_of(database, "distance_m"), sum_of(database, "driving_s"), sum_of(database, "standing_s"), {}};
  Statement query(database, "SELECT code, count, seconds FROM standstills");
  while (query.step()) work.causes[query.text(0)] = {query.integer(1), query.real(2)};
  return work;
}

std::optional<Stamp> StatisticsStore::since() const {
  const double seconds = sum_of(database_.get(), "since_s");
  return seconds > 0.0 ? std::optional(stamp_from_seconds(seconds)) : std::nullopt;
}

}  // namespace madori::app
