#include "tests/bench/robustness/log_harm.hpp"

#include <algorithm>
#include <cmath>

namespace madori::bench {
namespace {

Records cut(const Records& log, const LogHarm& harm) {
  const auto is_scan = [](const auto& r) { return std::holds_alternative<sensors::ScanRecord>(r); };
  const auto scans = static_cast<double>(std::count_if(log.begin(), log.end(), is_scan));
  Records out;
  int n = 0;
  for (const sensors::LogRecord& record : log) {
    if (n >= harm.begin * scans && n <= harm.end * scans) out.push_back(record);
    n += is_scan(record) ? 1 : 0;
  }
  int seen = 0;
  std::erase_if(out, [&](const auto& r) { return is_scan(r) && seen++ % harm.every != 0; });
  return out;
}

void set_stamp(sensors::LogRecord& record, Stamp stamp) {
  if (auto* scan = std::get_if<sensors::ScanRecord>(&record)) scan->scan.stamp = stamp;
  if (auto* odometry = std::get_if<OdometryReading>(&record)) odometry->stamp = stamp;
}

/// Time runs the other way; the scans lose their sweep, which these logs do not state anyway.
void reverse(Records& log) {
  const Stamp last = sensors::stamp_of(log.back());
  const Stamp first = sensors::stamp_of(log.front());
  std::reverse(log.begin(), log.end());
  for (sensors::LogRecord& record : log) set_stamp(record, first + (last - sensors::stamp_of(record)));
}

/// Steps of dead reckoning with errors added, put together again.
class WorseWheels {
 public:
  WorseWheels(const LogHarm& harm, std::mt19937& engine) : harm_(harm), engine_(engine) {}

  Transform2<Odom, Base> operator()(const Transform2<Odom, Base>& read) {
    if (!started_) {
      started_ = true;
      before_ = read;
      return now_ = read;
    }
    const Transform2<Base, Base> step = before_.inverse() * read;
    before_ = read;
    const double way = std::hypot(step.x_m(), step.y_m());
    const double worse = harm_.noise * (std::uniform_int_distribution<int>(0, 49)(engine_) == 0 ? 3.0 : 1.0);
    const double along = harm_.distance_scale * (1.0 + worse * normal_(engine_));
    const double turn = step.yaw_rad() * harm_.turn_scale * (1.0 + worse * normal_(engine_)) +
                        way * (harm_.bias_rad_per_m + worse * normal_(engine_));
    return now_ = now_ * Transform2<Base, Base>(along * step.x_m(), along * step.y_m(), turn);
  }

 private:
  LogHarm harm_;
  std::mt19937& engine_;
  std::normal_distribution<double> normal_;
  bool started_ = false;
  Transform2<Odom, Base> before_;
  Transform2<Odom, Base> now_;
};

}  // namespace

Records harmed(const Records& log, const LogHarm& harm, std::mt19937& engine) {
  Records out = cut(log, harm);
  if (harm.reversed) reverse(out);
  WorseWheels wheels(harm, engine);
  for (sensors::LogRecord& record : out) {
    if (auto* odometry = std::get_if<OdometryReading>(&record)) {
      odometry->odom_from_base = wheels(odometry->odom_from_base);
    } else if (auto* scan = std::get_if<sensors::ScanRecord>(&record); scan->odom_from_base) {
      scan->odom_from_base = wheels(*scan->odom_from_base);
    }
  }
  return out;
}

}  // namespace madori::bench
