#include "io/udp_receiver.hpp"

#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/udp.hpp>
#include <boost/asio/post.hpp>
#include <thread>

#include "core/result.hpp"

namespace madori::io {

namespace asio = boost::asio;
using asio::ip::udp;

struct UdpReceiver::State {
  asio::io_context context{1};
  udp::socket socket{context};
  udp::endpoint sender;
  std::array<std::uint8_t, 2048> buffer{};
  Packet packet;
  std::thread thread;

  void receive() {
    socket.async_receive_from(asio::buffer(buffer), sender, [this](const auto& problem, std::size_t count) {
      if (problem == asio::error::operation_aborted) return;
      const auto now = std::chrono::time_point_cast<Duration>(std::chrono::system_clock::now());
      if (!problem) packet({buffer.data(), count}, now);
      receive();
    });
  }
};

UdpReceiver::UdpReceiver(const std::string& address, std::uint16_t port, Packet packet)
    : state_(std::make_unique<State>()) {
  const std::string place = address + ":" + std::to_string(port);
  try {
    const udp::endpoint endpoint(asio::ip::make_address(address), port);
    state_->socket.open(endpoint.protocol());
    state_->socket.set_option(udp::socket::reuse_address(true));
    state_->socket.set_option(udp::socket::receive_buffer_size(1 << 21));
    state_->socket.bind(endpoint);
  } catch (const std::exception& e) {
    throw Error(place, std::string("cannot be listened on: ") + e.what(),
                "check the address and that the port is free");
  }
  state_->packet = std::move(packet);
  state_->receive();
  state_->thread = std::thread([this] { state_->context.run(); });
}

UdpReceiver::~UdpReceiver() {
  asio::post(state_->context, [this] {
    boost::system::error_code ignored;
    state_->socket.close(ignored);
  });
  state_->thread.join();
}

std::uint16_t UdpReceiver::port() const {
  return state_->socket.local_endpoint().port();
}

}  // namespace madori::io
