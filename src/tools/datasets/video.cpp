#include <algorithm>
#include <cmath>
#include <iostream>
#include <stdexcept>

#include <opencv2/videoio.hpp>

#include "dataset.h"

namespace tet_line_tracker {
namespace {

/// Frames of a video file at a constant rate.
class VideoSequence final : public ImageSequence {
 public:
  VideoSequence(const std::string& path, const DatasetOptions& options) : path_(path), video_(path) {
    if (!video_.isOpened()) throw std::runtime_error(path + " is not a video that OpenCV can decode");
    const double told_hz = video_.get(cv::CAP_PROP_FPS);
    if (!options.rate_hz && !(told_hz > 0.0 && std::isfinite(told_hz))) {
      throw std::runtime_error(path + " does not say its rate: --rate is needed");
    }
    rate_hz_ = options.rate_hz.value_or(told_hz);
    announced_ = static_cast<std::size_t>(std::max(0.0, video_.get(cv::CAP_PROP_FRAME_COUNT)));
  }

  std::size_t size() const override { return announced_; }

  std::optional<StampedImage> next() override {
    cv::Mat frame;
    if (!video_.read(frame) || frame.empty()) {
      if (read_ == 0) throw std::runtime_error(path_ + " holds no frame that OpenCV can decode");
      // Many containers only estimate their number of frames, so this is no fault in itself.
      if (read_ < announced_) {
        std::cerr << "dataset_to_bag: " << path_ << " announces " << announced_ << " frames, " << read_
                  << " could be decoded\n";
        announced_ = read_;
      }
      return std::nullopt;
    }
    const ros::Time stamp(kFirstStampS + static_cast<double>(read_) / rate_hz_);
    ++read_;
    return StampedImage{stamp, frame};
  }

 private:
  std::string path_;
  cv::VideoCapture video_;
  double rate_hz_{0.0};
  std::size_t announced_{0};
  std::size_t read_{0};
};

}  // namespace

Dataset openVideo(const std::filesystem::path& path, const DatasetOptions& options) {
  if (std::filesystem::is_directory(path))
    throw std::runtime_error(path.string() + " is a folder, not a video file");
  // A fifo would wait for a writer.
  if (!std::filesystem::is_regular_file(path))
    throw std::runtime_error(path.string() + " is no regular file");
  Dataset dataset;
  dataset.camera = options.camera;
  dataset.images = std::make_unique<VideoSequence>(path.string(), options);
  return dataset;
}

}  // namespace tet_line_tracker
