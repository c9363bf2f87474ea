#include "app/runner/transport_run.hpp"

#include <spdlog/spdlog.h>

#include <utility>

#include "core/clock.hpp"

namespace madori::app {
namespace {

constexpr std::uint64_t kDetourChecks = 60'000;  ///< about 0.1 s

}  // namespace

TransportRun::TransportRun(CycleConfig config, std::unique_ptr<PoseSource> source,
                           std::unique_ptr<VehicleLink> link, const TransportOptions& options)
    : config_(std::move(config)),
      options_(options),
      link_(std::move(link)),
      store_(options.site / "madori.db"),
      events_(options.site / "madori.db"),
      state_(config_, std::move(source)) {
  if (options_.lock_step)
    detour_options_.free_space.max_checks = kDetourChecks;
  else
    planner_ = std::make_unique<planning::DetourPlanner>(config_.check, detour_options_);
}

void TransportRun::say(const OperatorCommand& command) {
  const std::scoped_lock lock(mutex_);
  said_.push_back(command);
}

void TransportRun::tell(const std::string& text) {
  events_.add({time_of_day(), "device", text});
}

VehicleView TransportRun::view() const {
  const std::scoped_lock lock(mutex_);
  return view_;
}

/// Orders come from other programs too: what stands in the database counts.
void TransportRun::look_for_orders(Stamp now) {
  if (to_seconds(now - looked_) < options_.store_poll_s) return;
  looked_ = now;
  if (reached_) note_stop(now);
  if (order_) order_ = store_.find(order_->id);
  if (!order_ || order_->state != OrderState::Running) {
    const bool may_begin = state_.mode == Mode::Idle || state_.mode == Mode::Localizing;
    order_ = may_begin ? store_.begin_next(time_of_day(now)) : std::nullopt;
  }
}

/// A database that is locked, damaged or gone is told and tried again: the vehicle goes on with the order
/// that it has, and begins no other.
void TransportRun::work_on_store(const std::function<void()>& work) {
  try {
    work();
    if (!store_problem_.empty()) spdlog::info("orders can be read and written again");
    store_problem_.clear();
  } catch (const std::exception& e) {
    if (store_problem_ != e.what()) spdlog::error("{}", e.what());
    store_problem_ = e.what();
  }
}

void TransportRun::note_stop(Stamp now) {
  const Stamp label = time_of_day(now);
  order_ = store_.stop_done(reached_->order, reached_->round, reached_->stop, label);
  reached_.reset();
  events_.add({label, "order",
               "order " + std::to_string(order_->id) + ": stop reached; " + to_string(order_->state)});
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
  if (output.stop_done) {
    reached_ = output.stop_done;
    work_on_store([&] { note_stop(moment); });
  }
  if (output.order_refused) {
    const auto& [id, why] = *output.order_refused;
    work_on_store([&] { store_.close(id, OrderState::Refused, why, now); });
    events_.add({now, "order", "order " + std::to_string(id) + " refused: " + why});
    order_.reset();
  }
  for (const std::string& text : output.events) {
    spdlog::info("{}", text);
    events_.add({now, "mode", text});
  }
}

void TransportRun::tick(Stamp now) {
  CycleInput input;
  input.now = now;
  link_->collect(input);
  input.thinking = !options_.lock_step && state_.localization->is_thinking();
  work_on_store([&] { look_for_orders(now); });
  input.order = order_;
  input.detour = planner_ ? planner_->take() : std::exchange(answer_, std::nullopt);
  {
    const std::scoped_lock lock(mutex_);
    input.commands = std::exchange(said_, {});
  }
  StepResult result = step(std::move(state_), input, config_);
  state_ = std::move(result.state);
  link_->send(result.output);
  carry_out(result.output, now);
  if (tap_) tap_(input, result.output, state_);
  const std::scoped_lock lock(mutex_);
  view_ = {now,
           state_.mode,
           state_.standstill,
           state_.pose,
           order_,
           result.output.command,
           state_.way.cross_track_m,
           state_.drive.battery_mv / 1000.0,
           store_problem_.empty() ? link_->problem() : "orders: " + store_problem_};
}

}  // namespace madori::app
