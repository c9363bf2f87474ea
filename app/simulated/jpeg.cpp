#include "app/simulated/jpeg.hpp"

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <vector>

namespace madori::app {

std::string to_jpeg(const simulation::CameraPicture& picture) {
  auto pixels = picture.bgr;
  const cv::Mat image(picture.height_px, picture.width_px, CV_8UC3, pixels.data());
  std::vector<unsigned char> jpeg;
  cv::imencode(".jpg", image, jpeg, {cv::IMWRITE_JPEG_QUALITY, 80});
  return {jpeg.begin(), jpeg.end()};
}

}  // namespace madori::app
