#include "geometry/so3.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "geometry/clamp.h"

namespace tet_line_tracker {
namespace {

TEST(So3, ExpRotatesAboutTheVectorByItsLength) {
  const Eigen::Matrix3d quarter = so3Exp({0.0, 0.0, 0.5 * M_PI}).toRotationMatrix();
  EXPECT_LT((quarter * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(), 1e-12);
  EXPECT_EQ(so3Exp({0.0, 0.0, 0.0}).toRotationMatrix(), Eigen::Matrix3d::Identity());
}

TEST(So3, LogUndoesExp) {
  for (const Eigen::Vector3d& vector : {Eigen::Vector3d(0.1, -0.2, 0.3), Eigen::Vector3d(1e-9, 0.0, 2e-9),
                                        Eigen::Vector3d(0.0, 3.0, 0.0), Eigen::Vector3d(0.0, 0.0, 0.0)}) {
    EXPECT_LT((so3Log(so3Exp(vector).toRotationMatrix()) - vector).norm(), 1e-8) << vector.transpose();
  }
}

TEST(ClampOrLow, HoldsEveryFloatInItsRange) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  EXPECT_EQ(clampOrLow(2.5F, 1.0F, 4.0F), 2.5F);
  EXPECT_EQ(clampOrLow(-1e30F, 1.0F, 4.0F), 1.0F);
  EXPECT_EQ(clampOrLow(-kInfinity, 1.0F, 4.0F), 1.0F);
  EXPECT_EQ(clampOrLow(1e30F, 1.0F, 4.0F), 4.0F);
  EXPECT_EQ(clampOrLow(kInfinity, 1.0F, 4.0F), 4.0F);
  EXPECT_EQ(clampOrLow(std::numeric_limits<float>::quiet_NaN(), 1.0F, 4.0F), 1.0F);
}

}  // namespace
}  // namespace tet_line_tracker
