#include "track_video.h"

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include <opencv2/imgproc.hpp>

namespace tet_line_tracker {
namespace {

std::string endingOf(const std::string& path) {
  return std::filesystem::path(path).extension();
}

}  // namespace

void checkVideoName(const std::string& path) {
  const std::string ending = endingOf(path);
  if (ending == ".mp4" || ending == ".avi") return;
  throw std::runtime_error("cannot write " + path + ": no video, needs .mp4 or .avi");
}

double imageRate(const std::vector<ros::Time>& stamps) {
  constexpr double kUnknownHz = 20.0;
  if (stamps.size() < 2) return kUnknownHz;
  std::vector<double> intervals;
  for (std::size_t i = 1; i < stamps.size(); ++i) intervals.push_back((stamps[i] - stamps[i - 1]).toSec());
  const auto middle = intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2);
  std::nth_element(intervals.begin(), middle, intervals.end());
  return std::clamp(*middle > 0.0 ? 1.0 / *middle : kUnknownHz, 1.0, 240.0);
}

// FFmpeg takes the format from the last ending.
TrackVideo::TrackVideo(const std::string& path, double rate_hz)
    : ending_(endingOf(path)), rate_hz_(rate_hz), output_(path, ending_) {}

void TrackVideo::setCamera(std::shared_ptr<const CameraModel> camera) {
  painter_.setCamera(std::move(camera));
}

void TrackVideo::add(const cv::Mat& gray, const LineFrame& frame) {
  painter_.paint(gray, frame, picture_);
  if (images_ == 0) {
    size_ = picture_.size();
    const int code = ending_ == ".mp4" ? cv::VideoWriter::fourcc('m', 'p', '4', 'v')
                                       : cv::VideoWriter::fourcc('M', 'J', 'P', 'G');
    if (!writer_.open(output_.temporaryPath(), code, rate_hz_, size_)) {
      throw std::runtime_error("cannot write " + output_.path() + ": this OpenCV has no encoder for " +
                               ending_ + ", or the file cannot be opened");
    }
  }
  ++images_;
  if (picture_.size() == size_) {
    writer_.write(picture_);
    return;
  }
  cv::Mat scaled;
  cv::resize(picture_, scaled, size_);
  writer_.write(scaled);
}

void TrackVideo::close() {
  writer_.release();
  std::size_t readable = 0;
  {
    cv::VideoCapture video(output_.temporaryPath());
    while (video.isOpened() && video.grab()) ++readable;
  }
  errno = 0;
  if (images_ == 0 || readable < images_) {
    output_.fail("of its " + std::to_string(images_) + " images " + std::to_string(readable) +
                 " can be read again");
  }
  output_.moveIntoPlace();
}

}  // namespace tet_line_tracker
