#pragma once

#include <filesystem>
#include <memory>

struct sqlite3;

namespace madori::app {

struct CloseDatabase {
  void operator()(sqlite3* database) const;
};
using Database = std::unique_ptr<sqlite3, CloseDatabase>;

/// Opens madori.db, or makes it, and brings its tables up to today's format: one that an older Madori wrote
/// keeps its orders. Throws Error where it cannot be used or was written by a newer one.
[[nodiscard]] Database open_order_database(const std::filesystem::path& file);

}  // namespace madori::app
