#include "io/udp_receiver.hpp"

#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/udp.hpp>
#include <boost/asio/post.hpp>
#include <thread>

#include "core/clock.hpp"
#include "core/result.hpp"
#include "core/thread_role.hpp"

namespace madori::io {

namespace asio = boost::asio;
using asio::ip::udp;

namespace {

Sender sender_of(const udp::endpoint& endpoint) {
  const auto address = endpoint.address();
  const auto v6 =
      address.is_v6() ? address.to_v6() : asio::ip::make_address_v6(asio::ip::v4_mapped, address.to_v4());
  return {v6.to_bytes(), endpoint.port()};
}

}  // namespace

std::string Sender::text() const {
  const asio::ip::address_v6 v6(address);
  const std::string host = v6.is_v4_mapped() ? asio::ip::make_address_v4(asio::ip::v4_mapped, v6).to_string()
                                             : "[" + v6.to_string() + "]";
  return host + ":" + std::to_string(port);
}

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
      if (!problem) packet({buffer.data(), count}, clock_now(), sender_of(sender));
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
    state_->socket.set_option(udp::socket::receive_buffer_size(1 << 21));
    state_->socket.bind(endpoint);
  } catch (const boost::system::system_error& e) {
    if (e.code() == boost::system::errc::address_not_available)
      throw Error(place, "is no address of this computer",
                  "give the one that the device sends to, not the device's own; 0.0.0.0 takes all");
    throw Error(place, std::string("cannot be listened on: ") + e.what(),
                "check the address and that the port is free");
  }
  state_->packet = std::move(packet);
  state_->receive();
  state_->thread = std::thread([this] {
    (void)take_role("udp receiver", ThreadRole::Device);
    state_->context.run();
  });
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
