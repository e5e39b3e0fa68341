#include "encoded_image.h"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include <opencv2/imgcodecs.hpp>

namespace tet_line_tracker {
namespace {

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

}  // namespace

cv::Mat decodePicture(const std::vector<std::uint8_t>& bytes, int flags) {
  if (isCutOff(bytes)) {
    throw std::invalid_argument("is cut off after " + std::to_string(bytes.size()) + " bytes");
  }
  cv::Mat picture;
  std::string words;
  if (!bytes.empty()) {
    StderrCatch caught;
    try {
      picture = cv::imdecode(bytes, flags);
    } catch (const cv::Exception&) {
      picture.release();
    }
    words = caught.text();
  }
  if (picture.empty()) throw std::invalid_argument("is not an image that OpenCV can decode");
  const std::string fault = damage(words);
  if (!fault.empty()) throw std::invalid_argument("is damaged (" + fault + ")");
  return picture;
}

}  // namespace tet_line_tracker
