#include "app/panel/panel_orders.hpp"

#include <array>
#include <utility>

#include "app/panel/event_words.hpp"
#include "app/panel/notices.hpp"
#include "app/route_tools.hpp"
#include "core/clock.hpp"
#include "mapping/site/site_transaction.hpp"
#include "planning/route_graph/route_csv.hpp"

namespace madori::app {
namespace {

constexpr int kMostRepeats = 1000;
constexpr std::size_t kMostStops = 100;
constexpr std::size_t kMostEnded = 50;
constexpr double kLongestWait_s = 24.0 * 3600.0;
constexpr std::array kActions{StopAction::Pass, StopAction::Wait, StopAction::Load, StopAction::Unload};

std::optional<OrderStop> stop_from(const hmi::StopView& view) {
  for (const StopAction action : kActions)
    if (view.action == to_string(action) && view.wait_s >= 0.0 && view.wait_s <= kLongestWait_s)
      return OrderStop{view.node, action, view.wait_s};
  return std::nullopt;
}

hmi::Reply unknown_station(int node) {
  const std::string number = std::to_string(node);
  return {false, {"unknown-station", {{"station", number}}, "station " + number + " is not in the routes"}};
}

/// Nothing where they cannot be read; none where the site has none.
std::optional<std::vector<int>> saved_nodes(const std::filesystem::path& site) {
  namespace fs = std::filesystem;
  try {
    mapping::recover_site(site);
    if (!fs::exists(site / "site.yaml")) return std::nullopt;
    if (!fs::exists(site / "routes/tree.csv")) return std::vector<int>();
    return node_ids(planning::load_routes(site / "routes"));
  } catch (const std::exception&) {  // told by who loads the site to drive
    return std::nullopt;
  }
}

}  // namespace

PanelOrders::PanelOrders(const std::filesystem::path& database, NodeName node_name)
    : node_name_(std::move(node_name)), store_(database) {}

hmi::OrderView PanelOrders::view(const Order& order) const {
  hmi::OrderView view;
  view.id = order.id;
  for (const auto& stop : order.stops)
    view.stops.push_back({stop.node, to_string(stop.action), stop.wait_s, stop.gone});
  view.status = to_string(order.state);
  view.repeat = order.repeat;
  view.round = order.round;
  view.next_stop = static_cast<int>(order.next_stop);
  view.created = store_.created(order.id);
  if (!order.note.empty()) view.detail = uncoded(order.note);
  return view;
}

std::vector<hmi::OrderView> PanelOrders::open() const {
  const std::scoped_lock lock(mutex_);
  std::vector<hmi::OrderView> list;
  for (const auto& order : store_.list(true)) list.push_back(view(order));
  return list;
}

std::vector<hmi::OrderView> PanelOrders::ended() const {
  const std::scoped_lock lock(mutex_);
  std::vector<hmi::OrderView> list;
  for (const auto& order : store_.ended(kMostEnded)) list.push_back(view(order));
  return list;
}

std::optional<hmi::Reply> PanelOrders::wrong_count(const std::vector<hmi::StopView>& stops) {
  if (stops.empty()) return hmi::Reply::refused("empty-order", "choose at least one station");
  if (stops.size() > kMostStops)
    return hmi::Reply::refused("long-order", "an order has at most 100 stops: divide it");
  return std::nullopt;
}

hmi::Reply PanelOrders::add(const std::vector<hmi::StopView>& stops, int repeat) {
  if (auto refused = wrong_count(stops)) return *std::move(refused);
  if (repeat < 1 || repeat > kMostRepeats) return hmi::Reply::refused("bad-repeat", "repeat 1 to 1000 times");
  std::vector<OrderStop> wanted;
  for (const auto& view : stops) {
    if (view.gone || !node_name_(view.node)) return unknown_station(view.node);
    const auto stop = stop_from(view);
    if (!stop) return hmi::Reply::refused("bad-action", "what to do at a stop is pass, wait, load or unload");
    wanted.push_back(*stop);
  }
  const std::scoped_lock lock(mutex_);
  if (store_.open_count() >= OrderStore::kMostOpen)
    return hmi::Reply::refused("queue-full", "1000 orders wait already: let them be done, or cancel some");
  store_.add(wanted, repeat, time_of_day());
  return hmi::Reply::done();
}

std::optional<hmi::OrderView> PanelOrders::find(long long id) const {
  const std::scoped_lock lock(mutex_);
  const auto order = store_.find(id);
  return order ? std::optional(view(*order)) : std::nullopt;
}

void PanelOrders::keep_stations(const std::filesystem::path& site) {
  const auto nodes = saved_nodes(site);
  const std::scoped_lock lock(mutex_);
  if (nodes) store_.keep_stations(*nodes, time_of_day());
}

hmi::Reply PanelOrders::unknown_order() {
  return hmi::Reply::refused("no-order", "there is no such open order");
}

hmi::Reply PanelOrders::cancel(long long id) {
  const std::scoped_lock lock(mutex_);
  const auto order = store_.find(id);
  if (!order || (order->state != OrderState::Queued && order->state != OrderState::Running))
    return unknown_order();
  store_.close(id, OrderState::Cancelled, "cancelled at the panel", time_of_day());
  return hmi::Reply::done();
}

hmi::Reply PanelOrders::arrange(const std::vector<long long>& ids) {
  const std::scoped_lock lock(mutex_);
  if (store_.arrange({ids.begin(), ids.end()})) return hmi::Reply::done();
  return hmi::Reply::refused("conflict", "the queue has changed meanwhile");
}

void PanelOrders::tell(const std::string& text) {
  const std::scoped_lock lock(mutex_);
  store_.add_event({time_of_day(), "operator", text});
}

std::vector<hmi::EventView> PanelOrders::events(std::size_t newest) const {
  const std::scoped_lock lock(mutex_);
  std::vector<hmi::EventView> list;
  for (const auto& event : store_.events(newest)) list.push_back(event_view(event));
  return list;
}

long long PanelOrders::stops_done() const {
  const std::scoped_lock lock(mutex_);
  return store_.stops_done();
}

}  // namespace madori::app
