#include "simulation/devices/device_hub.hpp"

#include <array>
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

sensors::lms1xx::Dialect dialect_of(const DeviceHubOptions& options) {
  return options.binary_lms ? sensors::lms1xx::Dialect::B : sensors::lms1xx::Dialect::A;
}

class LmsSession : public std::enable_shared_from_this<LmsSession> {
 public:
  LmsSession(tcp::socket socket, sensors::lms1xx::Dialect dialect)
      : socket_(std::move(socket)), dialogue_(dialect) {
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
    socket_.async_read_some(asio::buffer(buffer_),
                            [self = shared_from_this()](Code error, std::size_t count) {
                              if (error) return self->close();
                              const auto answers = self->dialogue_.receive({self->buffer_.data(), count});
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
  std::array<std::uint8_t, 2048> buffer_{};
  std::deque<std::vector<std::uint8_t>> waiting_;
};

}  // namespace

struct DeviceHub::State {
  explicit State(const DeviceHubOptions& given)
      : options(given),
        udp_socket(io, udp::v4()),
        receiver(asio::ip::make_address(given.host), given.vlp16_port),
        acceptor(io, tcp::endpoint(asio::ip::make_address(given.host), given.lms_port)),
        s300(given.folder / "s300"),
        drive(given.folder / "drive") {
    udp_socket.non_blocking(true);
    accept();
  }

  void accept() {
    acceptor.async_accept([this](Code error, tcp::socket socket) {
      if (error) return;
      sessions.push_back(std::make_shared<LmsSession>(std::move(socket), dialect_of(options)));
      sessions.back()->start();
      ++counters.lms_clients;
      accept();
    });
  }
  void send_lms(const std::vector<std::uint8_t>& bytes) {
    std::erase_if(sessions, [](const auto& s) { return !s->open(); });
    for (const auto& session : sessions) {
      if (!session->wants_scans()) continue;
      ++(session->send(bytes) ? counters.lms_telegrams : counters.lms_dropped);
    }
  }
  void send_vlp16(const std::vector<std::uint8_t>& bytes) {
    Code error;
    udp_socket.send_to(asio::buffer(bytes), receiver, 0, error);
    ++(error ? counters.vlp16_refused : counters.vlp16_packets);
  }

  DeviceHubOptions options;
  HubCounters counters;
  asio::io_context io;
  udp::socket udp_socket;
  udp::endpoint receiver;
  tcp::acceptor acceptor;
  std::vector<std::shared_ptr<LmsSession>> sessions;
  Pty s300;
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
      return state_->send_vlp16(packet.bytes);
    case Device::Lms1xx:
      return state_->send_lms(packet.bytes);
    case Device::S300:
      ++state_->counters.s300_telegrams;
      return state_->s300.write(packet.bytes);
    case Device::Drive:
      ++state_->counters.drive_frames;
      return state_->drive.write(packet.bytes);
  }
}

std::vector<std::uint8_t> DeviceHub::poll() {
  state_->io.poll();
  std::vector<std::uint8_t> commands;
  state_->counters.drive_bytes_received += state_->drive.read(commands);
  return commands;
}

std::uint16_t DeviceHub::lms_port() const {
  return state_->acceptor.local_endpoint().port();
}
const std::filesystem::path& DeviceHub::s300_link() const {
  return state_->s300.link();
}
const std::filesystem::path& DeviceHub::drive_link() const {
  return state_->drive.link();
}
const HubCounters& DeviceHub::counters() const {
  return state_->counters;
}

}  // namespace madori::simulation
