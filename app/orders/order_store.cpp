#include "app/orders/order_store.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "app/orders/sqlite.hpp"

namespace madori::app {
namespace {

constexpr int kFormat = 2;
constexpr int kBusyMs = 5000;

constexpr std::array kSetUp{
    "PRAGMA journal_mode=WAL",
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

std::int64_t nanoseconds(Stamp stamp) {
  return stamp.time_since_epoch().count();
}

std::vector<OrderStop> stops_of(sqlite3* database, std::int64_t id) {
  Statement query(database,
                  "SELECT node, action, wait_s FROM order_stops WHERE order_id = ? ORDER BY position");
  query.bind(id);
  std::vector<OrderStop> stops;
  while (query.step())
    stops.push_back(
        {static_cast<int>(query.integer(0)), value_named(kActions, query.text(1)), query.real(2)});
  return stops;
}

/// The orders that a condition selects.
template <class... Values>
std::vector<Order> orders_where(sqlite3* database, const std::string& condition, const Values&... values) {
  Statement query(database,
                  ("SELECT id, repeat, state, round, next_stop, note FROM orders " + condition).c_str());
  query.bind(values...);
  std::vector<Order> orders;
  while (query.step())
    orders.push_back({query.integer(0), stops_of(database, query.integer(0)),
                      static_cast<int>(query.integer(1)), value_named(kStates, query.text(2)),
                      static_cast<int>(query.integer(3)), static_cast<std::size_t>(query.integer(4)),
                      query.text(5)});
  return orders;
}

void save_progress(sqlite3* database, const Order& order, Stamp now) {
  Statement(database,
            "UPDATE orders SET state = ?, round = ?, next_stop = ?, note = ?, changed_ns = ? WHERE id = ?")
      .bind(std::string(to_string(order.state)), order.round, order.next_stop, order.note, nanoseconds(now),
            order.id)
      .run();
}

sqlite3* open(const std::filesystem::path& file) {
  sqlite3* database = nullptr;
  if (sqlite3_open(file.c_str(), &database) == SQLITE_OK) return database;
  const std::string what = database == nullptr ? "out of memory" : sqlite3_errmsg(database);
  sqlite3_close(database);
  throw Error(file.string(), what, "check the folder and its permissions");
}

}  // namespace

const char* to_string(StopAction action) {
  switch (action) {
    case StopAction::Pass:
      return "pass";
    case StopAction::Wait:
      return "wait";
    case StopAction::Load:
      return "load";
    case StopAction::Unload:
      return "unload";
  }
  return "pass";
}

const char* to_string(OrderState state) {
  switch (state) {
    case OrderState::Queued:
      return "queued";
    case OrderState::Running:
      return "running";
    case OrderState::Done:
      return "done";
    case OrderState::Cancelled:
      return "cancelled";
    case OrderState::Refused:
      return "refused";
  }
  return "refused";
}

void OrderStore::Close::operator()(sqlite3* database) const {
  sqlite3_close(database);
}

OrderStore::OrderStore(const std::filesystem::path& file) : database_(open(file)), file_(file.string()) {
  sqlite3_busy_timeout(database_.get(), kBusyMs);
  for (const char* sql : kSetUp) Statement(database_.get(), sql).run();
  const auto format = [&] {
    Statement version(database_.get(), "PRAGMA user_version");
    version.step();
    return version.integer(0);
  };
  if (format() > kFormat)
    throw Error(file_, "was written by a newer Madori", "update this one, or use another site folder");
  if (format() == kFormat) return;
  Transaction transaction(database_.get());
  if (format() == kFormat) return;  // another program was quicker
  if (format() < 1)
    for (const char* sql : kTables) Statement(database_.get(), sql).run();
  for (const char* sql : kSequence) Statement(database_.get(), sql).run();
  Statement(database_.get(), ("PRAGMA user_version=" + std::to_string(kFormat)).c_str()).run();
  transaction.commit();
}

OrderStore::~OrderStore() = default;

std::int64_t OrderStore::add(const std::vector<OrderStop>& stops, int repeat, Stamp now) {
  if (stops.empty() || repeat < 1)
    throw Error(file_, "an order needs at least one stop and one round", "name a station: --to ID");
  Transaction transaction(database_.get());
  Statement(database_.get(), "INSERT INTO orders (repeat, state, created_ns, changed_ns) VALUES (?, ?, ?, ?)")
      .bind(repeat, std::string(to_string(OrderState::Queued)), nanoseconds(now), nanoseconds(now))
      .run();
  const std::int64_t id = sqlite3_last_insert_rowid(database_.get());
  Statement(database_.get(), "UPDATE orders SET place = (SELECT MAX(place) + 1 FROM orders) WHERE id = ?")
      .bind(id)
      .run();
  for (std::size_t i = 0; i < stops.size(); ++i)
    Statement(database_.get(), "INSERT INTO order_stops VALUES (?, ?, ?, ?, ?)")
        .bind(id, i, stops[i].node, std::string(to_string(stops[i].action)), stops[i].wait_s)
        .run();
  transaction.commit();
  return id;
}

std::optional<Order> OrderStore::find(std::int64_t id) const {
  auto orders = orders_where(database_.get(), "WHERE id = ?", id);
  if (orders.empty()) return std::nullopt;
  return std::move(orders.front());
}

std::vector<Order> OrderStore::list(bool open_only) const {
  return orders_where(
      database_.get(),
      open_only ? "WHERE state IN ('queued', 'running') ORDER BY state = 'queued', place" : "ORDER BY id");
}

std::optional<Order> OrderStore::begin_next(Stamp now) {
  Transaction transaction(database_.get());
  auto orders = orders_where(database_.get(),
                             "WHERE state IN ('queued', 'running') ORDER BY state = 'queued', place LIMIT 1");
  if (orders.empty()) return std::nullopt;
  Order& order = orders.front();
  if (order.state == OrderState::Queued) {
    order.state = OrderState::Running;
    save_progress(database_.get(), order, now);
  }
  transaction.commit();
  return std::move(order);
}

Order OrderStore::stop_done(std::int64_t id, int round, std::size_t next_stop, Stamp now) {
  Transaction transaction(database_.get());
  auto found = find(id);
  if (!found) throw Error(file_, "holds no order " + std::to_string(id), "");
  Order& order = *found;
  const bool is_next =
      order.state == OrderState::Running && order.round == round && order.next_stop == next_stop;
  if (!is_next) return order;
  Statement(database_.get(), "INSERT INTO stops_done VALUES (?, ?, ?, ?)")
      .bind(id, round, next_stop, nanoseconds(now))
      .run();
  if (++order.next_stop == order.stops.size()) {
    order.next_stop = 0;
    if (++order.round == order.repeat) order.state = OrderState::Done;
  }
  save_progress(database_.get(), order, now);
  transaction.commit();
  return order;
}

void OrderStore::close(std::int64_t id, OrderState state, const std::string& note, Stamp now) {
  Transaction transaction(database_.get());
  auto order = find(id);
  if (!order || (order->state != OrderState::Queued && order->state != OrderState::Running)) return;
  order->state = state;
  order->note = note;
  save_progress(database_.get(), *order, now);
  transaction.commit();
}

std::vector<Order> OrderStore::ended(std::size_t newest) const {
  return orders_where(database_.get(),
                      "WHERE state NOT IN ('queued', 'running') ORDER BY changed_ns DESC, id DESC LIMIT ?",
                      newest);
}

bool OrderStore::arrange(const std::vector<std::int64_t>& ids) {
  Transaction transaction(database_.get());
  std::vector<std::int64_t> queued;
  std::vector<std::int64_t> places;
  Statement query(database_.get(), "SELECT id, place FROM orders WHERE state = 'queued' ORDER BY place");
  while (query.step()) {
    queued.push_back(query.integer(0));
    places.push_back(query.integer(1));
  }
  if (!std::is_permutation(queued.begin(), queued.end(), ids.begin(), ids.end())) return false;
  for (std::size_t i = 0; i < ids.size(); ++i)
    Statement(database_.get(), "UPDATE orders SET place = ? WHERE id = ?").bind(places[i], ids[i]).run();
  transaction.commit();
  return true;
}

Stamp OrderStore::created(std::int64_t id) const {
  Statement query(database_.get(), "SELECT created_ns FROM orders WHERE id = ?");
  query.bind(id);
  return query.step() ? Stamp(Duration(query.integer(0))) : Stamp{};
}

std::int64_t OrderStore::stops_done() const {
  Statement query(database_.get(), "SELECT COUNT(*) FROM stops_done");
  query.step();
  return query.integer(0);
}

void OrderStore::add_event(const EventRecord& event) {
  Statement(database_.get(), "INSERT INTO events (stamp_ns, kind, text) VALUES (?, ?, ?)")
      .bind(nanoseconds(event.stamp), event.kind, event.text)
      .run();
}

std::vector<EventRecord> OrderStore::events(std::size_t newest) const {
  Statement query(database_.get(), "SELECT stamp_ns, kind, text FROM events ORDER BY id DESC LIMIT ?");
  query.bind(newest);
  std::vector<EventRecord> events;
  while (query.step()) events.push_back({Stamp(Duration(query.integer(0))), query.text(1), query.text(2)});
  return events;
}

std::string OrderStore::integrity() const {
  Statement query(database_.get(), "PRAGMA integrity_check");
  query.step();
  return query.text(0);
}

}  // namespace madori::app
