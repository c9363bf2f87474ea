#include "app/runner/site_run.hpp"

#include <spdlog/spdlog.h>

#include <chrono>
#include <set>
#include <utility>

#include "app/cycle/notice.hpp"
#include "app/cycle/stages.hpp"
#include "app/learned/kept_memory.hpp"
#include "app/learned/learned_drawing.hpp"
#include "app/learned/living_map_file.hpp"
#include "app/lidars.hpp"
#include "app/mapping_drive/mapping_pose.hpp"
#include "app/pose/localizer_pose.hpp"
#include "app/route_tools.hpp"
#include "core/clock.hpp"
#include "core/failure_words.hpp"
#include "core/result.hpp"
#include "mapping/days/map_frame.hpp"
#include "mapping/wall_map/wall_fingerprint.hpp"

namespace madori::app {
namespace {

/// Lends a link to one run after the other. The revolution that is under way when a run begins is not handed
/// on: its first packets are not in the run's recording, which could not be replayed.
class LentLink final : public VehicleLink {
 public:
  explicit LentLink(VehicleLink& link) : link_(link) {}
  void collect(CycleInput& input) override {
    link_.collect(input);
    std::erase_if(input.clouds, [this](const auto& cloud) { return begun_.insert(cloud.lidar).second; });
  }
  void send(const CycleOutput& output) override { link_.send(output); }
  [[nodiscard]] std::string problem() const override { return link_.problem(); }

