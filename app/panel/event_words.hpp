#pragma once

#include "app/orders/order_store.hpp"
#include "hmi/server/vehicle.hpp"

namespace madori::app {

/// An event of the log as the panel shows it: the sentences of the cycle and of orders get their codes,
/// causes of a standstill their remedy and severity. A sentence that is not known stays as it is.
[[nodiscard]] hmi::EventView event_view(const EventRecord& event);

}  // namespace madori::app
