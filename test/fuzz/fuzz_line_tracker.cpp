// Sequences of images through LineTracker: any size and stride, rectangles that jump, any parameters that
// pass check(), any lens that is no absurd one, angular velocities of any bits. What comes out must keep the
// promises of Line.msg.
#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>

#include <opencv2/imgproc.hpp>

#include "fuzz_target.h"
#include "tet_line_tracker/camera/camera_model.h"
#include "tet_line_tracker/tracking/line_tracker.h"

using namespace tet_line_tracker;

namespace {

/// Any value of a parameter that its range allows.
void setAny(const ParameterTable::Entry& entry, Bytes& bytes) {
  if (std::holds_alternative<bool*>(entry.field)) {
    ParameterTable::assign(entry, bytes.take<std::uint8_t>() % 2 == 0);
    return;
  }
  if (std::holds_alternative<std::string*>(entry.field)) {
    if (entry.choices.empty()) return;
    ParameterTable::assign(entry, entry.choices[bytes.take<std::uint8_t>() % entry.choices.size()]);
    return;
  }
  // Squared: mostly small, so that an image is done in milliseconds.
  const double share = bytes.take<std::uint16_t>() / 65535.0;
  const double value = entry.min + share * share * (entry.max - entry.min);
  if (std::holds_alternative<double*>(entry.field)) {
    ParameterTable::assign(entry, value);
  } else {
    ParameterTable::assign(entry, static_cast<int>(value) | (entry.odd ? 1 : 0));
  }
}

LineTrackerParameters anyParameters(Bytes& bytes) {
  LineTrackerParameters parameters;
  const ParameterTable table = tableOf(parameters);
  const std::size_t count = bytes.take<std::uint8_t>() % 8;
  for (std::size_t i = 0; i < count; ++i) {
    const ParameterTable::Entry& entry = table.entries()[bytes.take<std::uint8_t>() % table.entries().size()];
    // A detector of OpenCV is not what is tried here, and threads cost time and change nothing.
    if (entry.name != "detector" && entry.name != "threads") setAny(entry, bytes);
  }
  return parameters;
}

std::shared_ptr<const CameraModel> anyCamera(Bytes& bytes, int width, int height) {
  CameraCalibration c;
  const char* models[] = {"plumb_bob", "equidistant", "mei"};
  const std::size_t model = bytes.take<std::uint8_t>() % 3;
  c.model = models[model];
  c.width = width;
  c.height = height;
  c.fx = c.fy = std::max(width, height) * (0.05 + bytes.take<std::uint8_t>() / 64.0);
  c.cx = width * (bytes.take<std::int8_t>() / 128.0 + 0.5);
  c.cy = height * (bytes.take<std::int8_t>() / 128.0 + 0.5);
  if (model == 2) c.distortion.push_back(bytes.take<std::uint8_t>() / 128.0);
  for (int i = 0; i < 4; ++i) c.distortion.push_back(bytes.take<std::int8_t>() / 256.0);
  try {
    return makeCameraModel(c);
  } catch (const std::invalid_argument&) {
    return nullptr;
  }
}

/// A few rectangles and, sometimes, noise, in a part of a larger image, so that the stride is not the width.
cv::Mat anyImage(Bytes& bytes, int width, int height) {
  const int margin = bytes.take<std::uint8_t>() % 16;
  cv::Mat image(height, width + margin, CV_8UC1, cv::Scalar(bytes.take<std::uint8_t>()));
  for (int i = bytes.take<std::uint8_t>() % 6; i > 0; --i) {
    const cv::Rect rectangle(
        bytes.take<std::uint8_t>() * width / 256, bytes.take<std::uint8_t>() * height / 256,
        bytes.take<std::uint8_t>() * width / 256, bytes.take<std::uint8_t>() * height / 256);
    cv::rectangle(image, rectangle, cv::Scalar(bytes.take<std::uint8_t>()), cv::FILLED);
  }
  if (bytes.take<std::uint8_t>() % 4 == 0) {
    cv::RNG random(bytes.take<std::uint32_t>());
    cv::Mat noise(image.size(), CV_8UC1);
    random.fill(noise, cv::RNG::UNIFORM, 0, 1 + bytes.take<std::uint8_t>());
    cv::add(image, noise, image);
  }
  return image.colRange(0, width);
}

void checkFrame(const LineFrame& frame, double min_length) {
  std::set<std::uint64_t> ids;
  for (const TrackedLine& line : frame.lines) {
    need(ids.insert(line.id).second, "an id is in the image twice");
    need(line.segment.start.allFinite() && line.segment.end.allFinite(), "an end is not finite");
    for (const Eigen::Vector2f& end : {line.segment.start, line.segment.end}) {
      need(end.x() >= 0.0F && end.y() >= 0.0F && end.x() <= static_cast<float>(frame.width - 1) &&
               end.y() <= static_cast<float>(frame.height - 1),
           "an end is outside the image");
    }
    need(line.segment.length() > 0.999 * min_length, "a line is shorter than min_length");
    need(line.start_normalized.allFinite() == line.end_normalized.allFinite(), "one end alone is normalised");
    need(!(line.sigma_px < 0.0F) && !std::isinf(line.sigma_px), "sigma_px is no standard deviation");
    need(line.age >= 1, "an age is 0");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes bytes(data, size);
  const LineTrackerParameters parameters = anyParameters(bytes);
  if (!check(parameters).empty()) return 0;
  LineTracker tracker(parameters);
  int width = 1 + bytes.take<std::uint16_t>() % 400, height = 1 + bytes.take<std::uint16_t>() % 300;
  tracker.setCamera(anyCamera(bytes, width, height));
  tracker.setImuRotation(Eigen::Matrix3d::Identity());
  std::int64_t stamp = 1'000'000'000;
  for (int k = 0; k < 6; ++k) {
    const int event = bytes.take<std::uint8_t>() % 16;
    if (event == 0) {
      width = 1 + bytes.take<std::uint16_t>() % 400;
      height = 1 + bytes.take<std::uint16_t>() % 300;
    } else if (event == 1) {
      tracker.setCamera(anyCamera(bytes, width, height));
    } else if (event == 2) {
      tracker.reset();
    } else if (event == 3) {
      const LineTrackerParameters others = anyParameters(bytes);
      if (check(others).empty()) tracker.setParameters(others);
    }
    stamp += event == 4 ? bytes.take<std::int32_t>() : 50'000'000;
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d rate =
          event == 5 ? Eigen::Vector3d(bytes.take<double>(), bytes.take<double>(), bytes.take<double>())
                     : Eigen::Vector3d(bytes.take<std::int8_t>() / 64.0, 0.0, 0.0);
      tracker.addAngularVelocity(stamp - (2 - i) * 20'000'000, rate);
    }
    const FrameResult result = tracker.process(anyImage(bytes, width, height), stamp);
    if (result.frame != nullptr) checkFrame(*result.frame, tracker.parameters().detection.min_length);
  }
  return 0;
}
