#pragma once

#include <sqlite3.h>

#include <cstdint>
#include <memory>
#include <string>

#include "core/result.hpp"

namespace madori::app {

/// Throws Error with the database's message where a call did not answer SQLITE_OK.
inline void check(sqlite3* database, int code) {
  if (code != SQLITE_OK)
    throw Error(sqlite3_db_filename(database, "main"), sqlite3_errmsg(database),
                "check free disk space and permissions; no other program may hold it");
}

/// Throws Error where the file is not at its place any more: what is written would be in no folder that
/// somebody finds.
inline void require_in_place(sqlite3* database) {
  int moved = 0;
  (void)sqlite3_file_control(database, "main", SQLITE_FCNTL_HAS_MOVED, &moved);
  if (moved != 0)
    throw Error(sqlite3_db_filename(database, "main"), "was removed or renamed while the program runs",
                "put the site's folder back, or start the program anew");
}

/// A prepared SQLite statement. Throws Error with the database's message, and where the file has gone.
class Statement {
 public:
  Statement(sqlite3* database, const char* sql) : database_(database) {
    require_in_place(database);
    sqlite3_stmt* raw = nullptr;
    check(sqlite3_prepare_v2(database, sql, -1, &raw, nullptr));
    statement_.reset(raw);
  }

  template <class... Values>
  Statement& bind(const Values&... values) {
    int column = 0;
    (bind_one(++column, values), ...);
    return *this;
  }
  /// True while there is a row.
  bool step() {
    const int code = sqlite3_step(statement_.get());
    if (code != SQLITE_ROW) check(code == SQLITE_DONE ? SQLITE_OK : code);
    return code == SQLITE_ROW;
  }
  /// Runs a statement without rows.
  void run() {
    while (step()) {
    }
  }

  [[nodiscard]] std::int64_t integer(int column) const {
    return sqlite3_column_int64(statement_.get(), column);
  }
  [[nodiscard]] double real(int column) const { return sqlite3_column_double(statement_.get(), column); }
  [[nodiscard]] std::string text(int column) const {
    const unsigned char* text = sqlite3_column_text(statement_.get(), column);
    return text == nullptr ? "" : std::string(reinterpret_cast<const char*>(text));
  }

 private:
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
  };
  void check(int code) const { app::check(database_, code); }
  void bind_one(int column, std::int64_t value) {
    check(sqlite3_bind_int64(statement_.get(), column, value));
  }
  void bind_one(int column, int value) { bind_one(column, static_cast<std::int64_t>(value)); }
  void bind_one(int column, std::size_t value) { bind_one(column, static_cast<std::int64_t>(value)); }
  void bind_one(int column, double value) { check(sqlite3_bind_double(statement_.get(), column, value)); }
  void bind_one(int column, const std::string& value) {
    check(sqlite3_bind_text(statement_.get(), column, value.c_str(), -1, SQLITE_TRANSIENT));
  }

  sqlite3* database_;
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
};

/// Everything until commit() happens as one, or not at all.
class Transaction {
 public:
  explicit Transaction(sqlite3* database) : database_(database) {
    Statement(database, "BEGIN IMMEDIATE").run();
  }
  ~Transaction() {
    if (!committed_) sqlite3_exec(database_, "ROLLBACK", nullptr, nullptr, nullptr);
  }
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  void commit() {
    Statement(database_, "COMMIT").run();
    committed_ = true;
  }

 private:
  sqlite3* database_;
  bool committed_ = false;
};

}  // namespace madori::app
