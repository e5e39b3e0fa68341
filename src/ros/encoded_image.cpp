#include "encoded_image.h"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include <sensor_msgs/image_encodings.h>
#include <opencv2/imgcodecs.hpp>

namespace tet_line_tracker {
namespace {

namespace encodings = sensor_msgs::image_encodings;

using Bytes = std::vector<std::uint8_t>;

bool beginsWith(const Bytes& bytes, const Bytes& head) {
  return bytes.size() >= head.size() && std::equal(head.begin(), head.end(), bytes.begin());
}

/// Programs may append a few bytes to a complete file.
bool endsWith(const Bytes& bytes, const Bytes& tail) {
  constexpr std::size_t kMaxAppended = 1024;
  const auto begin = bytes.end() - static_cast<std::ptrdiff_t>(std::min(bytes.size(), kMaxAppended));
  return std::search(begin, bytes.end(), tail.begin(), tail.end()) != bytes.end();
}

/// A decoder fills the missing part of a cut-off file with gray, or prints its own words; so look for the end
/// mark first.
bool isCutOff(const Bytes& bytes) {
  if (beginsWith(bytes, {0x89, 'P', 'N', 'G'})) return !endsWith(bytes, {'I', 'E', 'N', 'D'});
  if (beginsWith(bytes, {0xFF, 0xD8, 0xFF})) return !endsWith(bytes, {0xFF, 0xD9});
  return false;
}

/// Catches what is printed to stderr: OpenCV hands on the warnings of libjpeg in no other way.
class StderrCatch {
 public:
  StderrCatch() : file_(memfd_create("stderr", MFD_CLOEXEC)) {
    std::fflush(stderr);
    if (file_ < 0) return;
    before_ = dup(STDERR_FILENO);
    if (before_ >= 0) dup2(file_, STDERR_FILENO);
  }
  ~StderrCatch() {
    release();
    if (file_ >= 0) close(file_);
  }
  StderrCatch(const StderrCatch&) = delete;
  StderrCatch& operator=(const StderrCatch&) = delete;

  /// Ends the catch and gives what was caught.
  std::string text() {
    release();
    char buffer[1024];
    const ssize_t size = file_ < 0 ? 0 : pread(file_, buffer, sizeof(buffer), 0);
    return {buffer, static_cast<std::size_t>(std::max<ssize_t>(0, size))};
  }

 private:
  void release() {
    if (before_ < 0) return;
    std::fflush(stderr);
    dup2(before_, STDERR_FILENO);
    close(before_);
    before_ = -1;
  }

  int file_;
  int before_{-1};
};

/// The warning of libjpeg by which a picture is damaged; empty when there is none. Cameras that pad their
/// frames leave a few bytes between the picture and its end mark.
std::string damage(const std::string& words) {
  constexpr long kMaxPadding = 8;
  for (const char* const sign : {"Corrupt JPEG data: ", "Premature end of JPEG"}) {
    const std::size_t begin = words.find(sign);
    if (begin == std::string::npos) continue;
    std::string sentence = words.substr(begin, words.find('\n', begin) - begin);
    const bool padding = sentence.find("extraneous bytes before marker 0xd9") != std::string::npos;
    if (padding && std::strtol(sentence.c_str() + std::string(sign).size(), nullptr, 10) <= kMaxPadding)
      continue;
    return sentence;
  }
  return {};
}

cv::Mat decode(const Bytes& bytes, int flags) {
  try {
    return cv::imdecode(bytes, flags);
  } catch (const cv::Exception&) {
    return {};
  }
}

/// `format` begins with the encoding before the compression and a semicolon, where the driver says it.
std::string encodingOf(const cv::Mat& picture, const std::string& format) {
  if (picture.type() == CV_8UC1) {
    const std::string before = format.substr(0, format.find(';'));
    return encodings::isBayer(before) && encodings::bitDepth(before) == 8 ? before : encodings::MONO8;
  }
  if (picture.type() == CV_8UC3) return encodings::BGR8;
  if (picture.type() == CV_8UC4) return encodings::BGRA8;
  if (picture.type() == CV_16UC1) return encodings::MONO16;
  throw std::invalid_argument("has " + std::to_string(picture.channels()) + " channels of " +
                              std::to_string(8 * picture.elemSize1()) +
                              " bits, needs 8-bit gray or colour, or 16-bit gray");
}

}  // namespace

cv::Mat decodePicture(const std::vector<std::uint8_t>& bytes, int flags, DecoderWarnings warnings) {
  if (isCutOff(bytes)) {
    throw std::invalid_argument("is cut off after " + std::to_string(bytes.size()) + " bytes");
  }
  cv::Mat picture;
  std::string words;
  if (warnings == DecoderWarnings::kArePrinted) {
    picture = decode(bytes, flags);
  } else {
    StderrCatch caught;
    picture = decode(bytes, flags);
    words = caught.text();
  }
  if (picture.empty()) throw std::invalid_argument("is not an image that OpenCV can decode");
  const std::string fault = damage(words);
  if (!fault.empty()) throw std::invalid_argument("is damaged (" + fault + ")");
  return picture;
}

cv_bridge::CvImage decompress(const sensor_msgs::CompressedImage& message, DecoderWarnings warnings) {
  try {
    const cv::Mat picture = decodePicture(message.data, cv::IMREAD_UNCHANGED, warnings);
    return {message.header, encodingOf(picture, message.format), picture};
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument("compressed image (" + message.format + ") " + error.what());
  }
}

}  // namespace tet_line_tracker
