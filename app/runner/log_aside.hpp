#pragma once

#include <spdlog/async.h>
#include <spdlog/spdlog.h>

#include <cstddef>
#include <memory>

#include "core/thread_role.hpp"

namespace madori::app {

/// While it lives, what spdlog writes is written by a thread of its own: a terminal that is held, a pipe that
/// nobody reads or a journal on a slow disk holds nobody up. Where it cannot keep up the oldest lines are
/// lost.
class LogAside {
 public:
  LogAside() : before_(spdlog::default_logger()) {
    constexpr std::size_t kLines = 1024;
    pool_ = std::make_shared<spdlog::details::thread_pool>(
        kLines, 1, [] { (void)take_role("log", ThreadRole::Behind); });
    const auto aside = std::make_shared<spdlog::async_logger>(before_->name(), before_->sinks().begin(),
                                                              before_->sinks().end(), pool_,
                                                              spdlog::async_overflow_policy::overrun_oldest);
    aside->set_level(before_->level());
    aside->flush_on(spdlog::level::info);
    spdlog::set_default_logger(aside);
  }
  /// Writes what is left.
  ~LogAside() { spdlog::set_default_logger(before_); }
  LogAside(const LogAside&) = delete;
  LogAside& operator=(const LogAside&) = delete;

 private:
  std::shared_ptr<spdlog::logger> before_;
  std::shared_ptr<spdlog::details::thread_pool> pool_;
};

}  // namespace madori::app
