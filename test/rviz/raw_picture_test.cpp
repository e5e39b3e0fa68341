#include "raw_picture.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <boost/make_shared.hpp>

#include "../ros/camera_info.h"
#include "line_array_view.h"

namespace tet_line_tracker {
namespace {

sensor_msgs::CameraInfo infoOf(const std::string& model, int width, int height, double focal,
                               const std::vector<double>& distortion) {
  CameraCalibration calibration;
  calibration.model = model;
  calibration.width = width;
  calibration.height = height;
  calibration.fx = focal;
  calibration.fy = 0.997 * focal;
  calibration.cx = 0.49 * width;
  calibration.cy = 0.52 * height;
  calibration.distortion = distortion;
  return toCameraInfo(calibration);
}

sensor_msgs::CameraInfo eurocInfo() {
  return infoOf("plumb_bob", 752, 480, 458.654, {-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05});
}

/// 195 degrees across the diagonal.
sensor_msgs::CameraInfo fisheyeInfo() {
  return infoOf("equidistant", 512, 512, 190.978,
                {0.0034823894, 0.00071502487, -0.0020532361, 0.00020293673});
}

std::shared_ptr<const RawPicture> pictureOf(const sensor_msgs::CameraInfo& info) {
  const RawPictureChoice choice = chooseRawPicture(info, info.width, info.height);
  EXPECT_TRUE(choice.picture != nullptr) << choice.problem;
  return choice.picture;
}

/// Where the Camera display of rviz shows a point of the optical frame: pixels of the picture under it, of
/// which (0, 0) is the middle of the first. Written after updateCamera() of camera_display.cpp.
Eigen::Vector2d inCameraDisplay(const sensor_msgs::CameraInfo& info, const Eigen::Vector3f& point) {
  const double x = point.x() + info.P[3] / info.P[0];
  const double y = point.y() - info.P[7] / info.P[5];
  const double width = info.width;
  const double height = info.height;
  // Of the projection matrix; -1 and 1 are the borders of the window.
  const double right = 2.0 * info.P[0] / width * x / point.z() - 2.0 * (0.5 - info.P[2] / width);
  const double up = -2.0 * info.P[5] / height * y / point.z() - 2.0 * (info.P[6] / height - 0.5);
  // Of the rectangle with the picture.
  double left = -1.0;
  double top = 1.0;
  double wide = 2.0;
  double high = 2.0;
  if (info.roi.width != 0 || info.roi.height != 0) {
    left = 2.0 * info.roi.x_offset / width - 1.0;
    top = -2.0 * info.roi.y_offset / height + 1.0;
    wide = 2.0 * info.roi.width / width;
    high = 2.0 * info.roi.height / height;
  }
  const CameraCalibration image = fromCameraInfo(info);
  return {(right - left) / wide * image.width - 0.5, (top - up) / high * image.height - 0.5};
}

Line lineOf(const CameraModel& camera, const Eigen::Vector2f& start, const Eigen::Vector2f& end) {
  Line line;
  line.age = 1;
  line.start_px = {start.x(), start.y()};
  line.end_px = {end.x(), end.y()};
  const Eigen::Vector2d unknown = Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
  const Eigen::Vector2d from = camera.normalize(start.cast<double>()).value_or(unknown);
  const Eigen::Vector2d to = camera.normalize(end.cast<double>()).value_or(unknown);
  line.start_normalized = {from.x(), from.y()};
  line.end_normalized = {to.x(), to.y()};
  return line;
}

ShownLines shownOver(const sensor_msgs::CameraInfo& info, const std::vector<Line>& lines,
                     bool frustum = false) {
  auto message = boost::make_shared<LineArray>();
  message->width = info.width;
  message->height = info.height;
  message->lines = lines;
  LineArrayStyle style;
  style.depth = 2.5;
  style.frustum = frustum;
  style.raw = pictureOf(info);
  return showLines({{message, Eigen::Isometry3d::Identity()}}, style);
}

/// The drawn line in pixels of the picture: its points, and some places between them.
std::vector<Eigen::Vector2d> drawnPixels(const sensor_msgs::CameraInfo& info, const ShownLine& line) {
  std::vector<Eigen::Vector3f> points{line.start};
  points.insert(points.end(), line.between.begin(), line.between.end());
  points.push_back(line.end);
  std::vector<Eigen::Vector2d> pixels{inCameraDisplay(info, points.front())};
  for (std::size_t i = 1; i < points.size(); ++i) {
    const Eigen::Vector2d last = pixels.back();
    const Eigen::Vector2d next = inCameraDisplay(info, points[i]);
    for (const double fraction : {0.25, 0.5, 0.75, 1.0}) pixels.emplace_back(last + fraction * (next - last));
  }
  return pixels;
}

double distance(const Eigen::Vector2d& point, const Eigen::Vector2d& start, const Eigen::Vector2d& end) {
  const Eigen::Vector2d way = end - start;
  const double along = std::clamp((point - start).dot(way) / way.squaredNorm(), 0.0, 1.0);
  return (point - start - along * way).norm();
}

/// The image of the straight line between two points of z = 1 [px].
std::vector<Eigen::Vector2d> trueImage(const CameraModel& camera, const Line& line) {
  constexpr int kPieces = 4000;
  const Eigen::Vector2d start(line.start_normalized[0], line.start_normalized[1]);
  const Eigen::Vector2d end(line.end_normalized[0], line.end_normalized[1]);
  std::vector<Eigen::Vector2d> pixels;
  for (int i = 0; i <= kPieces; ++i) {
    pixels.push_back(*camera.project((start + i * (end - start) / kPieces).homogeneous()));
  }
  return pixels;
}

/// Largest distance of drawn lines all over the image from where the lens shows them, and of their chords.
void expectOnTheirImages(const sensor_msgs::CameraInfo& info) {
  const std::shared_ptr<const CameraModel> camera = chooseCamera(info).camera;
  ASSERT_NE(camera, nullptr);
  std::mt19937 generator(7);
  std::uniform_real_distribution<float> x(0.0F, static_cast<float>(info.width - 1));
  std::uniform_real_distribution<float> y(0.0F, static_cast<float>(info.height - 1));
  std::vector<Line> lines;
  while (lines.size() < 40) {
    const Line line = lineOf(*camera, {x(generator), y(generator)}, {x(generator), y(generator)});
    if (std::isfinite(line.start_normalized[0]) && std::isfinite(line.end_normalized[0])) {
      lines.push_back(line);
    }
  }
  const ShownLines shown = shownOver(info, lines);
  ASSERT_EQ(shown.lines.size(), lines.size());
  double worst = 0.0;
  double worst_of_chords = 0.0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::vector<Eigen::Vector2d> image = trueImage(*camera, lines[i]);
    for (const Eigen::Vector2d& drawn : drawnPixels(info, shown.lines[i])) {
      double nearest = std::numeric_limits<double>::infinity();
      for (std::size_t k = 1; k < image.size(); ++k) {
        nearest = std::min(nearest, distance(drawn, image[k - 1], image[k]));
      }
      worst = std::max(worst, nearest);
    }
    worst_of_chords =
        std::max(worst_of_chords, distance(image[image.size() / 2], image.front(), image.back()));
    EXPECT_LT((inCameraDisplay(info, shown.lines[i].start) - image.front()).norm(), 0.01);
    EXPECT_LT((inCameraDisplay(info, shown.lines[i].end) - image.back()).norm(), 0.01);
  }
  EXPECT_LT(worst, 0.05);
  EXPECT_GT(worst_of_chords, 5.0) << "straight lines would have done";
}

TEST(RawPicture, LaysLinesWhereTheLensOfEurocShowsThem) {
  expectOnTheirImages(eurocInfo());
}

TEST(RawPicture, LaysLinesWhereAFisheyeShowsThem) {
  expectOnTheirImages(fisheyeInfo());
}

TEST(RawPicture, TakesTheProjectionThatTheCameraDisplayTakes) {
  // As a stereo calibration has it: P is that of the rectified image, of the right camera.
  sensor_msgs::CameraInfo info = eurocInfo();
  info.P = {435.2, 0, 367.4, -47.9, 0, 431.0, 252.2, 3.5, 0, 0, 1, 0};
  expectOnTheirImages(info);
}

TEST(RawPicture, FollowsBinningAndRegionOfInterest) {
  sensor_msgs::CameraInfo info = eurocInfo();
  const std::shared_ptr<const CameraModel> full = chooseCamera(info).camera;
  info.binning_x = 2;
  info.binning_y = 2;
  info.roi.x_offset = 100;
  info.roi.y_offset = 40;
  info.roi.width = 600;
  info.roi.height = 400;
  const RawPictureChoice choice = chooseRawPicture(info, 300, 200);
  ASSERT_NE(choice.picture, nullptr) << choice.problem;
  for (const Eigen::Vector2d& pixel : {Eigen::Vector2d(0, 0), Eigen::Vector2d(299, 0), {120, 199}}) {
    const Eigen::Vector3d point = choice.picture->pointOver(pixel, 2.5);
    EXPECT_LT((inCameraDisplay(info, point.cast<float>()) - pixel).norm(), 0.01);
  }
}

TEST(RawPicture, DrawsTheBorderOfThePicture) {
  const sensor_msgs::CameraInfo info = eurocInfo();
  const ShownLines shown = shownOver(info, {}, true);
  ASSERT_EQ(shown.lines.size(), 8U);
  EXPECT_LT((inCameraDisplay(info, shown.lines[0].start) - Eigen::Vector2d(-0.5, -0.5)).norm(), 0.01);
  EXPECT_LT((inCameraDisplay(info, shown.lines[4].start) - Eigen::Vector2d(751.5, 479.5)).norm(), 0.01);
  EXPECT_LT(shown.lines[1].start.norm(), 1e-6F) << "from where the picture is seen";
}

TEST(RawPicture, DrawsLinesWithoutNormalizedEndsStraightBetweenTheirPixels) {
  const sensor_msgs::CameraInfo info = eurocInfo();
  Line line = lineOf(*chooseCamera(info).camera, {10, 20}, {700, 30});
  ASSERT_GE(shownOver(info, {line}).lines.at(0).between.size(), 8U);
  line.end_normalized = {std::nan(""), std::nan("")};
  const ShownLines shown = shownOver(info, {line});
  ASSERT_EQ(shown.lines.size(), 1U);
  EXPECT_EQ(shown.without_place, 0U);
  EXPECT_TRUE(shown.lines[0].between.empty());
  EXPECT_LT((inCameraDisplay(info, shown.lines[0].end) - Eigen::Vector2d(700, 30)).norm(), 0.01);
}

TEST(RawPicture, GivesFinitePointsForEveryPixelOfALensThatSeesBehindItself) {
  const sensor_msgs::CameraInfo info = fisheyeInfo();
  const std::shared_ptr<const CameraModel> camera = chooseCamera(info).camera;
  // From beyond 90 degrees at a corner to another and to the middle; far outside of what the model knows.
  const std::vector<Eigen::Vector2f> pixels{{20, 50}, {490, 50}, {255, 257}, {511, 511}, {-3e4F, 1e30F}};
  ASSERT_LT(camera->unproject({20, 50})->z(), 0.0) << "the ray does not meet the plane";
  std::size_t bent = 0;
  for (const Eigen::Vector2f& start : pixels) {
    for (const Eigen::Vector2f& end : pixels) {
      Line line = lineOf(*camera, start, end);
      // As another model may have normalized them.
      line.start_normalized = {-1e9, 1.0};
      line.end_normalized = {1.0, 1e9};
      const ShownLines shown = shownOver(info, {line});
      ASSERT_EQ(shown.lines.size(), 1U);
      EXPECT_TRUE(shown.lines[0].start.allFinite() && shown.lines[0].end.allFinite());
      for (const Eigen::Vector3f& point : shown.lines[0].between) EXPECT_TRUE(point.allFinite());
      bent += shown.lines[0].between.empty() ? 0 : 1;
    }
  }
  EXPECT_GT(bent, 0U);
  Line line = lineOf(*camera, pixels[0], pixels[1]);
  line.start_px[0] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(shownOver(info, {line}).without_place, 1U);
}

TEST(RawPicture, TheTrailFollowsThePixelsToo) {
  const sensor_msgs::CameraInfo info = eurocInfo();
  const std::shared_ptr<const CameraModel> camera = chooseCamera(info).camera;
  const auto imageOf = [&](float x) {
    auto message = boost::make_shared<LineArray>();
    message->lines = {lineOf(*camera, {x, 20}, {x, 400})};
    return PosedLines{message, Eigen::Isometry3d::Identity()};
  };
  LineArrayStyle style;
  style.trail = 1;
  style.raw = pictureOf(info);
  const ShownLines shown = showLines({imageOf(50), imageOf(60)}, style);
  ASSERT_EQ(shown.lines.size(), 3U);
  EXPECT_LT((inCameraDisplay(info, shown.lines[1].start) - Eigen::Vector2d(50, 20)).norm(), 0.01);
  EXPECT_LT((inCameraDisplay(info, shown.lines[2].end) - Eigen::Vector2d(60, 400)).norm(), 0.01);
}

TEST(RawPicture, SaysWhyThereIsNone) {
  sensor_msgs::CameraInfo info = eurocInfo();
  EXPECT_EQ(chooseRawPicture(info, 640, 480).problem,
            "camera_info is for images of 752x480, the images have 640x480");
  info.P[0] = 0.0;
  EXPECT_EQ(chooseRawPicture(info, 752, 480).problem,
            "P of camera_info is zero or not finite: the Camera display of rviz needs it");
  info = sensor_msgs::CameraInfo();
  EXPECT_NE(chooseRawPicture(info, 752, 480).problem, "");
  EXPECT_EQ(chooseRawPicture(info, 752, 480).picture, nullptr);
}

}  // namespace
}  // namespace tet_line_tracker
