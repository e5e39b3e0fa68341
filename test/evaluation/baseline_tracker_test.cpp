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

class EveryBaseline : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    const auto detectors = availableDetectors();
    if (std::find(detectors.begin(), detectors.end(), "lsd") == detectors.end()) {
      GTEST_SKIP() << "LSD does not work with this OpenCV";
    }
    const auto names = baselineNames();
    if (std::find(names.begin(), names.end(), GetParam()) == names.end()) {
      GTEST_SKIP() << "not part of this build";
    }
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
                         testing::Values("lsd_lbd_knn", "lsd_remapped", "lk_endpoints"));

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

TEST(LsdRemapped, SeesStraightWhatTheLensBends) {
  const auto names = baselineNames();
  if (std::find(names.begin(), names.end(), "lsd_remapped") == names.end())
    GTEST_SKIP() << "not part of this build";
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

TEST(MakeBaselineTracker, NamesWhatThereIs) {
  try {
    makeBaselineTracker("nonesuch", LineTrackerParameters{});
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("lk_endpoints"), std::string::npos);
  }
}

}  // namespace
}  // namespace tet_line_tracker
