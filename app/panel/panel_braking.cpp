// The braking test as the panel sees it.
#include "app/panel/notices.hpp"
#include "app/panel/panel_vehicle.hpp"

namespace madori::app {

hmi::Reply PanelVehicle::start_braking_test(bool loaded) {
  const std::scoped_lock lock(begins_);
  const auto site = run_.braking_site();
  const auto view = run_.view();
  if (!site || !view) return not_drivable();
  if (is_to_be_confirmed(view->mode))
    return hmi::Reply::refused("confirm-first", "look around the vehicle and confirm first");
  if (auto moving = moves()) return *std::move(moving);
  if (!braking_.start({site->top_speed_mps, BrakingDesk::kStops}, loaded))
    return hmi::Reply::refused("driving", "the vehicle is driving: pause it first");
  return hmi::Reply::done();
}

hmi::BrakingView PanelVehicle::braking() const {
  const BrakingDesk::View now = braking_.view();
  hmi::BrakingView view;
  view.running = now.running;
  view.stops_now = static_cast<int>(now.stops_now);
  view.stops_wanted = BrakingDesk::kStops;
  view.trouble = shown(now.trouble);
  for (const auto& [loaded, stop] : now.stops)
    view.stops.push_back({loaded, stop.speed_mps, stop.deceleration_mps2, stop.latency_s, stop.way_m});
  const auto site = run_.braking_site();
  if (!site) return view;
  view.way_m = site->way_m;
  if (const auto v = verdict_of(now.stops, *site))
    view.verdict = {v->deceleration_mps2, v->reaction_s, v->needs_m, v->sees_m, v->allowed_mps};
  return view;
}

}  // namespace madori::app
