#include "app/orders/order.hpp"

namespace madori::app {

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

}  // namespace madori::app
