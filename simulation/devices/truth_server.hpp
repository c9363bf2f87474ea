#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "simulation/factory.hpp"

namespace madori::simulation {

/// One line of JSON about the vehicle (docs/reference/simulation.md).
[[nodiscard]] std::string truth_json(const GroundTruth& truth, std::size_t collisions);

/// Sends the ground truth to every WebSocket client, on loopback only. One thread, in poll().
class TruthServer {
 public:
  /// Port 0: any free one. Throws Error when it cannot be had.
  explicit TruthServer(std::uint16_t port);
  ~TruthServer();
  TruthServer(const TruthServer&) = delete;
  TruthServer& operator=(const TruthServer&) = delete;

  [[nodiscard]] std::uint16_t port() const;
  /// A client that is still busy with the last message misses this one.
  void send(const std::string& text);
  void poll();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace madori::simulation
