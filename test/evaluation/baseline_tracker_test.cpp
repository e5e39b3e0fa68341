#include "evaluation/baselines/baseline_tracker.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "evaluation/baselines/chord_camera.h"
#include "evaluation/baselines/edge_drawing_detector.h"
#include "evaluation/line_rules.h"
#include "tet_line_tracker/camera/lens_bend.h"
#include "tet_line_tracker/detection/line_detector.h"

namespace tet_line_tracker {
namespace {

constexpr int kImages = 12;

/// Gray boxes before a gray ground, moved by `shift` px; smooth like a real lens makes them.
cv::Mat boxes(double shift) {
  constexpr double kFine = 16.0;
  constexpr int kShiftBits = 4;
  cv::Mat image(240, 320, CV_8UC1, cv::Scalar(110));
  cv::RNG random(5);
  for (int i = 0; i < 14; ++i) {
    const cv::Point2d corner(random.uniform(10.0, 230.0), random.uniform(10.0, 170.0));
    const cv::Point2d size(random.uniform(35.0, 70.0), random.uniform(35.0, 60.0));
    const cv::Point2d move(shift, 0.5 * shift);
    const cv::Point from((corner + move) * kFine);
    const cv::Point to((corner + size + move) * kFine);
    cv::rectangle(image, from, to, cv::Scalar(random.uniform(20, 235)), cv::FILLED, cv::LINE_AA, kShiftBits);
  }
  cv::GaussianBlur(image, image, {5, 5}, 0.8);
  return image;
}

/// A wall of crooked boxes with a grain of their own, turned, moved and brought nearer from image to image.
class MovingWall {
 public:
  MovingWall() : wall_(kSize, CV_8UC1, cv::Scalar(110)) {
    cv::RNG random(11);
    for (int i = 0; i < 30; ++i) {
      const cv::Point2f centre(random.uniform(0.0F, 480.0F), random.uniform(0.0F, 360.0F));
      const cv::Size2f size(random.uniform(40.0F, 110.0F), random.uniform(40.0F, 110.0F));
      cv::Point2f corners[4];
      cv::RotatedRect(centre, size, random.uniform(0.0F, 90.0F)).points(corners);
      const std::vector<cv::Point> box(corners, corners + 4);
      cv::fillConvexPoly(wall_, box, cv::Scalar(random.uniform(20, 235)));
    }
    cv::Mat grain(45, 60, CV_8UC1);
    random.fill(grain, cv::RNG::UNIFORM, 0, 30);
    cv::resize(grain, grain, kSize, 0.0, 0.0, cv::INTER_CUBIC);
    cv::addWeighted(wall_, 0.8, grain, 1.0, 0.0, wall_);
    cv::GaussianBlur(wall_, wall_, {5, 5}, 0.8);
  }

  cv::Mat image(int k) const {
    cv::Mat image;
    cv::warpAffine(wall_, image, cv::Mat(motion(k)), kSize, cv::INTER_LINEAR, cv::BORDER_REFLECT);
    return image;
  }
  /// Where a line of the image before is in image k.
  LineSegment moved(const LineSegment& line, int k) const {
    cv::Matx23d back;
    cv::invertAffineTransform(motion(k - 1), back);
    const auto move = [&](const Eigen::Vector2f& p) {
      const cv::Vec2d wall = back * cv::Vec3d(p.x(), p.y(), 1.0);
      const cv::Vec2d now = motion(k) * cv::Vec3d(wall[0], wall[1], 1.0);
      return Eigen::Vector2f(static_cast<float>(now[0]), static_cast<float>(now[1]));
    };
    return {move(line.start), move(line.end)};
  }

 private:
  static cv::Matx23d motion(int k) {
    const double angle = 0.01 * k;
    const double scale = std::pow(1.005, k);
    const double c = scale * std::cos(angle);
    const double s = scale * std::sin(angle);
    const cv::Vec2d centre(240.0, 180.0);
    return {c, -s, centre[0] - c * centre[0] + s * centre[1] + 1.5 * k,
            s, c,  centre[1] - s * centre[0] - c * centre[1] - 0.8 * k};
  }

