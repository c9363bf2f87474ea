#include "app/panel/panel_vehicle.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

#include "app/lidars.hpp"
#include "app/panel/found_devices.hpp"
#include "app/panel/notices.hpp"
#include "app/panel/reference_lidar.hpp"
#include "core/angle.hpp"
#include "core/clock.hpp"
#include "core/failure_words.hpp"

namespace madori::app {
namespace {

hmi::Reply driving() {
  return hmi::Reply::refused("driving", "the vehicle is driving: pause it first");
}

/// Without the values, which differ from time to time.
std::string english_of(const std::string& code) {
  for (const auto& entry : kCauses)
    if (code == entry.code) return entry.english;
  return code;
}

hmi::Reply mapping_now() {
  return hmi::Reply::refused("mapping", "a map is being made by driving: finish it, or give it up, first");
}

bool reads_drive(const SiteRun& run) {
  const auto desk = run.mapping();
  return desk && desk->progress().reading;
}

hmi::Reply measuring() {
  return hmi::Reply::refused("measuring", "the mountings are being measured: wait, or press Stop");
}

hmi::Reply confirm_first() {
  return hmi::Reply::refused("confirm-first", "look around the vehicle and confirm first");
}

hmi::Reply driven_by_hand() {
  return hmi::Reply::refused("driven-by-hand", "driven by hand at another panel");
}

hmi::Reply no_hold(JogHolds::Answer answer) {
  if (answer == JogHolds::Answer::Taken) return driven_by_hand();
  if (answer == JogHolds::Answer::Stopped)
    return hmi::Reply::refused("stopped", "somebody pressed Stop: let the button go first");
  return hmi::Reply::refused("let-go", "let the button go first, then press it again");
}

}  // namespace

PanelVehicle::PanelVehicle(SiteRun& run, const std::filesystem::path& database, SocketOptions devices,
                           const std::string& camera)
    : run_(run),
      site_(database.parent_path()),
      devices_(std::move(devices)),
      orders_(database, [&run](int id) { return run.node_name(id); }),
      meter_(database) {
  if (!camera.empty()) camera_.emplace(camera);
}

hmi::Reply PanelVehicle::not_drivable() const {
  const std::string missing = run_.missing();
  return {false, {"not-drivable", {{"reason", missing}}, "not ready to drive: " + missing}};
}

hmi::LiveState PanelVehicle::live() const {
  hmi::LiveState live = copy_.live();
  live.camera = camera_ && camera_->picture();
  return live;
}

void PanelVehicle::begin_run() {
  meter_.forget_step();
  const std::scoped_lock lock(way_mutex_);
  way_.clear();
  by_hand_ = false;
}

void PanelVehicle::observe(const CycleInput& input, const CycleState& state, const TransportRun& run) {
  note_way_by_hand(state, run.config());
  meter_.count(input, state);
  copy_.show(input, state, run.config(), run.view().device_problem);
  for (const auto& word : braking_.after_step(input, state, run.config())) run_.say(word);
  if (state.lidar_heard == input.now) copy_.set_odometer(meter_.sums().distance_m);
}

void PanelVehicle::idle(const CycleInput& input) {
  const auto listed = run_.sensors();
  const auto sensors = listed.empty() ? std::vector{reference_lidar()} : listed;
  if (sensors != idle_sensors_) {
    idle_lidars_.clear();
    for (const auto& sensor : sensors) idle_lidars_.push_back(lidar_model(sensor));
    idle_sensors_ = sensors;
  }
  if (is_measuring())
    copy_.show_measuring(input, idle_lidars_, run_.device_problem());
  else
    copy_.show_setup(input, idle_lidars_, run_.device_problem());
}

hmi::Reply PanelVehicle::command(hmi::Command command) {
  const auto view = run_.view();
  const bool stop = command == hmi::Command::Stop || command == hmi::Command::Halt;
  if (is_measuring()) {
    if (!stop && command != hmi::Command::Pause) return measuring();
    run_.stop_measuring();
  }
  if (!view) return stop ? hmi::Reply::done() : not_drivable();  // the drive is not enabled then
  const bool starts = command == hmi::Command::Start || command == hmi::Command::Resume;
  if (starts && run_.mapping()) return mapping_now();
  const Mode now = view->mode;
  switch (command) {
    case hmi::Command::Start:
    case hmi::Command::Resume:
      if (is_to_be_confirmed(now)) return confirm_first();
      if (braking_.view().running) return driving();
      if (jogging_.is_held(clock_now())) return driven_by_hand();
      if (now == Mode::Manual) run_.say({OperatorWord::ManualOff, {}, {}});
      run_.say({OperatorWord::Resume, {}, {}});
      break;
    case hmi::Command::Pause:
      run_.say({OperatorWord::Pause, {}, {}});
      break;
    case hmi::Command::Stop:
      jogging_.stop();
      run_.say({OperatorWord::Stop, {}, {}});
      break;
    case hmi::Command::Halt:
      jogging_.stop();
      run_.say({OperatorWord::Halt, {}, {}});
      break;
    case hmi::Command::Confirm:
      run_.say({OperatorWord::Confirm, {}, {}});
      break;
    case hmi::Command::GoOn:
      run_.say({OperatorWord::GoOn, {}, {}});
      break;
  }
  return hmi::Reply::done();
}

std::optional<hmi::Reply> PanelVehicle::no_jog(const std::optional<VehicleView>& view) const {
  if (is_measuring()) return measuring();
  if (!view) return not_drivable();
  if (is_to_be_confirmed(view->mode)) return confirm_first();
  if (braking_.view().running) return driving();
  if (finishing_ || reads_drive(run_))
    return hmi::Reply::refused("mapping-busy",
                               "the drive so far is being looked at: wait until that is done");
  return std::nullopt;
}

hmi::Reply PanelVehicle::jog(const VelocityCommand& velocity, const void* who) {
  const auto view = run_.view();
  if (velocity == VelocityCommand{}) {  // of a panel that does not drive, it stops nobody
    if (jogging_.let_go(who) && view && view->mode == Mode::Manual) run_.say({OperatorWord::Jog, {}, {}});
    return hmi::Reply::done();
  }
  if (auto refused = no_jog(view)) {
    jogging_.refuse(who);
    return *std::move(refused);
  }
  const auto answer = jogging_.hold(who, clock_now());
  if (answer != JogHolds::Answer::Drives) return no_hold(answer);
  if (view->mode != Mode::Manual) run_.say({OperatorWord::ManualOn, {}, {}});
  run_.say({OperatorWord::Jog, velocity, {}});
  return hmi::Reply::done();
}

void PanelVehicle::jog_silent(const void* who) {
  if (jogging_.has(who)) run_.say({OperatorWord::Jog, {}, {}});
}

hmi::Reply PanelVehicle::add_order(const std::vector<hmi::StopView>& stops, int repeat) {
  if (!run_.view()) return not_drivable();
  if (run_.mapping()) return mapping_now();
  if (auto refused = PanelOrders::wrong_count(stops)) return *std::move(refused);
  std::vector<int> nodes;
  for (const auto& stop : stops) nodes.push_back(stop.node);
  std::optional<int> after;
  for (const auto& order : orders_.open())
    if (!order.stops.empty()) after = order.stops.back().node;
  if (const auto station = run_.without_way(after, nodes, repeat > 1)) {
    const std::string name = run_.node_name(*station).value_or(std::to_string(*station));
    return {false, {"no-way-to-station", {{"station", name}}, "no way leads to " + name}};
  }
  return orders_.add(stops, repeat);
}

/// What was just saved counts: it is waited for.
std::optional<hmi::Reply> PanelVehicle::still_loads() const {
  constexpr auto kLook = std::chrono::milliseconds(50);
  for (int looks = 0; looks < 60 && run_.loads(); ++looks) std::this_thread::sleep_for(kLook);
  if (!run_.loads()) return std::nullopt;
  return hmi::Reply::refused("site-loading", "the site is being loaded: try again in a moment");
}

hmi::Reply PanelVehicle::repeat_order(long long id) {
  const auto order = orders_.find(id);
  return order ? add_order(order->stops, order->repeat) : PanelOrders::unknown_order();
}

void PanelVehicle::reload_site() {
  try {
    orders_.keep_stations(site_);      // before another change gives a number again
  } catch (const std::exception& e) {  // the site is saved; the run that begins with it tries the same
    spdlog::warn("{}", e.what());
  }
  run_.reload();
}

hmi::Reply PanelVehicle::search_place() {
  if (auto moving = moves()) return *std::move(moving);
  return run_.say({OperatorWord::SearchPose, {}, {}}) ? hmi::Reply::done() : not_drivable();
}

hmi::Reply PanelVehicle::set_pose(const Transform2<Map, Base>& map_from_base) {
  if (auto moving = moves()) return *std::move(moving);
  // Nobody may be surprised by a vehicle that drives off because its place was said: it waits for Resume.
  run_.say({OperatorWord::Pause, {}, {}});
  const GivenPose given{map_from_base.translation(), map_from_base.yaw_rad(), PoseSigma{}};
  return run_.say({OperatorWord::SetPose, {}, given}) ? hmi::Reply::done() : not_drivable();
}

/// A person who insists is believed to a hand's breadth: what is seen has to speak against that much more.
hmi::Reply PanelVehicle::insist_on_pose(const Transform2<Map, Base>& map_from_base) {
  if (auto moving = moves()) return *std::move(moving);
  constexpr PoseSigma kInsisted{0.1, 0.035};
  run_.say({OperatorWord::Pause, {}, {}});
  const GivenPose given{map_from_base.translation(), map_from_base.yaw_rad(), kInsisted};
  return run_.say({OperatorWord::SetPose, {}, given}) ? hmi::Reply::done() : not_drivable();
}

hmi::Reply PanelVehicle::report(const std::string& text) {
  orders_.tell("operator: " + text);
  return hmi::Reply::done();
}

std::vector<hmi::FoundDevice> PanelVehicle::found_devices() const {
  return app::found_devices(devices_, run_.sensors(), copy_.live().devices);
}

std::vector<hmi::FoundDevice> PanelVehicle::search_devices() const {
  return searched_devices(devices_, run_.sensors());
}

std::vector<hmi::LidarView> PanelVehicle::lidar_views() const {
  std::vector<hmi::LidarView> views;
  for (const LidarState& lidar : run_.lidar_states()) {
    const auto look = copy_.look(views.size());
    const auto& health = lidar.health;
    const bool heard = health.problem.empty() && look.rate_hz > 0.0;
    hmi::Notice state = health.problem.empty() ? heard_or_silent(heard) : uncoded(health.problem);
    views.push_back({lidar.sensor.name, lidar.sensor.type, lidar.place, look.rate_hz,
                     std::min(to_seconds(health.silence), 1e6), static_cast<long long>(health.counters.lost),
                     static_cast<long long>(health.counters.refused), std::move(state), look.points});
  }
  return views;
}

bool PanelVehicle::is_measuring() const {
  return run_.is_measured();
}

hmi::Reply PanelVehicle::measure_mounting() {
  const std::scoped_lock lock(begins_);
  if (auto may = may_begin_anew(); !may.accepted) return may;
  if (run_.mounting().state == MountingView::State::Computing) return measuring();
  if (auto refused = still_loads()) return *std::move(refused);
  try {
    run_.measure_mounting();
  } catch (const std::exception& e) {
    return {false, uncoded(failure_words(e))};
  }
  return hmi::Reply::done();
}

hmi::Reply PanelVehicle::stop_measuring() {
  run_.stop_measuring();
  return hmi::Reply::done();
}

hmi::MountingState PanelVehicle::mounting() const {
  const MountingView view = run_.mounting();
  hmi::MountingState state{to_string(view.state), view.progress, shown(view.notice), {}};
  for (const MountingFinding& f : view.findings)
    state.rows.push_back({f.typed, f.found, known_word(f.measured.known), f.measured.floor.has_value(),
                          std::max(f.measured.sigma[0], f.measured.sigma[1]), to_deg(f.measured.sigma[2]),
                          f.measured.residual_m, f.tilt_deg(), shown(f.lack)});
  return state;
}

std::vector<hmi::EventView> PanelVehicle::events(std::size_t newest) const {
  return orders_.events(newest);
}

hmi::StatisticsView PanelVehicle::statistics() const {
  const Work work = meter_.sums();
  hmi::StatisticsView view{orders_.stops_done(), work.distance_m, work.driving_s,
                           work.standing_s,      meter_.since(),  {}};
  for (const auto& [code, stood] : work.causes)
    if (stood.seconds > 0.0)
      view.causes.push_back({{code, {}, english_of(code)}, stood.count, stood.seconds});
  std::ranges::sort(view.causes, std::greater<>(), &hmi::CauseView::seconds);
  return view;
}

std::vector<hmi::WallView> PanelVehicle::walls_seen() const {
  std::vector<hmi::WallView> views;
  for (const auto& [cell, state, share, offset_m, missed, surely_missing] : run_.walls_seen())
    views.push_back({cell.wall_id, cell.piece, cell.segment, localization::to_string(state), share, offset_m,
                     missed, surely_missing});
  return views;
}

std::shared_ptr<const std::string> PanelVehicle::camera_jpeg() const {
  return camera_ ? camera_->picture() : nullptr;
}

std::optional<hmi::Reply> PanelVehicle::moves() const {
  if (is_measuring()) return measuring();
  if (braking_.view().running || !run_.stands()) return driving();
  return std::nullopt;
}

hmi::Reply PanelVehicle::may_begin_anew() const {
  if (auto moving = moves()) return *std::move(moving);
  return run_.may_change_site() ? hmi::Reply::done() : confirm_first();
}

hmi::Reply PanelVehicle::may_change_site() const {
  return run_.mapping() ? mapping_now() : may_begin_anew();
}

}  // namespace madori::app
