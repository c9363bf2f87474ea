#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "mapping/site/site.hpp"
#include "simulation/mailbox.hpp"

namespace madori::simulation {

struct DeviceHubOptions {
  std::string host = "127.0.0.1";         ///< where the VLP-16 sends to, and where the LMS1xx listens
  std::uint16_t vlp16_port = 2368;        ///< UDP, of the receiver
  std::uint16_t lms_port = 0;             ///< TCP; 0: any free one
  bool binary_lms = true;                 ///< CoLa B
  std::filesystem::path folder = "/tmp";  ///< for the links of the serial ports, `s300` and `drive`
  /// Whose units there are: further ones of a kind get the next VLP-16 port, any TCP port, `s300_2` ...
  /// Empty: one of each kind, and the LMS1xx speaks as `binary_lms` says.
  std::vector<mapping::SensorRecord> sensors;
};

/// What went over the wires.
struct HubCounters {
  std::uint64_t vlp16_packets = 0, vlp16_refused = 0;
  std::uint64_t lms_telegrams = 0;
  std::uint64_t s300_telegrams = 0, drive_frames = 0, drive_bytes_received = 0;
};

/// The devices on real sockets: VLP-16 on UDP, LMS1xx as a TCP server that waits for the start-up dialogue,
/// S300 and drive on pseudo-terminals. One thread; everything happens in send() and poll().
class DeviceHub {
 public:
  /// Throws Error when a port or folder cannot be had.
  explicit DeviceHub(const DeviceHubOptions& options);
  ~DeviceHub();
  DeviceHub(const DeviceHub&) = delete;
  DeviceHub& operator=(const DeviceHub&) = delete;

  void send(const DevicePacket& packet);
  /// Another receiver's port for the VLP-16; from any thread.
  void set_udp_port(std::uint16_t port);
  /// Serves clients; returns what the PC has written to the drive.
  [[nodiscard]] std::vector<std::uint8_t> poll();

  [[nodiscard]] std::uint16_t lms_port(std::size_t unit = 0) const;
  [[nodiscard]] const std::filesystem::path& s300_link(std::size_t unit = 0) const;
  /// Where each of `sensors` is to be found, in their order, as site.yaml writes it.
  [[nodiscard]] std::vector<std::string> addresses() const;
  [[nodiscard]] const std::filesystem::path& drive_link() const;
  [[nodiscard]] const HubCounters& counters() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace madori::simulation