  const cv::Size kSize{480, 360};
  cv::Mat wall_;
};

bool liesOn(const LineSegment& expected, const LineSegment& found) {
  return angleBetween(found, expected) < 0.1F && overlap(found, expected) > 0.3F &&
         std::abs(expected.distance(found.start)) < 2.5F && std::abs(expected.distance(found.end)) < 2.5F;
}

bool isPartOfThisBuild(const std::string& name) {
  const std::vector<std::string> names = baselineNames();
  return std::find(names.begin(), names.end(), name) != names.end();
}

class EveryBaseline : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    if (!isPartOfThisBuild(GetParam())) GTEST_SKIP() << "not part of this build";
    baseline = makeBaselineTracker(GetParam(), LineTrackerParameters{});
  }

  std::unique_ptr<BaselineTracker> baseline;
};

TEST_P(EveryBaseline, FollowsMovingBoxesAndKeepsTheRules) {
  LineRules rules(30.0);
  std::size_t kept = 0;
  std::size_t before = 0;
  std::size_t misplaced = 0;
  std::vector<TrackedLine> last;
  for (int k = 0; k < kImages; ++k) {
    const LineFrame* frame = baseline->process(boxes(1.5 * k), 1000000000 + 50000000LL * k).frame;
    ASSERT_NE(frame, nullptr);
    EXPECT_GE(frame->lines.size(), 10U);
    rules.add(*frame);
    before += frame->statistics.tracks_before;
    kept += frame->statistics.tracks_kept;
    for (const TrackedLine& line : frame->lines) {
      const auto same = std::find_if(last.begin(), last.end(),
                                     [&line](const TrackedLine& other) { return other.id == line.id; });
      if (same == last.end()) continue;
      const Eigen::Vector2f there = same->segment.middle() + Eigen::Vector2f(1.5F, 0.75F);
      if (std::abs(line.segment.distance(there)) > 1.0F) ++misplaced;
    }
    last = frame->lines;
  }
  for (const auto& [rule, violation] : rules.violations()) ADD_FAILURE() << rule << ": " << violation.first;
  EXPECT_GT(before, 100U);
  EXPECT_GT(kept, before * 6 / 10);
  EXPECT_LT(misplaced, before / 10);  // flat boxes look alike to a descriptor
}

TEST_P(EveryBaseline, FindsMostLinesAgainAndHardlyAWrongOne) {
  const MovingWall wall;
  std::size_t before = 0;
  std::size_t found = 0;
  std::size_t right = 0;
  std::vector<TrackedLine> last;
  for (int k = 0; k < kImages; ++k) {
    const LineFrame* frame = baseline->process(wall.image(k), 1000000000 + 50000000LL * k).frame;
    ASSERT_NE(frame, nullptr);
    for (const TrackedLine& old : last) {
      ++before;
      const auto now = std::find_if(frame->lines.begin(), frame->lines.end(),
                                    [&old](const TrackedLine& line) { return line.id == old.id; });
      if (now == frame->lines.end()) continue;
      ++found;
      right += liesOn(wall.moved(old.segment, k), now->segment);
    }
    last = frame->lines;
  }
  EXPECT_GT(before, 400U);
  EXPECT_GT(found, before * 8 / 10);
  EXPECT_GT(right, found * 98 / 100);
}

TEST_P(EveryBaseline, StartsAnEpochWhenTheStreamJumpsAndDropsDuplicates) {
  ASSERT_NE(baseline->process(boxes(0.0), 1000000000).frame, nullptr);
  EXPECT_EQ(baseline->process(boxes(0.0), 1000000000).frame, nullptr);
  const LineFrame* frame = baseline->process(boxes(0.0), 900000000000).frame;
  ASSERT_NE(frame, nullptr);
  EXPECT_EQ(frame->epoch, 1U);
  EXPECT_EQ(frame->image_count, 1U);
  for (const TrackedLine& line : frame->lines) EXPECT_EQ(line.age, 1U);
}

