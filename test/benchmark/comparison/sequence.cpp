#include "sequence.h"

#include <stdexcept>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "simulation/simulation.h"

namespace tet_line_tracker {

Sequence Sequence::ofFolder(const std::string& folder) {
  std::vector<cv::String> files;
  cv::glob(folder + "/*.png", files);
  Sequence sequence;
  sequence.name_ = folder;
  for (const cv::String& file : files) {
    const cv::Mat image = cv::imread(file, cv::IMREAD_GRAYSCALE);
    if (image.empty()) throw std::runtime_error(file + " cannot be read as an image");
    sequence.images_.push_back(image);
  }
  if (sequence.images_.empty()) throw std::runtime_error(folder + " has no PNG images");
  return sequence;
}

Sequence Sequence::simulated(const std::string& motion, int count) {
  SimulationOptions options;
  options.seed = 1001;  // those below 1000 are for tuning
  options.motion = motion;
  options.seconds = (count - 1) / options.rate_hz;
  options.threads = 2;
  Simulation simulation(options, makeCameraModel(defaultSimulatedCamera()));
  Sequence sequence;
  sequence.name_ = "simulated flight, " + motion;
  for (int i = 0; i < count; ++i) sequence.images_.push_back(simulation.nextImage().clone());
  return sequence;
}

const cv::Mat& Sequence::image(std::size_t i) const {
  if (images_.size() == 1) return images_.front();
  const std::size_t place = i % (2 * images_.size() - 2);
  return images_[place < images_.size() ? place : 2 * images_.size() - 2 - place];
}

Sequence Sequence::resized(cv::Size size) const {
  Sequence sequence;
  sequence.name_ = name_;
  for (const cv::Mat& image : images_) {
    const bool smaller = size.width < image.cols;
    cv::Mat scaled;
    cv::resize(image, scaled, size, 0.0, 0.0, smaller ? cv::INTER_AREA : cv::INTER_CUBIC);
    sequence.images_.push_back(scaled);
  }
  return sequence;
}

std::shared_ptr<const CameraModel> Sequence::camera() const {
  CameraCalibration calibration = defaultSimulatedCamera();
  const double scale_x = static_cast<double>(images_.front().cols) / calibration.width;
  const double scale_y = static_cast<double>(images_.front().rows) / calibration.height;
  calibration.width = images_.front().cols;
  calibration.height = images_.front().rows;
  calibration.fx *= scale_x;
  calibration.cx = scale_x * (calibration.cx + 0.5) - 0.5;
  calibration.fy *= scale_y;
  calibration.cy = scale_y * (calibration.cy + 0.5) - 0.5;
  return makeCameraModel(calibration);
}

}  // namespace tet_line_tracker
