#include "app/panel/panel_orders.hpp"

#include <array>
#include <chrono>
#include <utility>

#include "app/panel/event_words.hpp"
#include "app/panel/notices.hpp"
#include "core/clock.hpp"

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

hmi::Reply unknown_order() {
  return hmi::Reply::refused("no-order", "there is no such open order");
}

}  // namespace

PanelOrders::PanelOrders(const std::filesystem::path& database, NodeName node_name)
    : node_name_(std::move(node_name)), store_(database) {}

hmi::OrderView PanelOrders::view(const Order& order) const {
  hmi::OrderView view;
  view.id = order.id;
  for (const auto& stop : order.stops) view.stops.push_back({stop.node, to_string(stop.action), stop.wait_s});
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

hmi::Reply PanelOrders::add(const std::vector<hmi::StopView>& stops, int repeat) {
  if (stops.empty() || stops.size() > kMostStops)
    return hmi::Reply::refused("empty-order", "choose at least one station");
  if (repeat < 1 || repeat > kMostRepeats) return hmi::Reply::refused("bad-repeat", "repeat 1 to 1000 times");
  std::vector<OrderStop> wanted;
  for (const auto& view : stops) {
    if (!node_name_(view.node))
      return {false,
              {"unknown-station",
               {{"station", std::to_string(view.node)}},
               "station " + std::to_string(view.node) + " is not in the routes"}};
    const auto stop = stop_from(view);
    if (!stop) return hmi::Reply::refused("bad-action", "what to do at a stop is pass, wait, load or unload");
    wanted.push_back(*stop);
  }
  const std::scoped_lock lock(mutex_);
  store_.add(wanted, repeat, time_of_day());
  return hmi::Reply::done();
}

hmi::Reply PanelOrders::repeat(long long id) {
  std::vector<hmi::StopView> stops;
  int repeat = 1;
  {
    const std::scoped_lock lock(mutex_);
    const auto order = store_.find(id);
    if (!order) return unknown_order();
    stops = view(*order).stops;
    repeat = order->repeat;
  }
  return add(stops, repeat);
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
