#include "tet_line_tracker/display/track_painter.h"

#include <gtest/gtest.h>
#include <stdexcept>

#include "bent_edge.h"
#include "display/drawing.h"
#include "display/legend.h"
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
  TrackPainter painter({0, false, false, false});
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
  TrackPainter painter({0, false, false, false});
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
  TrackPainter painter({12, false, false, false});
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

/// Pixels that differ between two paintings of the same frame.
int difference(const TrackPainter::Style& style, const TrackPainter::Style& other, const LineFrame& frame,
               const cv::Rect& area) {
  const cv::Mat gray(frame.height, frame.width, CV_8UC1, cv::Scalar(100));
  cv::Mat one, two, apart;
  TrackPainter(style).paint(gray, frame, one);
  TrackPainter(other).paint(gray, frame, two);
  cv::absdiff(one(area), two(area), apart);
  return cv::countNonZero(apart.reshape(1));
}

TEST(TrackPainter, WritesIdsOfTheOldestWhereThereIsNotRoomForAll) {
  // A row of lines so near to each other that ids have room beside the upper- and the lowermost only.
  std::vector<TrackedLine> lines;
  for (int i = 0; i < 12; ++i) {
    const auto y = static_cast<float>(100 + 5 * i);
    lines.push_back(lineOf(1U + static_cast<unsigned>(i), i == 11 ? 90U : 3U, {100, y}, {300, y}));
  }
  const TrackPainter::Style with{0, true, false, false};
  const TrackPainter::Style without{0, false, false, false};
  const LineFrame frame = frameOf(752, 480, lines);
  EXPECT_GT(difference(with, without, frame, {100, 155, 200, 25}), 20);
  EXPECT_GT(difference(with, without, frame, {100, 80, 200, 20}), 20);
  EXPECT_EQ(difference(with, without, frame, {90, 102, 220, 51}), 0);

  // Where two lines want the same room, the older one has it, whatever their order.
  const auto short_line = [](std::uint64_t id, std::uint32_t age, float y) {
    return lineOf(id, age, {100, y}, {108, y});
  };
  const LineFrame old_first = frameOf(752, 480, {short_line(1, 50, 100), short_line(88888888, 2, 101)});
  const LineFrame old_last = frameOf(752, 480, {short_line(88888888, 2, 101), short_line(1, 50, 100)});
  cv::Mat first, last, apart;
  const cv::Mat gray(480, 752, CV_8UC1, cv::Scalar(100));
  TrackPainter(with).paint(gray, old_first, first);
  TrackPainter(with).paint(gray, old_last, last);
  cv::absdiff(first({0, 80, 752, 18}), last({0, 80, 752, 18}), apart);
  EXPECT_EQ(cv::countNonZero(apart.reshape(1)), 0);
}

TEST(TrackPainter, ShowsWhatTheImageBeforeHadAndThisOneLacks) {
  const cv::Vec3b ground(100, 100, 100);
  const cv::Mat gray(120, 160, CV_8UC1, cv::Scalar(100));
  const TrackedLine stays = lineOf(1, 1, {20, 20}, {140, 20});
  const TrackedLine goes = lineOf(2, 1, {20, 60}, {140, 60});
  const auto painted = [&](std::uint64_t count, std::uint32_t epoch, bool lost) {
    TrackPainter painter({0, false, false, lost});
    cv::Mat bgr;
    LineFrame frame = frameOf(160, 120, {stays, goes});
    frame.image_count = 7;
    painter.paint(gray, frame, bgr);
    frame = frameOf(160, 120, {stays});
    frame.image_count = count;
    frame.epoch = epoch;
    painter.paint(gray, frame, bgr);
    int marked = 0;
    for (int x = 20; x < 140; ++x) marked += bgr.at<cv::Vec3b>(60, x) != ground ? 1 : 0;
    return marked;
  };
  EXPECT_GT(painted(8, 1, true), 40);
  EXPECT_LT(painted(8, 1, true), 118) << "dashes have gaps";
  EXPECT_EQ(painted(8, 1, false), 0);
  EXPECT_EQ(painted(9, 1, true), 0) << "another image was in between";
  EXPECT_EQ(painted(8, 2, true), 0) << "of another epoch";
}

/// The image after one with `lines`, all of which are lost for these reasons, on an even ground.
cv::Mat paintedLosses(const std::vector<TrackedLine>& lines, const std::vector<LostLine>& lost, int ground,
                      const std::vector<TrackedLine>& remaining = {}, bool ids = false) {
  const cv::Mat gray(480, 752, CV_8UC1, cv::Scalar(ground));
  TrackPainter painter({0, ids, false, true});
  cv::Mat bgr;
  LineFrame frame = frameOf(752, 480, lines);
  frame.lines.insert(frame.lines.end(), remaining.begin(), remaining.end());
  frame.image_count = 7;
  painter.paint(gray, frame, bgr);
  frame.lines = remaining;
  frame.lost = lost;
  frame.image_count = 8;
  painter.paint(gray, frame, bgr);
  return bgr;
}

int differing(const cv::Mat& one, const cv::Mat& two, const cv::Rect& area) {
  cv::Mat apart;
  cv::absdiff(one(area), two(area), apart);
  return cv::countNonZero(apart.reshape(1));
}

