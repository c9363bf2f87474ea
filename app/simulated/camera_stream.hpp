#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace madori::app {

/// A network camera: pictures as Motion JPEG over HTTP (multipart/x-mixed-replace), whatever is asked for. On
/// loopback only, in the thread that calls poll().
class CameraStream {
 public:
  /// Port 0: any free one. Throws Error when it cannot be had. `picture` gives the newest one as JPEG; it is
  /// only asked while somebody looks on, at most five times a second.
  CameraStream(std::uint16_t port, std::function<std::string()> picture);
  ~CameraStream();
  CameraStream(const CameraStream&) = delete;
  CameraStream& operator=(const CameraStream&) = delete;

  [[nodiscard]] std::string url() const;
  void poll();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace madori::app
