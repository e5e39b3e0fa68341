#include "image_files.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <set>
#include <stdexcept>

#include <opencv2/imgcodecs.hpp>

#include "../../ros/encoded_image.h"

namespace tet_line_tracker {
namespace {

bool isDigit(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

/// The run of digits that begins at `begin`, without leading zeros.
std::string digitsAt(const std::string& text, std::size_t begin, std::size_t& end) {
  end = begin;
  while (end < text.size() && isDigit(text[end])) ++end;
  while (begin + 1 < end && text[begin] == '0') ++begin;
  return text.substr(begin, end - begin);
}

std::string sizeText(const cv::Size& size) {
  return std::to_string(size.width) + "x" + std::to_string(size.height);
}

}  // namespace

bool naturalOrder(const std::string& a, const std::string& b) {
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < a.size() && j < b.size()) {
    if (isDigit(a[i]) && isDigit(b[j])) {
      const std::string number_a = digitsAt(a, i, i);
      const std::string number_b = digitsAt(b, j, j);
      if (number_a.size() != number_b.size()) return number_a.size() < number_b.size();
      if (number_a != number_b) return number_a < number_b;
    } else if (a[i] != b[j]) {
      return a[i] < b[j];
    } else {
      ++i;
      ++j;
    }
  }
  if ((i < a.size()) != (j < b.size())) return j < b.size();
  return a < b;  // equal but for leading zeros
}

std::vector<std::filesystem::path> listImages(const std::filesystem::path& folder) {
  static const std::set<std::string> kExtensions{".png", ".jpg", ".jpeg", ".pgm",  ".ppm",
                                                 ".pnm", ".bmp", ".tif",  ".tiff", ".webp"};
  if (!std::filesystem::is_directory(folder)) throw std::runtime_error(folder.string() + " is not a folder");
  std::vector<std::filesystem::path> images;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    std::string extension = entry.path().extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return std::tolower(c); });
    const bool hidden = entry.path().filename().string().front() == '.';
    if (!hidden && kExtensions.count(extension) != 0 && entry.is_regular_file())
      images.push_back(entry.path());
  }
  if (images.empty()) throw std::runtime_error(folder.string() + " holds no images");
  std::sort(images.begin(), images.end(), [](const auto& a, const auto& b) {
    return naturalOrder(a.filename().string(), b.filename().string());
  });
  return images;
}

cv::Mat readImage(const std::filesystem::path& path) {
  // A fifo would wait for a writer.
  if (!std::filesystem::is_regular_file(path)) throw std::runtime_error("cannot read " + path.string());
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error("cannot read " + path.string());
  const std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(file),
                                        std::istreambuf_iterator<char>()};
  constexpr int kAsStored = cv::IMREAD_ANYCOLOR | cv::IMREAD_ANYDEPTH | cv::IMREAD_IGNORE_ORIENTATION;
  cv::Mat image;
  try {
    image = decodePicture(bytes, kAsStored);
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(path.string() + " " + error.what());
  }
  if (image.type() != CV_8UC1 && image.type() != CV_8UC3 && image.type() != CV_16UC1) {
    throw std::runtime_error(path.string() + " has " + std::to_string(image.channels()) + " channels of " +
                             std::to_string(8 * image.elemSize1()) +
                             " bits, needs 8-bit gray or colour, or 16-bit gray");
  }
  return image;
}

ImageFileSequence::ImageFileSequence(const std::string& name, std::vector<StampedFile> files)
    : files_(std::move(files)) {
  if (files_.empty()) throw std::runtime_error(name + " lists no images");
  for (std::size_t i = 1; i < files_.size(); ++i) {
    if (files_[i].stamp <= files_[i - 1].stamp) {
      throw std::runtime_error(name + ": the stamp of " + files_[i].path.filename().string() +
                               " is not after that of " + files_[i - 1].path.filename().string());
    }
  }
}

std::optional<StampedImage> ImageFileSequence::next() {
  if (next_ >= files_.size()) return std::nullopt;
  const StampedFile& file = files_[next_++];
  StampedImage result{file.stamp, convert(readImage(file.path), file.path)};
  if (size_px_.area() == 0) size_px_ = result.image.size();
  if (result.image.size() != size_px_) {
    throw std::runtime_error(file.path.string() + " is " + sizeText(result.image.size()) +
                             ", the images before it are " + sizeText(size_px_));
  }
  return result;
}

cv::Mat ImageFileSequence::convert(const cv::Mat& image, const std::filesystem::path& /*path*/) const {
  return image;
}

DepthFileSequence::DepthFileSequence(const std::string& name, std::vector<StampedFile> files,
                                     double units_per_m)
    : ImageFileSequence(name, std::move(files)), mm_per_unit_(1000.0 / units_per_m) {}

cv::Mat DepthFileSequence::convert(const cv::Mat& image, const std::filesystem::path& path) const {
  if (image.type() != CV_16UC1) throw std::runtime_error(path.string() + " is not a 16-bit gray image");
  cv::Mat depth_mm;
  image.convertTo(depth_mm, CV_16U, mm_per_unit_);
  return depth_mm;
}

}  // namespace tet_line_tracker