TEST_P(EveryBaseline, GoesThroughAnImageWithoutLines) {
  const cv::Mat nothing(240, 320, CV_8UC1, cv::Scalar(90));
  ASSERT_NE(baseline->process(boxes(0.0), 1000000000).frame, nullptr);
  EXPECT_TRUE(baseline->process(nothing, 1050000000).frame->lines.empty());
  EXPECT_FALSE(baseline->process(boxes(0.0), 1100000000).frame->lines.empty());
}

INSTANTIATE_TEST_SUITE_P(Baselines, EveryBaseline,
                         testing::Values("lsd_lbd_knn", "ed_lbd_knn", "fld_lbd_knn", "lsd_remapped",
                                         "lk_endpoints"));

using EveryDescriptorBaseline = EveryBaseline;

TEST_P(EveryDescriptorBaseline, FindsLinesAgainAfterAQuarterTurn) {
  const cv::Mat image = MovingWall().image(0)(cv::Rect(60, 0, 360, 360)).clone();
  cv::Mat turned;
  cv::rotate(image, turned, cv::ROTATE_90_CLOCKWISE);
  const std::vector<TrackedLine> before = baseline->process(image, 1000000000).frame->lines;
  const LineFrame* frame = baseline->process(turned, 1050000000).frame;
  const auto turn = [](const Eigen::Vector2f& p) { return Eigen::Vector2f(359.0F - p.y(), p.x()); };
  std::size_t right = 0;
  for (const TrackedLine& old : before) {
    const LineSegment expected{turn(old.segment.start), turn(old.segment.end)};
    right += std::any_of(frame->lines.begin(), frame->lines.end(), [&](const TrackedLine& line) {
      return line.id == old.id && liesOn(expected, line.segment);
    });
  }
  EXPECT_GT(before.size(), 20U);
  EXPECT_GT(right, before.size() * 8 / 10);
  EXPECT_GT(right, frame->statistics.tracks_kept * 9U / 10U);
}

INSTANTIATE_TEST_SUITE_P(Baselines, EveryDescriptorBaseline,
                         testing::Values("lsd_lbd_knn", "ed_lbd_knn", "fld_lbd_knn"));

/// A dark bar in space, as EuRoC's lens bends it.
class BentBar {
 public:
  BentBar() {
    CameraCalibration calibration;
    calibration.model = "plumb_bob";
    calibration.width = 752;
    calibration.height = 480;
    calibration.fx = calibration.fy = 458.0;
    calibration.cx = 367.0;
    calibration.cy = 248.0;
    calibration.distortion = {-0.28, 0.07, 0.0, 0.0};
    camera = makeCameraModel(calibration);
    image = cv::Mat(480, 752, CV_8UC1);
    for (int y = 0; y < image.rows; ++y) {
      for (int x = 0; x < image.cols; ++x) {
        const Eigen::Vector2d point = *camera->normalize({static_cast<double>(x), static_cast<double>(y)});
        const double dark = std::erf((point.y() - kTop) * 400.0) - std::erf((point.y() - kBottom) * 400.0);
        image.at<std::uint8_t>(y, x) = cv::saturate_cast<std::uint8_t>(160.0 - 50.0 * dark);
      }
    }
  }

  /// Distance of the worse undistorted end from the nearer edge, of the longest line [px].
  double errorOf(BaselineTracker& tracker) const {
    tracker.setCamera(camera);
    const LineFrame* frame = tracker.process(image, 1000000000).frame;
    const auto longer = [](const TrackedLine& a, const TrackedLine& b) {
      return a.segment.length() < b.segment.length();
    };
    const auto longest = std::max_element(frame->lines.begin(), frame->lines.end(), longer);
    if (longest == frame->lines.end() || longest->segment.length() < 150.0F) return std::nan("");
    double worst = 0.0;
    for (const Eigen::Vector2d& end : {longest->start_normalized, longest->end_normalized}) {
      worst = std::max(worst, 458.0 * std::min(std::abs(end.y() - kTop), std::abs(end.y() - kBottom)));
    }
    return worst;
  }

  static constexpr double kTop = -0.42;
  static constexpr double kBottom = -0.36;
  std::shared_ptr<const CameraModel> camera;
  cv::Mat image;
};

