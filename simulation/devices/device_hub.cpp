#include "simulation/devices/device_hub.hpp"

#include <array>
#include <atomic>
#include <boost/asio.hpp>
#include <deque>
#include <utility>

#include "core/result.hpp"
#include "simulation/devices/lms_server.hpp"
#include "simulation/devices/pty.hpp"

namespace madori::simulation {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using asio::ip::udp;
using Code = boost::system::error_code;

constexpr std::size_t kMostWaiting = 64;  ///< telegrams for a client that does not read

using sensors::lms1xx::Dialect;
using Telegram = std::vector<std::uint8_t>;

class LmsSession : public std::enable_shared_from_this<LmsSession> {
 public:
  LmsSession(tcp::socket socket, sensors::lms1xx::Dialect dialect, std::shared_ptr<const Telegram> newest)
      : socket_(std::move(socket)), dialogue_(dialect), newest_(std::move(newest)) {
    Code ignored;
    socket_.set_option(tcp::no_delay(true), ignored);
  }

  void start() { read(); }
  [[nodiscard]] bool open() const { return socket_.is_open(); }
  [[nodiscard]] bool wants_scans() const { return dialogue_.wants_scans(); }
  /// False when too much is waiting already.
  bool send(const std::vector<std::uint8_t>& bytes) {
    if (waiting_.size() >= kMostWaiting) return false;
    waiting_.push_back(bytes);
    if (waiting_.size() == 1) write();
    return true;
  }

 private:
  void read() {
    socket_.async_read_some(
        asio::buffer(buffer_), [self = shared_from_this()](Code error, std::size_t count) {
          if (error) return self->close();
          const auto answers = self->dialogue_.receive({self->buffer_.data(), count}, *self->newest_);
          if (!answers.empty()) self->send(answers);
          self->read();
        });
  }
  void write() {
    asio::async_write(socket_, asio::buffer(waiting_.front()),
                      [self = shared_from_this()](Code error, std::size_t) {
                        if (error) return self->close();
                        self->waiting_.pop_front();
                        if (!self->waiting_.empty()) self->write();
                      });
  }
  void close() {
    Code ignored;
    socket_.close(ignored);
  }

  tcp::socket socket_;
  LmsDialogue dialogue_;
  std::shared_ptr<const Telegram> newest_;  ///< of the scanner
  std::array<std::uint8_t, 2048> buffer_{};
  std::deque<std::vector<std::uint8_t>> waiting_;
};

/// One virtual LMS1xx: listens, and serves everybody who calls.
class LmsPort {
 public:
  LmsPort(asio::io_context& io, const std::string& host, std::uint16_t port, Dialect dialect,
          HubCounters& counters)
      : acceptor_(io, tcp::endpoint(asio::ip::make_address(host), port)),
        dialect_(dialect),
        counters_(counters) {
    accept();
  }

  void send(const std::vector<std::uint8_t>& bytes) {
    *newest_ = bytes;
    std::erase_if(sessions_, [](const auto& s) { return !s->open(); });
    for (const auto& session : sessions_) {
      if (!session->wants_scans()) continue;
      if (session->send(bytes)) ++counters_.lms_telegrams;
    }
  }
  [[nodiscard]] std::uint16_t port() const { return acceptor_.local_endpoint().port(); }

 private:
  void accept() {
    acceptor_.async_accept([this](Code error, tcp::socket socket) {
      if (error) return;
      sessions_.push_back(std::make_shared<LmsSession>(std::move(socket), dialect_, newest_));
      sessions_.back()->start();
      accept();
    });
  }

  tcp::acceptor acceptor_;
  Dialect dialect_;
  HubCounters& counters_;
  std::shared_ptr<Telegram> newest_ = std::make_shared<Telegram>();
  std::vector<std::shared_ptr<LmsSession>> sessions_;
};

std::string unit_name(const char* name, std::size_t unit) {
  return unit == 0 ? name : std::string(name) + "_" + std::to_string(unit + 1);
}

}  // namespace

