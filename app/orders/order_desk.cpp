#include "app/orders/order_desk.hpp"

#include <spdlog/spdlog.h>

#include <utility>

#include "core/clock.hpp"
#include "core/thread_role.hpp"

namespace madori::app {

OrderDesk::OrderDesk(const std::filesystem::path& database, const Options& options,
                     const std::optional<std::vector<int>>& stations)
    : options_(options), store_(database) {
  if (stations) store_.keep_stations(*stations, time_of_day());
  if (!options_.lock_step) thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

OrderDesk::~OrderDesk() = default;

std::optional<Order> OrderDesk::order(Stamp now, bool may_begin) {
  std::unique_lock lock(mutex_);
  const bool due = seen_ && !(to_seconds(now - asked_) < options_.poll_s);
  if (due) {
    asked_ = now;
    waiting_.look = true;
    waiting_.may_begin = may_begin;
    waiting_.label = time_of_day(now);
  }
  if (due && options_.lock_step) do_work(lock);
  if (due) wake_.notify_one();
  seen_ = true;
  return order_;
}

std::string OrderDesk::problem() const {
  const std::scoped_lock lock(mutex_);
  return problem_;
}

void OrderDesk::stop_reached(const Target& stop, Stamp label) {
  report({stop, std::nullopt, label});
}

void OrderDesk::refuse(std::int64_t id, const std::string& why, Stamp label) {
  report({{.order = id}, why, label});
  add({label, "order", "order " + std::to_string(id) + " refused: " + why});
}

void OrderDesk::cancel_running(const std::string& why, Stamp label) {
  report({{}, why, label, OrderState::Cancelled});
}

void OrderDesk::report(Report report) {
  std::unique_lock lock(mutex_);
  if (report.ended) order_.reset();
  waiting_.fresh = true;
  waiting_.reports.push_back(std::move(report));
  if (options_.lock_step) do_work(lock);
  wake_.notify_one();
}

void OrderDesk::add(EventRecord event) {
  std::unique_lock lock(mutex_);
  waiting_.events.push_back(std::move(event));
  if (options_.lock_step) do_work(lock);
  wake_.notify_one();
}

/// Throws Error where the database does not take it: the same report is made again then.
std::optional<Order> OrderDesk::settle(const Report& report) {
  if (!report.ended)
    return store_.stop_done(report.what.order, report.what.round, report.what.stop, report.label);
  const auto close = [&](std::int64_t id) { store_.close(id, report.state, *report.ended, report.label); };
  if (report.state == OrderState::Refused) {
    close(report.what.order);
  } else {
    for (const Order& order : store_.list(true))
      if (order.state == OrderState::Running) close(order.id);
  }
  return std::nullopt;
}

/// Orders come from other programs too: what stands in the database counts.
std::optional<Order> OrderDesk::look(const std::optional<Order>& known, const Work& work) {
  const auto order = known ? store_.find(known->id) : std::nullopt;
  if (order && order->state == OrderState::Running) return order;
  return work.may_begin ? store_.begin_next(work.label) : std::nullopt;
}

void OrderDesk::write(const std::deque<EventRecord>& events) {
  for (const EventRecord& event : events) {
    try {
      store_.add_event(event);
    } catch (const std::exception& e) {
      spdlog::error("event lost: {} ({})", event.text, e.what());
    }
  }
}

/// In words, when it begins and when it ends.
void OrderDesk::tell(const std::string& problem) {
  if (problem == problem_) return;
  if (problem.empty())
    spdlog::info("orders can be read and written again");
  else
    spdlog::error("{}", problem);
  problem_ = problem;
}

/// What waits, outside the lock. What the database does not take waits for the next look; an order that came
/// to its end is seen before the next one begins.
void OrderDesk::do_work(std::unique_lock<std::mutex>& lock) {
  Work work = std::exchange(waiting_, {});
  const bool reported = !work.reports.empty();
  std::optional<Order> order = order_;
  lock.unlock();
  std::string problem;
  try {
    if (work.look && !reported) order = look(order, work);
    for (; !work.reports.empty(); work.reports.pop_front()) {
      const Report& report = work.reports.front();
      order = settle(report);
      if (order)
        work.events.push_back(
            {report.label, "order",
             "order " + std::to_string(order->id) + ": stop reached; " + to_string(order->state)});
    }
  } catch (const std::exception& e) {
    problem = e.what();
  }
  write(work.events);
  lock.lock();
  waiting_.reports.insert(waiting_.reports.begin(), work.reports.begin(), work.reports.end());
  if (!reported && !work.look) return;
  if (reported) waiting_.look = seen_ = false;     // a look asked for meanwhile did not know this
  if (!waiting_.fresh) order_ = std::move(order);  // a report that came meanwhile knows better
  tell(problem);
}

void OrderDesk::run(const std::stop_token& stop) {
  (void)take_role("orders", ThreadRole::Ordinary);
  std::unique_lock lock(mutex_);
  for (bool last = false; !last;) {
    wake_.wait(lock, stop, [this] { return waiting_.look || waiting_.fresh || !waiting_.events.empty(); });
    last = stop.stop_requested();
    do_work(lock);
  }
}

}  // namespace madori::app
