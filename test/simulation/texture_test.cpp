#include "simulation/texture.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace tet_line_tracker {
namespace {

/// Mean by brute force of what gray() computes in closed form.
double sampledMean(const Texture& texture, float u, float v, float half_u, float half_v) {
  constexpr int kSteps = 200;
  double sum = 0.0;
  for (int j = 0; j < kSteps; ++j) {
    for (int i = 0; i < kSteps; ++i) {
      const float a = u + half_u * (2.0F * (static_cast<float>(i) + 0.5F) / kSteps - 1.0F);
      const float b = v + half_v * (2.0F * (static_cast<float>(j) + 0.5F) / kSteps - 1.0F);
      sum += static_cast<double>(texture.gray(a, b, PixelWeight::box(0.0F), PixelWeight::box(0.0F)));
    }
  }
  return sum / (kSteps * kSteps);
}

TEST(Texture, GivesTheMeanOverABoxAcrossBricksAndPaint) {
  Texture texture(3.0F, 2.0F, 100.0F);
  BrickPattern bricks;
  bricks.joint = 0.03F;
  texture.setBricks(bricks);
  texture.paint({0.9F, 0.7F, 1.6F, 1.4F, 220.0F});
  for (int i = 0; i < 40; ++i) {
    const float u = 0.3F + 0.055F * static_cast<float>(i);
    const float v = 0.3F + 0.031F * static_cast<float>(i);
    const float half_u = 0.002F + 0.004F * static_cast<float>(i % 7);
    const float half_v = 0.002F + 0.005F * static_cast<float>(i % 5);
    EXPECT_NEAR(sampledMean(texture, u, v, half_u, half_v),
                texture.gray(u, v, PixelWeight::box(half_u), PixelWeight::box(half_v)), 0.6);
  }
}

TEST(Texture, BricksFadeToOneGrayFarAway) {
  Texture texture(40.0F, 40.0F, 100.0F);
  texture.setBricks(BrickPattern());
  float lowest = 255.0F;
  float highest = 0.0F;
  for (int i = 0; i < 300; ++i) {
    const float gray = texture.gray(5.0F + 0.07F * static_cast<float>(i), 20.0F, PixelWeight::box(1.0F),
                                    PixelWeight::box(1.0F));
    lowest = std::min(lowest, gray);
    highest = std::max(highest, gray);
  }
  EXPECT_LT(highest - lowest, 0.5F);
}

TEST(Texture, TellsEdgesOfPaintExceptWhereLaterPaintCoversThem) {
  Texture texture(2.0F, 2.0F, 100.0F);
  texture.paint({0.5F, 0.5F, 1.5F, 1.5F, 50.0F});
  EXPECT_EQ(4U, texture.edges().size());
  texture.paint({1.0F, 0.25F, 1.25F, 0.75F, 150.0F});
  // The lower edge is cut in two; the cover has four edges of its own.
  const std::vector<TextureEdge> edges = texture.edges();
  ASSERT_EQ(9U, edges.size());
  double length = 0.0;
  for (const TextureEdge& edge : edges) length += (edge.end - edge.start).norm();
  EXPECT_NEAR(4.0 - 0.25 + 1.5, length, 1e-6);
}

}  // namespace
}  // namespace tet_line_tracker
