#include "app/camera/camera_capture.hpp"

#include <spdlog/spdlog.h>

#include <utility>

#include "core/result.hpp"
#include "core/thread_role.hpp"
#ifdef MADORI_WITH_CAMERA
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <vector>
#endif

namespace madori::app {

using Clock = std::chrono::steady_clock;

CameraCapture::~CameraCapture() {
  stop_ = true;
  if (thread_.joinable()) thread_.join();
}

std::shared_ptr<const std::string> CameraCapture::picture() const {
  constexpr std::chrono::seconds kFresh{2};
  const std::scoped_lock lock(mutex_);
  return Clock::now() - taken_ < kFresh ? picture_ : nullptr;
}

#ifdef MADORI_WITH_CAMERA

namespace {

constexpr int kMostWidth_px = 960;
constexpr std::chrono::milliseconds kBetweenPictures{180};  // the panel asks five times a second
constexpr int kPatience_ms = 2000;

void open(cv::VideoCapture& camera, const std::string& source) {
  if (source.find("://") == std::string::npos) {
    camera.open(source, cv::CAP_V4L2);
    return;
  }
  camera.open(source, cv::CAP_FFMPEG,
              {cv::CAP_PROP_OPEN_TIMEOUT_MSEC, kPatience_ms, cv::CAP_PROP_READ_TIMEOUT_MSEC, kPatience_ms});
}

/// Not larger than a panel shows it.
std::string as_jpeg(cv::Mat picture) {
  if (picture.cols > kMostWidth_px)
    cv::resize(picture, picture, {kMostWidth_px, picture.rows * kMostWidth_px / picture.cols}, 0, 0,
               cv::INTER_AREA);
  std::vector<unsigned char> jpeg;
  cv::imencode(".jpg", picture, jpeg, {cv::IMWRITE_JPEG_QUALITY, 80});
  return {jpeg.begin(), jpeg.end()};
}

}  // namespace

CameraCapture::CameraCapture(std::string source) : source_(std::move(source)), thread_([this] { run(); }) {}

void CameraCapture::run() {
  (void)take_role("camera", ThreadRole::Behind);
  cv::VideoCapture camera;
  cv::Mat frame;
  Clock::time_point tried = Clock::now() - std::chrono::seconds(10);
  while (!stop_) {
    if (!camera.isOpened()) {
      if (Clock::now() - std::exchange(tried, Clock::now()) < std::chrono::seconds(2))
        std::this_thread::sleep_for(kBetweenPictures);
      open(camera, source_);
      continue;
    }
    if (!camera.grab()) {
      spdlog::warn("the camera {} is silent", source_);
      camera.release();
      continue;
    }
    const auto now = Clock::now();
    if (now - taken_ < kBetweenPictures || !camera.retrieve(frame) || frame.empty()) continue;
    auto jpeg = std::make_shared<const std::string>(as_jpeg(frame));
    const std::scoped_lock lock(mutex_);
    picture_ = std::move(jpeg);
    taken_ = now;
  }
}

#else

CameraCapture::CameraCapture(std::string source) : source_(std::move(source)) {
  throw Error("camera " + source_, "cannot be read: Madori was built without OpenCV's videoio",
              "install libopencv-videoio-dev and build again, or take `camera` out of site.yaml");
}

void CameraCapture::run() {}

#endif

}  // namespace madori::app
