#include "tet_line_tracker/display/track_painter.h"

#include <gtest/gtest.h>
#include <stdexcept>

#include "bent_edge.h"
#include "tet_line_tracker/camera/lens_bend.h"

namespace tet_line_tracker {
namespace {

LineFrame frameOf(int width, int height, std::vector<TrackedLine> lines) {
  LineFrame frame;
  frame.epoch = 1;
  frame.width = width;
  frame.height = height;
  frame.lines = std::move(lines);
  return frame;
}

TrackedLine lineOf(std::uint64_t id, std::uint32_t age, Eigen::Vector2f start, Eigen::Vector2f end) {
  TrackedLine line;
  line.id = id;
  line.age = age;
  line.segment = {start, end};
  return line;
}

TEST(TrackPainter, GoesFromRedToBlueWithTheAge) {
  const auto young = colourOfAge(1);
  const auto old = colourOfAge(kOldestColouredAge);
  EXPECT_GT(young[0], 2 * young[2]);
  EXPECT_GT(old[2], 2 * old[0]);
  EXPECT_EQ(colourOfAge(0), young);
  EXPECT_EQ(colourOfAge(1'000'000), old);
  EXPECT_NE(colourOfAge(2), young);
}

TEST(TrackPainter, PaintsOnTheLineInTheColourOfItsAge) {
  TrackPainter painter({0, false, false});
  const cv::Mat gray(120, 160, CV_8UC1, cv::Scalar(100));
  cv::Mat bgr;
  painter.paint(gray, frameOf(160, 120, {lineOf(1, 1, {20, 60}, {140, 60})}), bgr);
  const auto colour = colourOfAge(1);
  const cv::Vec3b on = bgr.at<cv::Vec3b>(60, 80);
  EXPECT_NEAR(on[0], 255 * colour[2], 40);
  EXPECT_NEAR(on[1], 255 * colour[1], 40);
  EXPECT_NEAR(on[2], 255 * colour[0], 40);
  EXPECT_EQ(bgr.at<cv::Vec3b>(70, 80), cv::Vec3b(100, 100, 100));
}

TEST(TrackPainter, PaintsTheCurveIntoWhichTheLensBendsTheLine) {
  TrackPainter painter({0, false, false});
  const cv::Vec3b ground(100, 100, 100);
  const cv::Mat gray(480, 752, CV_8UC1, cv::Scalar(100));
  const LineFrame frame = frameOf(752, 480, {lineOf(1, 1, {100, 60}, {650, 60})});
  const cv::Point on_chord(375, 60);
  const Eigen::Vector2f curve = LensBend(eurocCamera(), 752, 480).curve(frame.lines[0].segment).at(0.5F);
  const cv::Point on_curve(cvRound(curve.x()), cvRound(curve.y()));
  ASSERT_GT(cv::norm(on_curve - on_chord), 8.0);

  cv::Mat bgr;
  painter.setCamera(eurocCamera());
  painter.paint(gray, frame, bgr);
  EXPECT_NE(bgr.at<cv::Vec3b>(on_curve), ground);
  EXPECT_EQ(bgr.at<cv::Vec3b>(on_chord), ground);

  painter.setCamera(nullptr);
  painter.paint(gray, frame, bgr);
  EXPECT_EQ(bgr.at<cv::Vec3b>(on_curve), ground);
  EXPECT_NE(bgr.at<cv::Vec3b>(on_chord), ground);
}

TEST(TrackPainter, ShowsTheWayOfTheEndpointsWithinAnEpoch) {
  TrackPainter painter({12, false, false});
  const cv::Mat gray(120, 160, CV_8UC1, cv::Scalar(100));
  cv::Mat bgr;
  painter.paint(gray, frameOf(160, 120, {lineOf(1, 1, {20, 20}, {20, 100})}), bgr);
  LineFrame second = frameOf(160, 120, {lineOf(1, 2, {80, 20}, {80, 100})});
  painter.paint(gray, second, bgr);
  EXPECT_NE(bgr.at<cv::Vec3b>(20, 50), cv::Vec3b(100, 100, 100));
  EXPECT_EQ(bgr.at<cv::Vec3b>(60, 50), cv::Vec3b(100, 100, 100));

  second.epoch = 2;  // the same id is another line now
  painter.paint(gray, second, bgr);
  EXPECT_EQ(bgr.at<cv::Vec3b>(20, 50), cv::Vec3b(100, 100, 100));
}

TEST(TrackPainter, PaintsIntoTheMemoryItIsGiven) {
  TrackPainter painter;
  const cv::Mat gray(480, 752, CV_8UC1, cv::Scalar(100));
  cv::Mat bgr(480, 752, CV_8UC3);
  const std::uint8_t* memory = bgr.data;
  painter.paint(gray, frameOf(752, 480, {lineOf(1, 30, {-50, 20}, {900, 470})}), bgr);
  EXPECT_EQ(bgr.data, memory);
}

TEST(TrackPainter, LeavesTheGivenImageAlone) {
  TrackPainter painter;
  const cv::Mat gray(240, 376, CV_8UC1, cv::Scalar(100));
  cv::Mat bgr;
  painter.paint(gray, frameOf(376, 240, {lineOf(1, 1, {20, 20}, {200, 100})}), bgr);
  EXPECT_EQ(cv::countNonZero(gray != 100), 0);
}

TEST(TrackPainter, RefusesAnImageOfAnotherSize) {
  TrackPainter painter;
  cv::Mat bgr;
  EXPECT_THROW(painter.paint(cv::Mat(10, 10, CV_8UC1), frameOf(20, 10, {}), bgr), std::invalid_argument);
  EXPECT_THROW(painter.paint(cv::Mat(10, 20, CV_8UC3), frameOf(20, 10, {}), bgr), std::invalid_argument);
}

}  // namespace
}  // namespace tet_line_tracker
