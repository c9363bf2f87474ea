// What the panel asks of a vehicle that makes a map by driving, and of the way that was driven by hand.

#include "app/lidars.hpp"
#include "app/panel/found_devices.hpp"
#include "app/panel/panel_vehicle.hpp"
#include "app/panel/reference_lidar.hpp"
#include "hmi/server/job.hpp"
#include "hmi/server/scan_frame.hpp"

namespace madori::app {
namespace {

constexpr int kManyDropped = 20;
constexpr double kWorthTeachingM = 1.0;

/// Where the reference vehicle would carry it: one that sees over the equipment above, a planar one at the
/// front.
mapping::SensorRecord usual_place(const sensors::LidarRow& row) {
  constexpr double kBehindFrontM = 0.1;
  const mapping::VehicleRecord vehicle;
  if (row.model({}).kind == LidarKind::Spinning) {
    mapping::SensorRecord sensor = reference_lidar();
    sensor.type = row.type;
    return sensor;
  }
  return {"front", row.type, vehicle.length_m - vehicle.base_to_rear_m - kBehindFrontM, 0.0, 0.25, 0.0};
}

hmi::Notice problem_of(const MappingProgress& drive) {
  if (!drive.problem.empty())
    return {"mapping-not-kept",
            {{"reason", drive.problem}},
            "the drive is not kept on the disk: " + drive.problem};
  if (drive.lost)
    return {"mapping-lost",
            {},
            "the map does not go on here: drive back slowly to where it was right; it goes on from there"};
  if (drive.dropped >= kManyDropped)
    return {"mapping-slow",
            {{"scans", std::to_string(drive.dropped)}},
            "the computer had no time for " + std::to_string(drive.dropped) + " scans: drive more slowly"};
  return {};
}

void show_drive(const MappingDesk& desk, bool finishing, hmi::MappingView& view) {
  const MappingProgress drive = desk.progress();
  view.state = finishing ? "finishing" : drive.reading ? "reading" : "mapping";
  view.driven_m = drive.driven_m;
  view.scans = drive.scans;
  view.keyframes = static_cast<long long>(drive.keyframes);
  view.loops = drive.loops;
  view.dropped = drive.dropped;
  view.problem = problem_of(drive);
  const auto picture = desk.picture();
  view.revision = static_cast<long long>(picture->revision);
  for (const auto& wall : picture->walls) view.walls.push_back(wall.segment);
}

}  // namespace

hmi::MappingView PanelVehicle::mapping() const {
  hmi::MappingView view;
  view.sensors = {reference_lidar()};
  const auto desk = run_.mapping();
  if (!desk && has_open_drive(site_)) view.state = "interrupted";
  if (desk) show_drive(*desk, finishing_, view);
  if (view.state == "none") return view;
  try {
    const mapping::Site setup = load_mapping_setup(site_);
    view.vehicle = setup.vehicle;
    view.sensors = setup.sensors;
  } catch (const std::exception&) {  // told by who begins to drive with it
  }
  return view;
}

std::shared_ptr<const std::string> PanelVehicle::mapping_points() const {
  const auto desk = run_.mapping();
  if (!desk) return nullptr;
  std::vector<Point2<Base>> points;  // of a vehicle at the map's origin
  for (const auto& p : desk->picture()->points) points.push_back({p.x_m, p.y_m});
  return std::make_shared<const std::string>(hmi::scan_frame(points, {}));
}

std::vector<hmi::FoundDevice> PanelVehicle::lidar_kinds() const {
  std::vector<hmi::FoundDevice> kinds;
  for (const auto& row : sensors::lidar_rows()) {
    const mapping::SensorRecord usual = usual_place(row);
    kinds.push_back({usual.type, lidar_title(usual.type), row.address, false, heard_or_silent(false), usual});
  }
  return kinds;
}

hmi::Reply PanelVehicle::start_mapping(const mapping::VehicleRecord& vehicle,
                                       const std::vector<mapping::SensorRecord>& sensors, bool anew) {
  const std::scoped_lock lock(begins_);
  if (run_.mapping()) return hmi::Reply::refused("mapping", "a map is being made by driving already");
  if (auto refused = still_loads()) return *std::move(refused);
  run_.map_by_driving({vehicle, sensors}, anew);
  return hmi::Reply::done();
}

hmi::Reply PanelVehicle::drop_mapping() {
  if (finishing_)
    return hmi::Reply::refused("mapping-busy", "a site is being made of the drive: wait for it");
  if (auto may = may_begin_anew(); !may.accepted) return may;
  run_.end_mapping();
  std::error_code missing;
  std::filesystem::remove_all(site_ / "mapping", missing);
  return hmi::Reply::done();
}

hmi::Reply PanelVehicle::may_finish_mapping() const {
  const auto desk = run_.mapping();
  if (!desk) return hmi::Reply::refused("not-mapping", "no map is being made by driving");
  if (finishing_ || desk->progress().reading)
    return hmi::Reply::refused("mapping-busy",
                               "the drive so far is being looked at: wait until that is done");
  return may_begin_anew();
}

std::size_t PanelVehicle::finish_mapping(
    const std::function<void(const std::string& stage, double share)>& progress) {
  struct Busy {
    explicit Busy(std::atomic<bool>& flag) : flag_(flag) { flag_ = true; }
    ~Busy() { flag_ = false; }
    std::atomic<bool>& flag_;
  } const busy(finishing_);
  const auto desk = run_.mapping();
  if (!desk) throw hmi::Job::Failed("not-mapping", "no map is being made by driving");
  std::optional<StandsAt> stands;
  if (const auto view = run_.view()) stands = {view->pose.map_from_base, counters_of(view->drive)};
  try {
    const std::size_t walls = make_site_of_drive(*desk, site_, stands, progress);
    run_.end_mapping();
    return walls;
  } catch (const NoMap& e) {
    throw hmi::Job::Failed(e.code, e.what());
  }
}

void PanelVehicle::note_way_by_hand(const CycleState& state, const CycleConfig& config) {
  if (config.mapping) return;
  const bool by_hand = state.mode == Mode::Manual;
  const std::scoped_lock lock(way_mutex_);
  if (by_hand && !by_hand_) way_.clear();
  by_hand_ = by_hand;
  constexpr std::size_t kMost = 20'000;  // a kilometre
  if (!by_hand || way_.size() >= kMost) return;
  if (state.pose.health.state == LocalizationState::Localized)
    planning::note_way(way_, state.pose.stamp, state.site->on_drawing(state.pose.map_from_base));
}

std::vector<planning::DrivenPose> PanelVehicle::driven_way() const {
  {
    const std::scoped_lock lock(way_mutex_);
    if (planning::length_m(way_) >= kWorthTeachingM) return way_;
  }
  return load_driven_way(site_);
}

}  // namespace madori::app
