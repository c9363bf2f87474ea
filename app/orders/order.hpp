#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace madori::app {

/// What is done at a stop of an order. Load and unload end after `wait_s`, or earlier by the operator's word.
enum class StopAction { Pass, Wait, Load, Unload };

[[nodiscard]] const char* to_string(StopAction action);

struct OrderStop {
  int node = 0;  ///< ID in path.csv
  StopAction action = StopAction::Pass;
  double wait_s = 0.0;
  bool gone = false;  ///< its station was deleted: the number may be another's by now

  friend bool operator==(const OrderStop&, const OrderStop&) = default;
};

enum class OrderState { Queued, Running, Done, Cancelled, Refused };

[[nodiscard]] const char* to_string(OrderState state);

/// A transport run: stops in sequence, all of them `repeat` times.
struct Order {
  std::int64_t id = 0;
  std::vector<OrderStop> stops;
  int repeat = 1;
  OrderState state = OrderState::Queued;
  int round = 0;              ///< repetitions finished
  std::size_t next_stop = 0;  ///< of the current round
  std::string note;           ///< why it was refused or cancelled

  friend bool operator==(const Order&, const Order&) = default;
};

/// A stop of an order, of one of its rounds.
struct Target {
  std::int64_t order = 0;
  int round = 0;
  std::size_t stop = 0;

  friend bool operator==(const Target&, const Target&) = default;
};

}  // namespace madori::app
