#include "app/orders/order_store.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "app/cycle/notice.hpp"
#include "app/orders/order_rows.hpp"

namespace madori::app {
namespace {

/// About 20 MB: a busy site writes 6,000 events a day, and one whose tablets play with Pause a thousand a
/// second.
constexpr std::int64_t kMostEvents = 200'000;
constexpr std::int64_t kForgottenAtOnce = 1'000;  ///< of a database that was filled without a limit

/// The first stop still to come whose station is no more.
std::optional<int> gone_ahead(const Order& order) {
  const bool again = order.round + 1 < order.repeat;
  for (std::size_t i = again ? 0 : order.next_stop; i < order.stops.size(); ++i)
    if (order.stops[i].gone) return order.stops[i].node;
  return std::nullopt;
}

}  // namespace

OrderStore::OrderStore(const std::filesystem::path& file)
    : database_(open_order_database(file)), file_(file.string()) {}

OrderStore::~OrderStore() = default;

std::int64_t OrderStore::add(const std::vector<OrderStop>& stops, int repeat, Stamp now) {
  if (stops.empty() || repeat < 1)
    throw Error(file_, "an order needs at least one stop and one round", "name a station: --to ID");
  Transaction transaction(database_.get());
  if (open_count() >= kMostOpen)
    throw Error(file_, std::to_string(kMostOpen) + " orders wait already",
                "let them be done, or cancel some");
  const std::int64_t id = insert_order(database_.get(), stops, repeat, now);
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

std::int64_t OrderStore::open_count() const {
  Statement query(database_.get(), "SELECT COUNT(*) FROM orders WHERE state IN ('queued', 'running')");
  query.step();
  return query.integer(0);
}

void OrderStore::keep_stations(const std::vector<int>& nodes, Stamp now) {
  Transaction transaction(database_.get());
  const std::set<int> there(nodes.begin(), nodes.end());
  std::vector<int> gone;
  Statement query(database_.get(), "SELECT DISTINCT node FROM order_stops WHERE gone = 0");
  while (query.step())
    if (const int node = static_cast<int>(query.integer(0)); !there.contains(node)) gone.push_back(node);
  if (gone.empty()) return;
  for (const int node : gone)
    Statement(database_.get(), "UPDATE order_stops SET gone = 1 WHERE node = ?").bind(node).run();
  for (Order& order : list(true)) {
    const auto stop = gone_ahead(order);
    if (!stop) continue;
    order.state = OrderState::Refused;
    order.note = notice(Cause::UnknownNode, {{"node", std::to_string(*stop)}}).text;
    save_progress(database_.get(), order, now);
    add_event({now, "order", "order " + std::to_string(order.id) + " refused: " + order.note});
  }
  transaction.commit();
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
  Statement(
      database_.get(),
      "DELETE FROM events WHERE id IN (SELECT id FROM events WHERE id <= (SELECT max(id) FROM events) - ? "
      "ORDER BY id LIMIT ?)")
      .bind(kMostEvents, kForgottenAtOnce)
      .run();
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
