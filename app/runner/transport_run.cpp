#include "app/runner/transport_run.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "app/route_tools.hpp"
#include "core/clock.hpp"

namespace madori::app {
namespace {

std::optional<std::vector<int>> stations_of(const CycleConfig& config) {
  return config.mapping ? std::nullopt : std::optional(node_ids(config.routes));
}

}  // namespace

TransportRun::TransportRun(CycleConfig config, std::unique_ptr<PoseSource> source,
                           std::unique_ptr<VehicleLink> link, const TransportOptions& options)
    : config_(std::move(config)),
      options_(options),
      link_(std::move(link)),
      orders_(options.site / "madori.db", {options.lock_step, options.store_poll_s}, stations_of(config_)),
      state_(config_, std::move(source)) {
  if (!options_.lock_step)
    planner_ = std::make_unique<planning::DetourPlanner>(config_.check, detour_options_);
}

void TransportRun::say(const OperatorCommand& command) {
  const std::scoped_lock lock(mutex_);
  said_.push_back(command);
}

void TransportRun::tell(const std::string& text) {
  orders_.add({time_of_day(), "device", text});
}

VehicleView TransportRun::view() const {
  const std::scoped_lock lock(mutex_);
  return view_;
}

void TransportRun::ask_detour(const planning::DetourRequest& request) {
  if (planner_)
    planner_->submit(request);
  else
    answer_ = planning::plan_detour(request, config_.check, detour_options_);
}

void TransportRun::carry_out(const CycleOutput& output, Stamp moment) {
  const Stamp now = time_of_day(moment);
  if (output.detour_wanted) ask_detour(*output.detour_wanted);
  if (output.stop_done) orders_.stop_reached(*output.stop_done, now);
  if (output.order_refused) orders_.refuse(output.order_refused->first, output.order_refused->second, now);
  for (const std::string& text : output.events) {
    spdlog::info("{}", text);
    orders_.add({now, "mode", text});
  }
}

/// What a device says of itself, for whoever looks later: a standstill names its cause, but not that a
/// scanner reports an error. Once, until it has been gone for a minute; not more than so many in one.
void TransportRun::tell_trouble(const std::string& text, Stamp now) {
  constexpr std::size_t kMost = 8;
  std::erase_if(troubles_,
                [&](const auto& trouble) { return now - trouble.second > std::chrono::minutes(1); });
  if (text.empty()) return;
  if (const auto known = troubles_.find(text); known != troubles_.end()) return void(known->second = now);
  if (troubles_.size() >= kMost) return;
  troubles_[text] = now;
  tell(text);
  spdlog::warn("{}", text);
}

void TransportRun::tick(Stamp now) {
  CycleInput input;
  input.now = now;
  link_->collect(input);
  input.thinking = !options_.lock_step && state_.localization->is_thinking();
  input.order = orders_.order(now, state_.mode == Mode::Idle || state_.mode == Mode::Localizing);
  input.detour = planner_ ? planner_->take() : std::exchange(answer_, std::nullopt);
  {
    const std::scoped_lock lock(mutex_);
    input.commands = std::exchange(said_, {});
  }
  StepResult result = step(std::move(state_), input, config_);
  state_ = std::move(result.state);
  link_->send(result.output);
  carry_out(result.output, now);
  if (std::ranges::any_of(input.commands, [](const auto& c) { return c.word == OperatorWord::Stop; }))
    orders_.cancel_running("stopped at the panel", time_of_day(now));
  if (tap_) tap_(input, result.output, state_);
  const std::string problem = orders_.problem(), trouble = link_->problem();
  tell_trouble(trouble, now);
  const std::scoped_lock lock(mutex_);
  view_ = {now,
           state_.mode,
           state_.standstill,
           state_.pose,
           input.order,
           result.output.command,
           state_.progress.cross_track_m,
           state_.drive.battery_mv / 1000.0,
           problem.empty() ? trouble : "orders: " + problem,
           state_.drive};
}

}  // namespace madori::app
