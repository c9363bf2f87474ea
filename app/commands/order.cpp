#include <CLI/CLI.hpp>
#include <array>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/commands.hpp"
#include "app/commands/within.hpp"
#include "app/json_output.hpp"
#include "app/orders/order_store.hpp"
#include "app/route_tools.hpp"
#include "core/clock.hpp"
#include "core/result.hpp"
#include "planning/route_graph/route_csv.hpp"

namespace madori::app {
namespace {

namespace fs = std::filesystem;

struct OrderArguments {
  std::string site;
  std::vector<std::string> to;
  int repeat = 1;
  std::int64_t cancel = 0;
  bool list = false;
  std::string json_file;
};

struct NamedStopAction {
  const char* name;
  StopAction action;
  double wait_s;  ///< where none is given
};
constexpr std::array<NamedStopAction, 3> kStopActions{{{"wait", StopAction::Wait, 10.0},
                                                       {"load", StopAction::Load, 30.0},
                                                       {"unload", StopAction::Unload, 30.0}}};

/// "4", "Press 1", "4:load", "4:wait=20"
OrderStop stop_from(const planning::RouteGraph& routes, const std::string& text) {
  const std::size_t colon = text.find(':');
  const auto node = routes.find(text.substr(0, colon));
  if (!node)
    throw Error("--to " + text, "no node of that ID or name is in the routes",
                "DIR/routes/path.csv lists them");
  OrderStop stop{routes.nodes()[*node].id, StopAction::Pass, 0.0};
  if (colon == std::string::npos) return stop;
  const std::string action = text.substr(colon + 1);
  const std::size_t equals = action.find('=');
  for (const auto& [name, value, wait_s] : kStopActions) {
    if (action.substr(0, equals) != name) continue;
    stop.action = value;
    stop.wait_s = wait_s;
    if (equals == std::string::npos) return stop;
    const char* const begin = action.c_str() + equals + 1;
    char* end = nullptr;
    stop.wait_s = std::strtod(begin, &end);
    if (end != begin && *end == '\0' && stop.wait_s >= 0.0 && stop.wait_s <= 86'400.0) return stop;
  }
  throw Error("--to " + text, "is no stop", "write NODE, NODE:load, NODE:unload or NODE:wait=SECONDS");
}

nlohmann::json order_json(const Order& order) {
  nlohmann::json stops = nlohmann::json::array();
  for (const OrderStop& stop : order.stops)
    stops.push_back({{"node", stop.node},
                     {"action", to_string(stop.action)},
                     {"wait_s", stop.wait_s},
                     {"gone", stop.gone}});
  return {{"id", order.id},       {"state", to_string(order.state)},
          {"stops", stops},       {"repeat", order.repeat},
          {"round", order.round}, {"next_stop", order.next_stop},
          {"note", order.note}};
}

void print_order(const Order& order) {
  std::printf("%4lld  %-9s  to", static_cast<long long>(order.id), to_string(order.state));
  for (const OrderStop& stop : order.stops)
    std::printf(" %d%s%s%s", stop.node, stop.action == StopAction::Pass ? "" : ":",
                stop.action == StopAction::Pass ? "" : to_string(stop.action), stop.gone ? " (deleted)" : "");
  if (order.repeat > 1)
    std::printf("  round %d of %d", std::min(order.round + 1, order.repeat), order.repeat);
  std::printf("%s%s\n", order.note.empty() ? "" : "  ", order.note.c_str());
}

/// One that has ended otherwise was not cancelled, and that is said.
void cancel(OrderStore& store, const OrderArguments& arguments, Stamp now) {
  store.close(arguments.cancel, OrderState::Cancelled, "cancelled by the operator", now);
  const auto order = store.find(arguments.cancel);
  const std::string number = std::to_string(arguments.cancel);
  if (!order) throw Error(arguments.site, "holds no order " + number, "madori order DIR --list");
  if (order->state != OrderState::Cancelled)
    throw Error("order " + number, std::string("has ended already: ") + to_string(order->state),
                "madori order DIR --list");
}

void run(const OrderArguments& arguments) {
  expect_json(arguments.json_file);
  const fs::path folder(arguments.site);
  if (!fs::exists(folder / "site.yaml"))
    throw Error(arguments.site, "is no site folder (no site.yaml)",
                "make one: madori import DRAWING --site DIR");
  const auto routes = planning::load_routes(folder / "routes");
  OrderStore store(folder / "madori.db");
  const Stamp now = time_of_day();
  store.keep_stations(node_ids(routes), now);
  if (arguments.cancel > 0) cancel(store, arguments, now);
  nlohmann::json result;
  if (!arguments.to.empty()) {
    std::vector<OrderStop> stops;
    for (const std::string& text : arguments.to) stops.push_back(stop_from(routes, text));
    const auto id = store.add(stops, arguments.repeat, now);
    result["added"] = id;
    if (arguments.json_file != "-") std::printf("order %lld is queued\n", static_cast<long long>(id));
  }
  result["orders"] = nlohmann::json::array();
  for (const Order& order : store.list(!arguments.list)) {
    if (arguments.json_file != "-") print_order(order);
    result["orders"].push_back(order_json(order));
  }
  try {
    write_json(arguments.json_file, result);
  } catch (const Error& e) {  // whoever asks again would have it done twice
    if (!result.contains("added")) throw;
    throw Error("order " + result["added"].dump() + " is queued, but " + e.what());
  }
}

}  // namespace

void add_order(CLI::App& app) {
  auto arguments = std::make_shared<OrderArguments>();
  CLI::App* command = app.add_subcommand("order", "queue a transport run, cancel one, list them");
  command->add_option("DIR", arguments->site, "site folder")->required();
  command
      ->add_option("--to", arguments->to,
                   "stops: ID or name, each with :load, :unload or :wait=SECONDS if asked")
      ->delimiter(',');
  command->add_option("--repeat", arguments->repeat, "how often the whole run is done")
      ->check(within(1, 1'000'000))
      ->capture_default_str();
  command->add_option("--cancel", arguments->cancel, "ID of an order to cancel")
      ->check(within<std::int64_t>(1, std::numeric_limits<std::int64_t>::max()));
  command->add_flag("--list", arguments->list, "finished orders too");
  command->add_option("--json", arguments->json_file, "the orders as JSON, - for stdout");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace madori::app
