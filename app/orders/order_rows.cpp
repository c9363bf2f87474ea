#include "app/orders/order_rows.hpp"

#include <algorithm>
#include <array>

namespace madori::app {
namespace {

constexpr std::array kStates{OrderState::Queued, OrderState::Running, OrderState::Done, OrderState::Cancelled,
                             OrderState::Refused};
constexpr std::array kActions{StopAction::Pass, StopAction::Wait, StopAction::Load, StopAction::Unload};

template <class Values>
auto value_named(const Values& values, const std::string& name) {
  const auto* found =
      std::find_if(values.begin(), values.end(), [&](auto v) { return name == to_string(v); });
  if (found == values.end())
    throw Error("madori.db", "holds an unknown word \"" + name + "\"", "restore a backup");
  return *found;
}

std::vector<OrderStop> stops_of(sqlite3* database, std::int64_t id) {
  Statement query(database,
                  "SELECT node, action, wait_s, gone FROM order_stops WHERE order_id = ? ORDER BY position");
  query.bind(id);
  std::vector<OrderStop> stops;
  while (query.step())
    stops.push_back({static_cast<int>(query.integer(0)), value_named(kActions, query.text(1)), query.real(2),
                     query.integer(3) != 0});
  return stops;
}

}  // namespace

std::int64_t nanoseconds(Stamp stamp) {
  return stamp.time_since_epoch().count();
}

Order order_of(sqlite3* database, const Statement& query) {
  return {query.integer(0),
          stops_of(database, query.integer(0)),
          static_cast<int>(query.integer(1)),
          value_named(kStates, query.text(2)),
          static_cast<int>(query.integer(3)),
          static_cast<std::size_t>(query.integer(4)),
          query.text(5)};
}

std::int64_t insert_order(sqlite3* database, const std::vector<OrderStop>& stops, int repeat, Stamp now) {
  Statement(database, "INSERT INTO orders (repeat, state, created_ns, changed_ns) VALUES (?, ?, ?, ?)")
      .bind(repeat, std::string(to_string(OrderState::Queued)), nanoseconds(now), nanoseconds(now))
      .run();
  const std::int64_t id = sqlite3_last_insert_rowid(database);
  Statement(database, "UPDATE orders SET place = (SELECT MAX(place) + 1 FROM orders) WHERE id = ?")
      .bind(id)
      .run();
  for (std::size_t i = 0; i < stops.size(); ++i)
    Statement(database,
              "INSERT INTO order_stops (order_id, position, node, action, wait_s) VALUES (?, ?, ?, ?, ?)")
        .bind(id, i, stops[i].node, std::string(to_string(stops[i].action)), stops[i].wait_s)
        .run();
  return id;
}

void save_progress(sqlite3* database, const Order& order, Stamp now) {
  Statement(database,
            "UPDATE orders SET state = ?, round = ?, next_stop = ?, note = ?, changed_ns = ? WHERE id = ?")
      .bind(std::string(to_string(order.state)), order.round, order.next_stop, order.note, nanoseconds(now),
            order.id)
      .run();
}

}  // namespace madori::app