TEST(TrackPainter, WritesBesideALostLineWhyItWasLost) {
  const std::vector<TrackedLine> lines{lineOf(3, 9, {100, 200}, {400, 200})};
  const std::vector<LostLine> support{{3, LossReason::kSupport}};
  const cv::Rect beside(150, 180, 200, 40);
  const cv::Mat unknown = paintedLosses(lines, {}, 100);
  const cv::Mat known = paintedLosses(lines, support, 100);
  EXPECT_GT(differing(known, unknown, beside), 100);
  EXPECT_GT(differing(known, paintedLosses(lines, {{3, LossReason::kAngle}}, 100), beside), 100);
  // With ids or without.
  EXPECT_EQ(differing(known, paintedLosses(lines, support, 100, {}, true), {0, 0, 752, 480}), 0);
  // Of another line.
  EXPECT_EQ(differing(unknown, paintedLosses(lines, {{4, LossReason::kSupport}}, 100), {0, 0, 752, 480}), 0);
}

TEST(TrackPainter, AReasonCanBeReadOnDarkAndOnBrightGround) {
  const std::vector<TrackedLine> lines{lineOf(3, 9, {100, 200}, {400, 200})};
  for (const int ground : {0, 128, 255}) {
    const cv::Mat bgr = paintedLosses(lines, {{3, LossReason::kSupport}}, ground);
    const cv::Mat unknown = paintedLosses(lines, {}, ground);
    int coloured = 0;
    int dark = 0;
    for (int y = 180; y < 220; ++y) {
      for (int x = 150; x < 350; ++x) {
        const cv::Vec3b& pixel = bgr.at<cv::Vec3b>(y, x);
        if (pixel == unknown.at<cv::Vec3b>(y, x)) continue;
        const auto reach = [&](const cv::Scalar& colour) {
          return std::abs(pixel[0] - colour[0]) + std::abs(pixel[1] - colour[1]) +
                 std::abs(pixel[2] - colour[2]);
        };
        coloured += reach(kLossColour) < 120 ? 1 : 0;
        dark += reach(cv::Scalar::all(0)) < 150 ? 1 : 0;
      }
    }
    EXPECT_GT(coloured, 40) << ground;
    EXPECT_TRUE(ground == 0 || dark > 40) << ground << ": " << dark << " px of the rim";
  }
}

TEST(TrackPainter, ReasonsOfTheLongestLinesComeFirstAndBeforeIds) {
  // Both want the room above the upper and below the lower line; the lower line is lost for another reason.
  const TrackedLine upper = lineOf(1, 9, {100, 200}, {108, 200});
  const TrackedLine lower = lineOf(2, 9, {96, 203}, {112, 203});
  const std::vector<LostLine> both{{1, LossReason::kSupport}, {2, LossReason::kBorder}};
  const cv::Rect all(0, 0, 752, 480);
  const cv::Mat painted = paintedLosses({upper, lower}, both, 100);
  EXPECT_EQ(differing(painted, paintedLosses({upper, lower}, {both[1], both[0]}, 100), all), 0);
  EXPECT_GT(differing(painted, paintedLosses({upper, lower}, {both[0]}, 100), all), 100);
  // What is written of the longer one alone is there beside the other too.
  const cv::Mat unknown = paintedLosses({upper, lower}, {}, 100);
  const cv::Mat longer = paintedLosses({upper, lower}, {both[1]}, 100);
  int written = 0;
  int kept = 0;
  for (int y = 0; y < 400; ++y) {
    for (int x = 0; x < 752; ++x) {
      if (longer.at<cv::Vec3b>(y, x) == unknown.at<cv::Vec3b>(y, x)) continue;
      ++written;
      kept += painted.at<cv::Vec3b>(y, x) == longer.at<cv::Vec3b>(y, x) ? 1 : 0;
    }
  }
  EXPECT_GT(written, 100);
  EXPECT_EQ(kept, written);

  // A line that stays beside one that is lost: its id has what room is left.
  const TrackedLine stays = lineOf(88888888, 90, {100, 203}, {108, 203});
  const cv::Mat with_id = paintedLosses({upper}, {both[0]}, 100, {stays}, true);
  const cv::Mat without_id = paintedLosses({upper}, {both[0]}, 100, {stays}, false);
  EXPECT_EQ(differing(with_id, without_id, {60, 180, 90, 20}), 0) << "the reason stays where it was";
}

TEST(TrackPainter, SaysInWordsHowManyLinesThereAreHowLongTheyTookAndWhyOthersWereLost) {
  LineFrame frame = frameOf(752, 480, {lineOf(1, 1, {20, 20}, {140, 20})});
  frame.image_count = 7;
  EXPECT_EQ(legendText(frame), "1 lines   image 7   epoch 1");
  EXPECT_EQ(lossText(frame.statistics), "");
  frame.detected = true;
  frame.statistics.total_ms = 0.634;
  frame.statistics.lostFor(LossReason::kSupport) = 3;
  frame.statistics.lostFor(LossReason::kEdgeJump) = 1;
  EXPECT_EQ(legendText(frame), "1 lines   0.63 ms   image 7   epoch 1   detected");
  EXPECT_EQ(lossText(frame.statistics), "4 lost: support 3, edge jump 1");
}

TEST(TrackPainter, PutsTheLegendOnImagesThatAreLargeEnoughAndNothingBelowTheIds) {
  EXPECT_TRUE(legendArea({100, 480}).empty());
  EXPECT_TRUE(legendArea({752, 60}).empty());
  const cv::Rect area = legendArea({752, 480});
  EXPECT_EQ(area.br(), cv::Point(752, 480));
  // A line whose id would lie in the legend if it could.
  const auto y = static_cast<float>(area.y - 4);
  const LineFrame frame = frameOf(752, 480, {lineOf(1, 1, {100, y}, {300, y})});
  EXPECT_EQ(difference({0, true, true, false}, {0, false, true, false}, frame, area), 0);
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
