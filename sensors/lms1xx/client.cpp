#include "sensors/lms1xx/client.hpp"

#include "core/clock.hpp"

namespace madori::sensors::lms1xx {
namespace {

/// An access level, a start of measurement or an event that the device refuses answers with this.
bool is_refused(const Head& head, std::optional<std::uint32_t> answer) {
  if (head.kind == "sFA") return true;
  if (head.name == "LMCstartmeas") return answer.value_or(0) != 0;  // an error code
  return (head.kind == "sAN" || head.kind == "sEA") && answer.value_or(0) != 1;
}

/// What a scanner that still measures says of itself.
std::string warning_of(const ScanData& data) {
  return (data.status[1] & 2U) != 0 ? "the scanner's front screen is dirty: clean it soon" : "";
}

}  // namespace

Client::Client(const ClientOptions& options, Sink sink)
    : options_(options),
      sink_(std::move(sink)),
      dialogue_(start_dialogue(options.with_rssi, options.poll_every > Duration(0))),
      splitter_(options.dialect),
      clock_(options.poll_every > Duration(0)) {
  io::LinkEvents events;
  events.opened = [this] { opened(); };
  events.bytes = [this](std::span<const std::uint8_t> bytes, Stamp received) { receive(bytes, received); };
  events.closed = [this](const std::string& reason) {
    const std::lock_guard lock(mutex_);
    state_ = ClientState::Disconnected;
    problem_ = options_.host + ": " + reason;
  };
  link_ = io::StreamLink::tcp(options.host, options.port, std::move(events),
                              {.reopen_after = options.reconnect_after, .silence = options.silence});
  link_->start();
  if (is_polled()) poller_ = std::jthread([this](const std::stop_token& stop) { poll(stop); });
}

Client::~Client() = default;

/// Asks at the times that the period gives; an answer that does not come is a matter of the link's silence.
void Client::poll(const std::stop_token& stop) {
  const Bytes question = encode(options_.dialect, poll_message());
  while (!stop.stop_requested()) {
    bool measures = false;
    {
      std::unique_lock lock(mutex_);
      wake_.wait_for(lock, stop, options_.poll_every, [] { return false; });
      measures = state_ == ClientState::Measuring;
    }
    if (measures && !stop.stop_requested()) link_->write(question);
  }
}

void Client::opened() {
  {
    const std::lock_guard lock(mutex_);
    state_ = ClientState::Starting;
    ++counters_.connections;
  }
  splitter_.clear();
  any_head_ = false;
  skipped_before_ = splitter_.skipped_bytes();
  clock_.reset();
  step_ = 0;
  send_next();
}

void Client::send_next() {
  link_->write(encode(options_.dialect, dialogue_[step_]));
}

void Client::receive(std::span<const std::uint8_t> bytes, Stamp received) {
  splitter_.push(bytes);
  while (const auto payload = splitter_.next()) {
    const auto head = head_of(*payload);
    if (!head) continue;
    any_head_ = true;
    if (head->name == "LMDscandata" && (head->kind == "sSN" || (is_polled() && head->kind == "sRA")))
      take_scan(*payload, received);
    else
      take_reply(*head);
  }
  if (speaks_other())
    link_->drop(std::string("what answers there does not speak CoLa ") +
                (options_.dialect == Dialect::A ? "A" : "B") + ": check the address, and cola: in site.yaml");
  const std::lock_guard lock(mutex_);
  counters_.damaged = splitter_.damaged();
}

bool Client::speaks_other() const {
  constexpr std::uint64_t kNoise = 32;
  return !any_head_ && splitter_.skipped_bytes() - skipped_before_ > kNoise;
}

void Client::take_reply(const Head& head) {
  if (step_ >= dialogue_.size() || (head.kind != "sFA" && head.name != dialogue_[step_].name)) return;
  if (is_refused(head, first_argument(options_.dialect, head))) {
    link_->drop("the scanner refuses " + dialogue_[step_].name);
    return;
  }
  if (++step_ < dialogue_.size()) return send_next();
  const std::lock_guard lock(mutex_);
  state_ = ClientState::Measuring;
  problem_.clear();
}

void Client::take_scan(std::span<const std::uint8_t> payload, Stamp received) {
  const auto data = decode_scan(options_.dialect, payload);
  auto scan = data ? to_laser_scan(data.value()) : Result<LaserScan>::failure(data.reason());
  if (!scan) {
    const std::lock_guard lock(mutex_);
    ++counters_.refused;
    problem_ = scan.reason();
    return;
  }
  LaserScan result = std::move(scan).value();
  const ScanData& d = data.value();
  if (clock_.is_repeated(d)) {
    const std::lock_guard lock(mutex_);
    return void(++counters_.refused);
  }
  result.stamp = clock_.stamp_of(d, received);
  {
    const std::lock_guard lock(mutex_);
    counters_.lost = clock_.lost();
    heard_ = received;
    ++counters_.scans;
    if (state_ == ClientState::Measuring) problem_ = warning_of(d);
  }
  sink_(result, d);
}

Duration Client::silence() const {
  const std::lock_guard lock(mutex_);
  return clock_now() - heard_;
}

ClientState Client::state() const {
  const std::lock_guard lock(mutex_);
  return state_;
}

ClientCounters Client::counters() const {
  const std::lock_guard lock(mutex_);
  return counters_;
}

std::string Client::problem() const {
  const std::lock_guard lock(mutex_);
  return problem_;
}

}  // namespace madori::sensors::lms1xx
