#include "mapping/georeference/tile_image.hpp"

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <span>

#include "mapping/picture/image_header.hpp"

namespace madori::mapping {
namespace {

using namespace std::string_view_literals;

/// Decoders fill what is cut off with grey, so the end mark is looked for first.
bool ends_as_it_should(std::string_view bytes) {
  if (bytes.starts_with("\xFF\xD8"sv)) return bytes.ends_with("\xFF\xD9"sv);
  return bytes.size() > 12 && bytes.substr(bytes.size() - 8, 4) == "IEND"sv;
}

}  // namespace

std::string tile_image_fault(std::string_view bytes) {
  if (!bytes.starts_with("\xFF\xD8\xFF"sv) && !bytes.starts_with("\x89PNG\r\n\x1A\n"sv))
    return "is no JPEG or PNG picture";
  if (!ends_as_it_should(bytes)) return "is cut off";
  const std::span data(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  const auto header = read_image_header(data);
  if (!header) return "cannot be decoded";
  const auto side = header->width_px;  // what is larger is not decoded: it may take all the memory
  if (side != header->height_px || (side != 256 && side != 512))
    return "is " + std::to_string(side) + " x " + std::to_string(header->height_px) +
           " pixels, not 256 x 256 or 512 x 512";
  cv::Mat picture;
  try {
    const cv::Mat all(1, static_cast<int>(bytes.size()), CV_8UC1, const_cast<char*>(bytes.data()));
    picture = cv::imdecode(all, cv::IMREAD_COLOR);
  } catch (const cv::Exception&) {
    picture.release();
  }
  return picture.empty() ? "cannot be decoded" : "";
}

}  // namespace madori::mapping