struct DeviceHub::State {
  explicit State(const DeviceHubOptions& given)
      : options(given),
        vlp16_receiver(given.vlp16_port),
        udp_socket(io, udp::v4()),
        drive(given.folder / "drive") {
    udp_socket.non_blocking(true);
    if (options.sensors.empty()) {
      add_lms(options.binary_lms ? Dialect::B : Dialect::A);
      add_s300();
    }
    for (const auto& sensor : options.sensors) {
      const auto cola = sensor.settings.find("cola");
      const bool text = cola != sensor.settings.end() && cola->second == "A";
      if (sensor.type == to_string(Device::Lms1xx)) add_lms(text ? Dialect::A : Dialect::B);
      if (sensor.type == to_string(Device::S300)) add_s300();
    }
  }

  void add_lms(Dialect dialect) {
    const std::uint16_t port = lms.empty() ? options.lms_port : std::uint16_t{0};
    lms.push_back(std::make_unique<LmsPort>(io, options.host, port, dialect, counters));
  }
  void add_s300() { s300.push_back(std::make_unique<Pty>(options.folder / unit_name("s300", s300.size()))); }
  [[nodiscard]] std::uint16_t vlp16_port(std::size_t unit) const {
    return static_cast<std::uint16_t>(vlp16_receiver + unit);
  }
  void send_vlp16(const std::vector<std::uint8_t>& bytes, std::size_t unit) {
    Code error;
    const udp::endpoint receiver(asio::ip::make_address(options.host), vlp16_port(unit));
    udp_socket.send_to(asio::buffer(bytes), receiver, 0, error);
    ++(error ? counters.vlp16_refused : counters.vlp16_packets);
  }

  DeviceHubOptions options;
  std::atomic<std::uint16_t> vlp16_receiver;
  HubCounters counters;
  asio::io_context io;
  udp::socket udp_socket;
  std::vector<std::unique_ptr<LmsPort>> lms;
  std::vector<std::unique_ptr<Pty>> s300;
  Pty drive;
};

DeviceHub::DeviceHub(const DeviceHubOptions& options) {
  try {
    state_ = std::make_unique<State>(options);
  } catch (const boost::system::system_error& e) {
    throw Error(options.host + ":" + std::to_string(options.lms_port), e.what(),
                "choose another address or port for the virtual LMS1xx");
  }
}

DeviceHub::~DeviceHub() = default;

void DeviceHub::send(const DevicePacket& packet) {
  switch (packet.device) {
    case Device::Vlp16:
      return state_->send_vlp16(packet.bytes, packet.unit);
    case Device::Lms1xx:
      return packet.unit < state_->lms.size() ? state_->lms[packet.unit]->send(packet.bytes) : void();
    case Device::S300:
      ++state_->counters.s300_telegrams;
      return packet.unit < state_->s300.size() ? state_->s300[packet.unit]->write(packet.bytes) : void();
    case Device::Drive:
      ++state_->counters.drive_frames;
      return state_->drive.write(packet.bytes);
  }
}

void DeviceHub::set_udp_port(std::uint16_t port) {
  state_->vlp16_receiver = port;
}

std::vector<std::uint8_t> DeviceHub::poll() {
  state_->io.poll();
  std::vector<std::uint8_t> commands;
  state_->counters.drive_bytes_received += state_->drive.read(commands);
  return commands;
}

std::uint16_t DeviceHub::lms_port(std::size_t unit) const {
  return state_->lms.at(unit)->port();
}
const std::filesystem::path& DeviceHub::s300_link(std::size_t unit) const {
  return state_->s300.at(unit)->link();
}
std::vector<std::string> DeviceHub::addresses() const {
  std::vector<std::string> all;
  std::size_t vlp16 = 0, lms = 0, s300 = 0;
  for (const auto& sensor : state_->options.sensors) {
    all.emplace_back();
    if (sensor.type == to_string(Device::Vlp16))
      all.back() = state_->options.host + ":" + std::to_string(state_->vlp16_port(vlp16++));
    if (sensor.type == to_string(Device::Lms1xx))
      all.back() = state_->options.host + ":" + std::to_string(lms_port(lms++));
    if (sensor.type == to_string(Device::S300)) all.back() = s300_link(s300++).string();
  }
  return all;
}
const std::filesystem::path& DeviceHub::drive_link() const {
  return state_->drive.link();
}
const HubCounters& DeviceHub::counters() const {
  return state_->counters;
}

}  // namespace madori::simulation
