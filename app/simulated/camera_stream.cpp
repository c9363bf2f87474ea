#include "app/simulated/camera_stream.hpp"

#include <algorithm>
#include <boost/asio.hpp>
#include <chrono>
#include <utility>
#include <vector>

#include "core/result.hpp"

namespace madori::app {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using Code = boost::system::error_code;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kPeriod{200};
constexpr const char* kHead =
    "HTTP/1.1 200 OK\r\nContent-Type: multipart/x-mixed-replace; boundary=picture\r\n"
    "Cache-Control: no-store\r\nConnection: close\r\n\r\n";

class Client : public std::enable_shared_from_this<Client> {
 public:
  explicit Client(tcp::socket socket) : socket_(std::move(socket)) {}

  /// The request's end is waited for; what it asks for does not matter.
  void start() {
    asio::async_read_until(socket_, asio::dynamic_buffer(request_, 8192), "\r\n\r\n",
                           [self = shared_from_this()](Code error, std::size_t) {
                             if (!error) self->write(kHead);
                             self->finished_ = bool(error);
                           });
  }
  /// A client that is still busy with the last picture misses this one.
  void send(const std::string& jpeg) {
    if (ready_)
      write("--picture\r\nContent-Type: image/jpeg\r\nContent-Length: " + std::to_string(jpeg.size()) +
            "\r\n\r\n" + jpeg + "\r\n");
  }
  [[nodiscard]] bool ready() const { return ready_; }
  [[nodiscard]] bool finished() const { return finished_; }

 private:
  void write(std::string bytes) {
    ready_ = false;
    bytes_ = std::move(bytes);
    asio::async_write(socket_, asio::buffer(bytes_), [self = shared_from_this()](Code error, std::size_t) {
      self->ready_ = !error;
      self->finished_ = bool(error);
    });
  }

  tcp::socket socket_;
  std::string request_;
  std::string bytes_;
  bool ready_ = false;
  bool finished_ = false;
};

}  // namespace

struct CameraStream::State {
  State(std::uint16_t port, std::function<std::string()> take)
      : acceptor(io, {asio::ip::address_v4::loopback(), port}), picture(std::move(take)) {
    accept();
  }
  void accept() {
    acceptor.async_accept([this](Code error, tcp::socket socket) {
      if (error) return;
      clients.push_back(std::make_shared<Client>(std::move(socket)));
      clients.back()->start();
      accept();
    });
  }

  asio::io_context io;
  tcp::acceptor acceptor;
  std::function<std::string()> picture;
  std::vector<std::shared_ptr<Client>> clients;
  Clock::time_point sent{};
};

CameraStream::CameraStream(std::uint16_t port, std::function<std::string()> picture) {
  try {
    state_ = std::make_unique<State>(port, std::move(picture));
  } catch (const boost::system::system_error& e) {
    throw Error("127.0.0.1:" + std::to_string(port), e.what(), "choose another port for the camera");
  }
}

CameraStream::~CameraStream() = default;

std::string CameraStream::url() const {
  return "http://127.0.0.1:" + std::to_string(state_->acceptor.local_endpoint().port()) + "/camera.mjpg";
}

void CameraStream::poll() {
  auto& [io, acceptor, picture, clients, sent] = *state_;
  io.poll();
  std::erase_if(clients, [](const auto& client) { return client->finished(); });
  const auto now = Clock::now();
  const bool wanted = std::any_of(clients.begin(), clients.end(), [](const auto& c) { return c->ready(); });
  if (!wanted || now - sent < kPeriod) return;
  sent = now;
  const std::string jpeg = picture();
  for (const auto& client : clients) client->send(jpeg);
}

}  // namespace madori::app