 private:
  VehicleLink& link_;
  std::set<std::size_t> begun_;  ///< lidars of which a first revolution has come
};

constexpr Duration kTryAgain = std::chrono::seconds(3);
constexpr Duration kLookAtKeeping = std::chrono::seconds(5);

bool stands_still(const VehicleView& view) {
  if (drives(view.mode) || view.mode == Mode::Waiting) return false;
  return view.mode != Mode::Manual || view.command == VelocityCommand{};
}

}  // namespace

SiteRun::SiteRun(std::filesystem::path site, std::unique_ptr<VehicleLink> link, Hooks hooks)
    : site_(std::move(site)), link_(std::move(link)), hooks_(std::move(hooks)) {}

SiteRun::~SiteRun() {
  if (run_ && hooks_.closing) hooks_.closing();
}

SiteRun::Loaded SiteRun::load(const std::filesystem::path& site) {
  Loaded loaded;
  try {
    loaded.sensors = listed_sensors(site);
    loaded.site = load_for_driving(site);
    SiteKeeper::Learned learned(site);
    const auto& lidars = loaded.site->config.lidars;
    loaded.watch =
        std::make_shared<WallWatch>(loaded.site->walls, ScanMaker::eye(lidars), site / kReliabilityFile);
    LocalizerPoseOptions options;
    options.onlooker = [watch = loaded.watch](const auto& points, const auto& pose) {
      (void)watch->see(points, pose);
    };
    LivingMap begun = begin_living_map(site, loaded.site->walls);
    if (!begun.message.empty()) spdlog::warn("{}", begun.message);
    const auto map_watch = std::make_shared<MapWatch>(std::move(begun.map));
    options.sweep_onlooker = [map_watch](const auto& sweep, const auto& lidar, const auto& pose) {
      (void)map_watch->see(sweep, lidar, pose);
    };
    KeptMemory kept = load_memory(site, loaded.site->walls);
    if (!kept.message.empty()) spdlog::warn("{}", kept.message);
    loaded.memory = std::move(kept.bytes);
    options.memory = std::move(kept.memory);
    loaded.pose = std::make_unique<LocalizerPose>(loaded.site->walls, lidars, options);
    loaded.last = load_stored_pose(site, mapping::walls_fingerprint(loaded.site->walls));
    if (!loaded.last.message.empty()) spdlog::info("{}", loaded.last.message);
    loaded.keeper = std::make_unique<SiteKeeper>(std::move(learned), loaded.site->walls, loaded.watch,
                                                 map_watch, mapping::map_frame(site, loaded.site->site));
  } catch (const std::exception& e) {
    loaded.missing = failure_words(e);
  }
  return loaded;
}

SiteRun::Loaded SiteRun::load_mapping(const std::filesystem::path& site) {
  Loaded loaded;
  try {
    loaded.site.emplace();
    loaded.site->site = load_mapping_setup(site);
    loaded.site->config = config_for_mapping(loaded.site->site, site / "mapping");
    loaded.mapping = std::make_shared<MappingDesk>(MappingDesk::Options{drive_file(site)});
    loaded.pose = std::make_unique<MappingPose>(loaded.mapping, loaded.site->config.lidars);
  } catch (const std::exception& e) {
    loaded.missing = failure_words(e);
  }
  return loaded;
}

void SiteRun::take(Loaded loaded) {
  if (run_ && hooks_.closing) hooks_.closing();
  end_beside(std::exchange(keeper_, nullptr));
  keeper_ = std::move(loaded.keeper);
  recall_ = PoseRecall(std::move(loaded.last.pose));
  memory_ = std::move(loaded.memory);
  std::unique_ptr<TransportRun> next;
  if (loaded.missing.empty()) loaded.sensors = loaded.site->site.sensors;
  next_sensors_ = loaded.sensors;
  if (!loaded.missing.empty() && hooks_.looked) hooks_.looked(loaded.sensors);
  if (loaded.missing.empty()) try {
      next =
          std::make_unique<TransportRun>(std::move(loaded.site->config), std::move(loaded.pose),
                                         std::make_unique<LentLink>(*link_), TransportOptions{.site = site_});
      if (hooks_.opened) hooks_.opened(*next);
    } catch (const std::exception& e) {  // its database, the recording, few file handles: tried again
      next.reset();
      loaded.missing = failure_words(e);
      again_at_ = clock_now() + kTryAgain;
    }
  if (!loaded.missing.empty()) spdlog::info("not ready to drive: {}", loaded.missing);
  std::shared_ptr<MappingDesk> before;
  {
    const std::scoped_lock lock(mutex_);
    before = std::move(mapping_);
    missing_ = loaded.missing;
    watch_ = std::move(loaded.watch);
    mapping_ = next ? std::move(loaded.mapping) : nullptr;
    sensors_ = std::move(loaded.sensors);
    std::swap(run_, next);
    loads_ = false;
  }
  next.reset();
  end_beside(std::move(before));
  end_beside(std::move(loaded.mapping));  // no run was made of it
}

/// What may have much to write or to finish ends on a thread of its own.
void SiteRun::end_beside(std::shared_ptr<void> what) {
  if (!what) return;
  std::erase_if(ending_, [](const auto& end) {
    return end.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  });
  ending_.push_back(std::async(std::launch::async, [what = std::move(what)]() mutable { what.reset(); }));
}

void SiteRun::load_now() {
  Loaded loaded = load(site_);
  if (!loaded.missing.empty()) throw std::runtime_error(loaded.missing);
  {
    const std::scoped_lock lock(mutex_);
    wanted_ = false;
  }
  take(std::move(loaded));
  if (!run_) throw std::runtime_error(missing());
}

void SiteRun::look_for_site() {
  using std::chrono::seconds;
  if (is_measured()) return;  // by the site as it was when that began
  if (loading_.valid()) {
    if (loading_.wait_for(seconds(0)) != std::future_status::ready || !may_change_site()) return;
    take(loading_.get());
  }
  const std::scoped_lock lock(mutex_);
  if (again_at_ && clock_now() > *again_at_) wanted_ = true;
  if (!std::exchange(wanted_, false)) return;
  again_at_.reset();
  loads_ = true;
  if (keeper_) keeper_->finish_learning();
  loading_ = std::async(std::launch::async, [site = site_, before = keeper_, mapping = mapping_wanted_] {
    if (before) before->flush();  // what it learned is read again
    return mapping ? load_mapping(site) : load(site);
  });
}

/// Once, when the drive has told where its wheels stand.
void SiteRun::recall_pose() {
  if (!run_->state().drive_heard || !recall_.verdict().empty()) return;
  if (const auto word = recall_.on_status(run_->state().drive)) run_->say(*word);
  if (!recall_.verdict().empty()) spdlog::info("{}", recall_.verdict());
}

void SiteRun::measure_mounting() {
  const auto site = mapping::load_site(site_);
  (void)lidars_of(site, site_);  // throws where there are none, or they cannot be
  auto mounting = std::make_shared<MountingRun>(site.vehicle, site.sensors);
  const std::scoped_lock lock(mutex_);  // ends before `mounting` does, which may be the one before
  if (run_) run_->say({OperatorWord::Pause, {}, {}});
  std::swap(mounting_, mounting);
}

void SiteRun::stop_measuring() {
  const std::scoped_lock lock(mutex_);
  if (mounting_) mounting_->stop();
}

MountingView SiteRun::mounting() const {
  std::shared_ptr<const MountingRun> mounting;
  {
    const std::scoped_lock lock(mutex_);
    mounting = mounting_;
  }
  return mounting ? mounting->view() : MountingView();
}

/// Whether the measurement has the vehicle. After it, the run that stood meanwhile begins anew: where its
/// vehicle is, it does not know any more.
bool SiteRun::tick_mounting(Stamp now) {
  std::shared_ptr<MountingRun> mounting;
  {
    const std::scoped_lock lock(mutex_);
    mounting = mounting_;
  }
  if (!mounting) return false;
  if (!mounting->drives()) {
    (void)mounting->tick({});
    return false;
  }
  CycleInput input;
  input.now = now;
  link_->collect(input);
  if (hooks_.idle) hooks_.idle(input);
  link_->send(mounting->tick(input));
  if (!mounting->drives()) reload();
  return true;
}

void SiteRun::tick(Stamp now) {
  look_for_site();
  if (tick_mounting(now)) return;
  if (run_) {
    run_->tick(now);
    recall_pose();
    if (keeper_) keeper_->observe(run_->state(), now);
    tell_what_is_not_kept(now);
    return;
  }
  CycleInput input;
  input.now = now;
  link_->collect(input);
  link_->send({});  // the drive stays disabled
  if (hooks_.idle) hooks_.idle(input);
}

void SiteRun::tell_what_is_not_kept(Stamp now) {
  if (!keeper_ || now - looked_at_keeping_ < kLookAtKeeping) return;
  looked_at_keeping_ = now;
  const std::string problem = keeper_->problem();
  if (problem == not_kept_) return;
  not_kept_ = problem;
  tell(problem.empty() ? notice(kKeptAgainEvent).text : notice(kNotKeptEvent, {{"why", problem}}).text);
}

void SiteRun::tell(const std::string& text) {
  spdlog::warn("{}", text);
  if (run_) run_->tell(text);
}

void SiteRun::reload() {
  const std::scoped_lock lock(mutex_);
  wanted_ = true;
}

void SiteRun::map_by_driving(const MappingSetup& setup, bool anew) {
  if (std::filesystem::exists(site_ / "site.yaml"))
    throw Error(site_.string(), "is a site already", "map into an empty folder, or import another drawing");
  save_mapping_setup(site_, setup);
  if (anew) std::filesystem::remove(drive_file(site_));
  const std::scoped_lock lock(mutex_);
  mapping_wanted_ = wanted_ = true;
}

void SiteRun::end_mapping() {
  const std::scoped_lock lock(mutex_);
  mapping_wanted_ = false;
  wanted_ = true;
}

std::shared_ptr<MappingDesk> SiteRun::mapping() const {
  const std::scoped_lock lock(mutex_);
  return mapping_;
}

bool SiteRun::is_measured() const {
  const std::scoped_lock lock(mutex_);
  return mounting_ && mounting_->drives();
}

bool SiteRun::say(const OperatorCommand& command) {
  const std::scoped_lock lock(mutex_);
  if (!run_ || (mounting_ && mounting_->drives())) return false;
  run_->say(command);
  return true;
}

std::optional<VehicleView> SiteRun::view() const {
  const std::scoped_lock lock(mutex_);
  return run_ ? std::optional(run_->view()) : std::nullopt;
}

std::optional<std::string> SiteRun::node_name(int id) const {
  const std::scoped_lock lock(mutex_);
  if (!run_) return std::nullopt;
  return app::node_name(run_->config().routes, id);
}

std::optional<int> SiteRun::without_way(std::optional<int> after, const std::vector<int>& stops,
                                        bool repeats) const {
  planning::RouteGraph routes;  // searched beside the ticks, which never wait for it
  PoseEstimate pose;
  {
    const std::scoped_lock lock(mutex_);
    if (!run_) return std::nullopt;
    routes = run_->config().routes;
    pose = run_->view().pose;
  }
  std::vector<std::size_t> starts;
  if (const auto before = after ? routes.index_of(*after) : std::nullopt)
    starts = {*before};
  else if (may_drive(pose.health.state))
    starts = nodes_near(routes, pose.map_from_base.translation());
  else if (const auto all = main_routes(routes); !all.empty())
    starts = {all.front()};  // from each of them a way leads where one leads from any
  return stop_without_way(routes, std::move(starts), stops, repeats);
}

bool SiteRun::loads() const {
  const std::scoped_lock lock(mutex_);
  return wanted_ || loads_;
}

bool SiteRun::stands() const {
  const auto now = view();
  return !now || stands_still(*now);
}

bool SiteRun::may_change_site() const {
  const auto now = view();
  return !now || (stands_still(*now) && !is_to_be_confirmed(now->mode));
}

std::vector<SeenWall> SiteRun::walls_seen() const {
  std::shared_ptr<const WallWatch> watch;
  {
    const std::scoped_lock lock(mutex_);
    watch = watch_;
  }
  return watch ? watch->seen() : std::vector<SeenWall>();
}

std::optional<BrakingSite> SiteRun::braking_site() const {
  const std::scoped_lock lock(mutex_);
  return run_ ? std::optional(app::braking_site(run_->config())) : std::nullopt;
}

std::vector<mapping::SensorRecord> SiteRun::sensors() const {
  const std::scoped_lock lock(mutex_);
  return sensors_;
}

std::string SiteRun::missing() const {
  const std::scoped_lock lock(mutex_);
  return missing_;
}

}  // namespace madori::app
