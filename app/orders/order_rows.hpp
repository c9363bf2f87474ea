#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "app/orders/order.hpp"
#include "app/orders/sqlite.hpp"
#include "core/stamp.hpp"

namespace madori::app {

/// A stamp as the tables hold it.
[[nodiscard]] std::int64_t nanoseconds(Stamp stamp);

/// The columns of `orders` that order_of() reads.
inline constexpr const char* kOrderColumns = "id, repeat, state, round, next_stop, note";
/// The order in the row where `query`, over kOrderColumns, stands, with its stops. Throws Error where a word
/// in it is unknown.
[[nodiscard]] Order order_of(sqlite3* database, const Statement& query);

/// The orders that a condition selects: SQL from WHERE or ORDER BY on, a question mark for each value.
template <class... Values>
[[nodiscard]] std::vector<Order> orders_where(sqlite3* database, const std::string& condition,
                                              const Values&... values) {
  Statement query(database, ("SELECT " + std::string(kOrderColumns) + " FROM orders " + condition).c_str());
  query.bind(values...);
  std::vector<Order> orders;
  while (query.step()) orders.push_back(order_of(database, query));
  return orders;
}

/// Writes a new queued order behind the others and returns its ID. Within a transaction.
std::int64_t insert_order(sqlite3* database, const std::vector<OrderStop>& stops, int repeat, Stamp now);
/// Writes what changes while an order is worked off: state, round, next stop, note.
void save_progress(sqlite3* database, const Order& order, Stamp now);

}  // namespace madori::app
