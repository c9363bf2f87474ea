#include "simulation/devices/truth_server.hpp"

#include <boost/asio.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <cstdio>
#include <utility>
#include <vector>

#include "core/result.hpp"

namespace madori::simulation {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using Code = boost::system::error_code;

class Client : public std::enable_shared_from_this<Client> {
 public:
  explicit Client(tcp::socket socket) : stream_(std::move(socket)) {}

  void start() {
    stream_.set_option(websocket::stream_base::timeout::suggested(beast::role_type::server));
    stream_.read_message_max(1024);
    stream_.async_accept([self = shared_from_this()](Code error) {
      if (error) return self->finish();
      self->ready_ = true;
      self->read();
    });
  }
  void send(const std::string& text) {
    if (!ready_) return;
    ready_ = false;
    text_ = text;
    stream_.text(true);
    stream_.async_write(asio::buffer(text_), [self = shared_from_this()](Code error, std::size_t) {
      if (error) return self->finish();
      self->ready_ = true;
    });
  }
  [[nodiscard]] bool finished() const { return finished_; }

 private:
  /// Nothing is expected from a client; reading answers pings and sees it leave.
  void read() {
    stream_.async_read(buffer_, [self = shared_from_this()](Code error, std::size_t) {
      if (error) return self->finish();
      self->buffer_.clear();
      self->read();
    });
  }
  void finish() {
    ready_ = false;
    finished_ = true;
  }

  websocket::stream<beast::tcp_stream> stream_;
  beast::flat_buffer buffer_;
  std::string text_;
  bool ready_ = false;
  bool finished_ = false;
};

}  // namespace

std::string truth_json(const GroundTruth& truth, std::size_t collisions) {
  std::array<char, 320> text{};
  const auto& pose = truth.map_from_base;
  std::snprintf(text.data(), text.size(),
                R"({"time_s":%.3f,"x_m":%.6f,"y_m":%.6f,"yaw_rad":%.6f,"linear_mps":%.4f,)"
                R"("angular_radps":%.4f,"collisions":%zu})",
                to_seconds(truth.stamp), pose.x_m(), pose.y_m(), pose.yaw_rad(), truth.linear_mps,
                truth.angular_radps, collisions);
  return text.data();
}

struct TruthServer::State {
  explicit State(std::uint16_t port) : acceptor(io, {asio::ip::address_v4::loopback(), port}) { accept(); }

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
  std::vector<std::shared_ptr<Client>> clients;
};

TruthServer::TruthServer(std::uint16_t port) {
  try {
    state_ = std::make_unique<State>(port);
  } catch (const boost::system::system_error& e) {
    throw Error("127.0.0.1:" + std::to_string(port), e.what(), "choose another port for the ground truth");
  }
}

TruthServer::~TruthServer() = default;

std::uint16_t TruthServer::port() const {
  return state_->acceptor.local_endpoint().port();
}

void TruthServer::send(const std::string& text) {
  std::erase_if(state_->clients, [](const auto& client) { return client->finished(); });
  for (const auto& client : state_->clients) client->send(text);
}

void TruthServer::poll() {
  state_->io.poll();
}

}  // namespace madori::simulation
