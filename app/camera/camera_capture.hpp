#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

namespace madori::app {

/// The newest picture of a camera, read by OpenCV on a thread of its own. A camera that falls silent, or is
/// not there yet, is opened again every few seconds. Nothing of the vehicle's driving depends on it.
class CameraCapture {
 public:
  /// `source`: a URL (http, rtsp) or a device such as /dev/video0. Throws Error where this program was built
  /// without OpenCV's videoio.
  explicit CameraCapture(std::string source);
  ~CameraCapture();
  CameraCapture(const CameraCapture&) = delete;
  CameraCapture& operator=(const CameraCapture&) = delete;

  /// As JPEG; null while there is none that is younger than two seconds. From any thread.
  [[nodiscard]] std::shared_ptr<const std::string> picture() const;

 private:
  void run();

  std::string source_;
  std::atomic<bool> stop_ = false;
  mutable std::mutex mutex_;
  std::shared_ptr<const std::string> picture_;
  std::chrono::steady_clock::time_point taken_{};
  std::thread thread_;
};

}  // namespace madori::app