TEST(RemappedLbdKnn, SeesStraightWhatTheLensBends) {
  if (!isPartOfThisBuild("lsd_remapped")) GTEST_SKIP() << "not part of this build";
  const BentBar bar;
  const double remapped = bar.errorOf(*makeBaselineTracker("lsd_remapped", LineTrackerParameters{}));
  const double bent = bar.errorOf(*makeBaselineTracker("lsd_lbd_knn", LineTrackerParameters{}));
  EXPECT_LT(remapped, 0.2);
  EXPECT_GT(bent, 0.5);
}

TEST(ChordCamera, BendsNoLineAndProjectsAsTheLensDoes) {
  const BentBar bar;
  const auto chords = asChordCamera(bar.camera);
  EXPECT_FALSE(LensBend(bar.camera, 752, 480).isStraight());
  EXPECT_TRUE(LensBend(chords, 752, 480).isStraight());
  const Eigen::Vector2d pixel(40.0, 30.0);
  EXPECT_EQ(*chords->unproject(pixel), *bar.camera->unproject(pixel));
  EXPECT_EQ(*chords->project({0.5, -0.3, 1.0}), *bar.camera->project({0.5, -0.3, 1.0}));
  EXPECT_EQ(asChordCamera(nullptr), nullptr);
}

TEST(EdgeDrawingDetector, FindsTheFourSidesOfASquareWithTheBrighterSideToTheLeft) {
  const auto detector = makeEdgeDrawingDetector();
  if (!detector) GTEST_SKIP() << "not part of this OpenCV";
  for (const bool bright_square : {true, false}) {
    cv::Mat image(160, 200, CV_8UC1, cv::Scalar(bright_square ? 50 : 200));
    image(cv::Rect(60, 40, 80, 80)).setTo(bright_square ? 200 : 50);
    std::vector<LineSegment> lines;
    detector->detect(image, 50.0F, lines);
    ASSERT_EQ(lines.size(), 4U);
    for (const LineSegment& line : lines) {
      // Gray changes half-way between two pixels, of which the detector takes one.
      EXPECT_NEAR(std::abs(line.distance({99.5F, 79.5F})), 40.0F, 0.6F);
      EXPECT_EQ(line.distance({99.5F, 79.5F}) > 0.0F, bright_square);
    }
  }
}

TEST(EdgeDrawingDetector, TakesImagesOfAnySizeAndStride) {
  const auto detector = makeEdgeDrawingDetector();
  if (!detector) GTEST_SKIP() << "not part of this OpenCV";
  std::vector<LineSegment> lines;
  const cv::Mat image = MovingWall().image(0);
  for (int side = 1; side < 40; ++side) detector->detect(image(cv::Rect(100, 90, side, side)), 5.0F, lines);
  const cv::Rect part(31, 17, 300, 200);
  std::vector<LineSegment> of_copy;
  detector->detect(image(part).clone(), 30.0F, of_copy);
  detector->detect(image(part), 30.0F, lines);
  EXPECT_GT(lines.size(), 5U);
  ASSERT_EQ(lines.size(), of_copy.size());
  for (std::size_t i = 0; i < lines.size(); ++i) EXPECT_EQ(lines[i].start, of_copy[i].start);
}

TEST(MakeBaselineTracker, SaysWhichPartOfOpenCvIsMissing) {
  for (const char* const name :
       {"lsd_lbd_knn", "ed_lbd_knn", "fld_lbd_knn", "lsd_remapped", "lk_endpoints"}) {
    if (isPartOfThisBuild(name)) continue;
    try {
      makeBaselineTracker(name, LineTrackerParameters{});
      ADD_FAILURE() << name;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find("OpenCV " CV_VERSION " came without cv::"), std::string::npos);
    }
  }
}

TEST(MakeBaselineTracker, NamesWhatThereIs) {
  try {
    makeBaselineTracker("nonesuch", LineTrackerParameters{});
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("it has tet"), std::string::npos);
  }
}

}  // namespace
}  // namespace tet_line_tracker
