#include "app/orders/order_database.hpp"

#include <array>
#include <string>

#include "app/orders/sqlite.hpp"

namespace madori::app {
namespace {

constexpr int kFormat = 3;
constexpr int kBusyMs = 5000;
constexpr int kAskAgainMs = 20;

constexpr std::array kSetUp{
    "PRAGMA synchronous=FULL",
    "PRAGMA foreign_keys=ON",
};
constexpr std::array kTables{
    "CREATE TABLE IF NOT EXISTS orders (id INTEGER PRIMARY KEY AUTOINCREMENT, repeat INTEGER NOT NULL, "
    "state TEXT NOT NULL, round INTEGER NOT NULL DEFAULT 0, next_stop INTEGER NOT NULL DEFAULT 0, "
    "note TEXT NOT NULL DEFAULT '', created_ns INTEGER NOT NULL, changed_ns INTEGER NOT NULL)",
    "CREATE TABLE IF NOT EXISTS order_stops (order_id INTEGER NOT NULL REFERENCES orders(id), "
    "position INTEGER NOT NULL, node INTEGER NOT NULL, action TEXT NOT NULL, wait_s REAL NOT NULL, "
    "PRIMARY KEY (order_id, position))",
    "CREATE TABLE IF NOT EXISTS stops_done (order_id INTEGER NOT NULL REFERENCES orders(id), "
    "round INTEGER NOT NULL, position INTEGER NOT NULL, done_ns INTEGER NOT NULL, "
    "PRIMARY KEY (order_id, round, position))",
    "CREATE TABLE IF NOT EXISTS events (id INTEGER PRIMARY KEY, stamp_ns INTEGER NOT NULL, kind TEXT NOT "
    "NULL, "
    "text TEXT NOT NULL)",
};

/// From format 1: the queue can be put in another sequence.
constexpr std::array kSequence{
    "ALTER TABLE orders ADD COLUMN place INTEGER NOT NULL DEFAULT 0",
    "UPDATE orders SET place = id",
};

/// From format 2: a station's number is given again after it was deleted.
constexpr const char* kGone = "ALTER TABLE order_stops ADD COLUMN gone INTEGER NOT NULL DEFAULT 0";

sqlite3* open(const std::filesystem::path& file) {
  sqlite3* database = nullptr;
  if (sqlite3_open(file.c_str(), &database) == SQLITE_OK) return database;
  const std::string what = database == nullptr ? "out of memory" : sqlite3_errmsg(database);
  sqlite3_close(database);
  throw Error(file.string(), what, "check the folder and its permissions");
}

/// SQLite does not wait by its busy timeout for this change, so that two programs that open the file at once
/// refused one another (https://www.sqlite.org/c3ref/busy_handler.html: where waiting could be a deadlock).
void write_ahead(sqlite3* database) {
  const auto ask = [&] {
    return sqlite3_exec(database, "PRAGMA journal_mode=WAL", nullptr, nullptr, nullptr);
  };
  int code = ask();
  for (int waited_ms = 0; code == SQLITE_BUSY && waited_ms < kBusyMs; waited_ms += kAskAgainMs) {
    sqlite3_sleep(kAskAgainMs);
    code = ask();
  }
  check(database, code);
}

std::int64_t format_of(sqlite3* database) {
  Statement version(database, "PRAGMA user_version");
  version.step();
  return version.integer(0);
}

/// All steps from the file's format to today's as one transaction: a crash between them leaves the old one.
void bring_up_to_date(sqlite3* database) {
  Transaction transaction(database);
  const std::int64_t format = format_of(database);
  if (format == kFormat) return;  // another program was quicker
  if (format < 1)
    for (const char* sql : kTables) Statement(database, sql).run();
  if (format < 2)
    for (const char* sql : kSequence) Statement(database, sql).run();
  Statement(database, kGone).run();
  Statement(database, ("PRAGMA user_version=" + std::to_string(kFormat)).c_str()).run();
  transaction.commit();
}

}  // namespace

void CloseDatabase::operator()(sqlite3* database) const {
  sqlite3_close(database);
}

Database open_order_database(const std::filesystem::path& file) {
  Database database(open(file));
  sqlite3_busy_timeout(database.get(), kBusyMs);
  write_ahead(database.get());
  for (const char* sql : kSetUp) Statement(database.get(), sql).run();
  const std::int64_t format = format_of(database.get());
  if (format > kFormat)
    throw Error(file.string(), "was written by a newer Madori",
                "update this one, or use another site folder");
  if (format != kFormat) bring_up_to_date(database.get());
  return database;
}

}  // namespace madori::app
