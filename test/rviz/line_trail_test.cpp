#include "line_trail.h"

#include <cstddef>
#include <cstdint>
#include <string>

#include <gtest/gtest.h>
#include <boost/make_shared.hpp>

namespace tet_line_tracker {
namespace {

LineArray::Ptr imageAt(double stamp_s, std::uint64_t image_count) {
  auto message = boost::make_shared<LineArray>();
  message->header.stamp = ros::Time(stamp_s);
  message->header.frame_id = "cam0";
  message->image_count = image_count;
  return message;
}

/// Trail of three images from 10 s on.
class LineTrailTest : public ::testing::Test {
 protected:
  LineTrailTest() {
    for (std::uint64_t i = 0; i < 3; ++i) add(imageAt(10.0 + 0.05 * static_cast<double>(i), i + 1));
  }

  void add(const LineArray::ConstPtr& message) { trail_.add(message, Eigen::Isometry3d::Identity(), 4); }

  LineTrail trail_;
};

TEST_F(LineTrailTest, KeepsAsManyImagesBeforeTheNewestAsAskedFor) {
  ASSERT_EQ(trail_.images().size(), 3U);
  for (std::uint64_t i = 3; i < 20; ++i) add(imageAt(10.0 + 0.05 * static_cast<double>(i), i + 1));
  ASSERT_EQ(trail_.images().size(), 5U);
  EXPECT_EQ(trail_.images().back().message->image_count, 20U);
  EXPECT_EQ(trail_.images().front().message->image_count, 16U);
  trail_.add(imageAt(11.0, 21), Eigen::Isometry3d::Identity(), 0);
  EXPECT_EQ(trail_.images().size(), 1U);
}

TEST_F(LineTrailTest, ForgetsWhatWasBeforeABagStartedAgain) {
  add(imageAt(10.0, 4));
  EXPECT_EQ(trail_.images().size(), 1U);
}

TEST_F(LineTrailTest, ForgetsWhatWasBeforeATrackerStartedAgain) {
  add(imageAt(10.15, 1));
  EXPECT_EQ(trail_.images().size(), 1U);
}

TEST_F(LineTrailTest, ForgetsWhatWasBeforeANewEpoch) {
  const LineArray::Ptr message = imageAt(10.15, 4);
  message->epoch = 1;
  add(message);
  EXPECT_EQ(trail_.images().size(), 1U);
}

TEST_F(LineTrailTest, ForgetsTheImagesOfAnotherCamera) {
  const LineArray::Ptr message = imageAt(10.15, 4);
  message->header.frame_id = "cam1";
  add(message);
  EXPECT_EQ(trail_.images().size(), 1U);
}

}  // namespace
}  // namespace tet_line_tracker
