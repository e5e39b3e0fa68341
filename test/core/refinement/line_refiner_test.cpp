#include "tet_line_tracker/refinement/line_refiner.h"

#include <array>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "bent_edge.h"
#include "tet_line_tracker/camera/lens_bend.h"

namespace tet_line_tracker {
namespace {

constexpr int kWidth = 240;
constexpr int kHeight = 200;
constexpr float kSharp = 0.8F;  // width of the edges of a good lens [px]

/// A straight edge through `middle` at `angle` [rad], `contrast` gray levels brighter on the left of its
/// direction, `width` px wide as a lens makes it, with Gaussian noise.
cv::Mat edgeImage(float angle, float contrast, float noise, const Eigen::Vector2f& middle,
                  float width = 1.1F) {
  std::mt19937 generator(5);
  std::normal_distribution<float> normal(0.0F, 1.0F);
  const Eigen::Vector2f left(std::sin(angle), -std::cos(angle));
  cv::Mat image(kHeight, kWidth, CV_8UC1);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const float distance = left.dot(Eigen::Vector2f(static_cast<float>(x), static_cast<float>(y)) - middle);
      const float gray = 100.0F + 0.5F * contrast * std::erf(distance / width) + noise * normal(generator);
      image.at<std::uint8_t>(y, x) = cv::saturate_cast<std::uint8_t>(gray);
    }
  }
  return image;
}

LineSegment along(float angle, float length, const Eigen::Vector2f& middle) {
  const Eigen::Vector2f half = 0.5F * length * Eigen::Vector2f(std::cos(angle), std::sin(angle));
  return {middle - half, middle + half};
}

const Eigen::Vector2f kMiddle(119.3F, 99.6F);

TEST(LineRefiner, PutsALineOnTheEdgeAtAnyAngleToWithinATenthOfAPixel) {
  const LineRefiner refiner(LineRefinerParameters{});
  for (int degrees = 0; degrees < 360; degrees += 15) {
    const float angle = static_cast<float>(degrees) * static_cast<float>(M_PI) / 180.0F;
    const cv::Mat image = edgeImage(angle, 60.0F, 1.0F, kMiddle);
    const LineSegment truth = along(angle, 80.0F, kMiddle);
    LineSegment guess = truth;
    guess.start += 1.4F * truth.normal();
    guess.end += 0.3F * truth.normal();
    const EdgeFit fit = refiner.fit(image, guess, refiner.contrastOf(image, guess));
    EXPECT_GT(fit.support, 0.95F) << degrees;
    EXPECT_LT(std::abs(truth.distance(fit.segment.start)), 0.1F) << degrees;
    EXPECT_LT(std::abs(truth.distance(fit.segment.end)), 0.1F) << degrees;
    EXPECT_GT(fit.sigma_px, 0.0F);
    EXPECT_LT(fit.sigma_px, 0.1F);
    // Start and end move along the normal alone.
    EXPECT_NEAR(fit.segment.length(), truth.length(), 0.5F);
  }
}

TEST(LineRefiner, GivesNoSupportOnAHandfulOfSamples) {
  const LineRefiner refiner(LineRefinerParameters{});
  int without = 0;
  // An edge that ends sooner and sooner under a line as short as lines can be.
  for (int covered = 0; covered <= 12; ++covered) {
    cv::Mat image = edgeImage(0.0F, 60.0F, 0.0F, kMiddle);
    image.colRange(static_cast<int>(kMiddle.x()) - 6 + covered, kWidth).setTo(100);
    const EdgeFit fit = refiner.fit(image, along(0.0F, 12.0F, kMiddle), 20.0F);
    if (fit.support == 0.0F) ++without;
    EXPECT_EQ(fit.support < 0.5F, !(fit.sigma_px > 0.0F)) << covered;
  }
  EXPECT_GE(without, 3);
  EXPECT_LE(without, 10);
}

TEST(LineRefiner, FindsASharpEdgeToATwentiethOfAPixelWhereverItLiesBetweenPixels) {
  const LineRefiner refiner(LineRefinerParameters{});
  for (int tenths = 0; tenths < 10; ++tenths) {
    const Eigen::Vector2f middle(120.0F, 100.0F + 0.1F * static_cast<float>(tenths));
    const cv::Mat image = edgeImage(0.0F, 60.0F, 0.0F, middle, kSharp);
    const LineSegment truth = along(0.0F, 80.0F, middle);
    EXPECT_NEAR(truth.distance(refiner.fit(image, truth, 20.0F).segment.middle()), 0.0F, 0.05F) << tenths;
  }
}

TEST(LineRefiner, TheEdgesOfAStripeOfTwoPixelsMoveApartByLessThanASeventhOfAPixel) {
  const LineRefiner refiner(LineRefinerParameters{});
  for (const float angle : {0.1F, 0.4F, 1.2F, 2.5F}) {
    const Eigen::Vector2f left(std::sin(angle), -std::cos(angle));
    const cv::Mat brighter = edgeImage(angle, 60.0F, 0.0F, kMiddle - left, kSharp);
    const cv::Mat darker = edgeImage(angle, 60.0F, 0.0F, kMiddle + left, kSharp);
    const cv::Mat stripe = brighter - darker + 100;
    for (const float side : {-1.0F, 1.0F}) {
      const LineSegment edge = along(angle, 80.0F, kMiddle + side * left);
      EXPECT_NEAR(edge.distance(refiner.fit(stripe, edge, -20.0F * side).segment.middle()), 0.0F, 0.143F)
          << angle;
    }
  }
}

TEST(LineRefiner, FindsAWeakEdgeInLowLight) {
  const LineRefiner refiner(LineRefinerParameters{});
  const cv::Mat image = edgeImage(0.4F, 10.0F, 1.0F, kMiddle);
  const LineSegment truth = along(0.4F, 80.0F, kMiddle);
  LineSegment guess = truth;
  guess.start += 0.8F * truth.normal();
  const EdgeFit fit = refiner.fit(image, guess, refiner.contrastOf(image, guess));
  EXPECT_GT(fit.support, 0.8F);
  EXPECT_LT(std::abs(truth.distance(fit.segment.middle())), 0.15F);
}

TEST(LineRefiner, AnEdgeOfTheOtherPolarityIsNoSupport) {
  const LineRefiner refiner(LineRefinerParameters{});
  const cv::Mat image = edgeImage(0.4F, 60.0F, 1.0F, kMiddle);
  const LineSegment truth = along(0.4F, 80.0F, kMiddle);
  const float contrast = refiner.contrastOf(image, truth);
  EXPECT_GT(contrast, 5.0F);  // the left side is the brighter one
  EXPECT_GT(refiner.fit(image, truth, contrast).support, 0.95F);
  EXPECT_LT(refiner.fit(image, truth, -contrast).support, 0.3F);
}

TEST(LineRefiner, TheContrastOfAnEdgeIsItsSlopeAndHasItsSign) {
  const LineRefiner refiner(LineRefinerParameters{});
  for (const float contrast : {60.0F, -60.0F}) {
    const cv::Mat image = edgeImage(0.0F, contrast, 0.0F, kMiddle);
    const EdgeFit fit = refiner.fit(image, along(0.0F, 80.0F, kMiddle), contrast / 3.0F);
    EXPECT_GT(fit.support, 0.95F);
    // The slope in the middle of the erf; what is measured over two pixels is less.
    EXPECT_NEAR(fit.contrast / (contrast / (1.1F * std::sqrt(static_cast<float>(M_PI)))), 0.85F, 0.15F);
  }
}

TEST(LineRefiner, AStrongerEdgeOfTheOtherPolarityDoesNotTurnTheContrastOfALine) {
  const LineRefiner refiner(LineRefinerParameters{});
  const LineSegment weak = along(0.4F, 80.0F, kMiddle);
  const Eigen::Vector2f beside = kMiddle - 1.5F * weak.normal();
  const cv::Mat strong = edgeImage(0.4F, 80.0F, 0.0F, beside, kSharp);
  const cv::Mat image = edgeImage(0.4F, 30.0F, 0.0F, kMiddle, kSharp) - strong + 100;
  EXPECT_GT(refiner.contrastOf(image, weak), 5.0F);
}

TEST(LineRefiner, FlatGrayAndNoiseAreNoSupport) {
  const LineRefiner refiner(LineRefinerParameters{});
  const LineSegment line = along(0.7F, 80.0F, kMiddle);
  EXPECT_EQ(refiner.fit(edgeImage(0.7F, 0.0F, 0.0F, kMiddle), line, 10.0F).support, 0.0F);
  EXPECT_LT(refiner.fit(edgeImage(0.7F, 0.0F, 4.0F, kMiddle), line, 20.0F).support, 0.5F);
}

TEST(LineRefiner, ALineOutsideTheImageComesBackWithoutSupport) {
  const LineRefiner refiner(LineRefinerParameters{});
  const cv::Mat image = edgeImage(0.0F, 60.0F, 0.0F, kMiddle);
  const LineSegment outside{{-80.0F, -10.0F}, {-20.0F, -10.0F}};
  EXPECT_EQ(refiner.fit(image, outside, 20.0F).support, 0.0F);
  const LineSegment point{{50.0F, 50.0F}, {50.0F, 50.0F}};
  EXPECT_EQ(refiner.fit(image, point, 20.0F).support, 0.0F);
}

TEST(LineRefiner, PutsBothEndsOfALineThatTheLensBendsOnItsEdge) {
  const auto camera = eurocCamera();
  const LensBend lens(camera, 752, 480);
  const LineRefiner refiner(LineRefinerParameters{});
  for (const LineSegment& truth :
       {LineSegment{{180.0F, 60.0F}, {520.0F, 45.0F}}, LineSegment{{690.0F, 400.0F}, {680.0F, 120.0F}},
        LineSegment{{60.0F, 260.0F}, {170.0F, 40.0F}}, LineSegment{{420.0F, 430.0F}, {330.0F, 440.0F}}}) {
    const BentEdge edge(camera, truth);
    const cv::Mat image = edge.image(60.0F, 1.0F);
    LineSegment guess = truth;
    guess.start += 0.7F * truth.normal();
    guess.end -= 0.4F * truth.normal();
    const LineCurve curve = lens.curve(guess);
    const EdgeFit fit = refiner.fit(image, curve, refiner.contrastOf(image, curve));
    EXPECT_GT(fit.support, 0.95F);
    EXPECT_LT(std::abs(edge.distance(fit.segment.start)), 0.06);
    EXPECT_LT(std::abs(edge.distance(fit.segment.end)), 0.06);
    // A straight line through the same samples is off by a part of the sagitta.
    const float sagitta = std::abs(curve.bend.offset(0.5F));
    const EdgeFit straight = refiner.fit(image, guess, refiner.contrastOf(image, guess));
    if (sagitta > 1.0F) {
      EXPECT_GT(std::abs(edge.distance(straight.segment.start)), 0.4);
    }
  }
}

TEST(LineRefiner, ALineThatIsNowhereComesBackWithoutSupport) {
  const LineRefiner refiner(LineRefinerParameters{});
  const cv::Mat image = edgeImage(0.0F, 60.0F, 0.0F, kMiddle);
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (const float value : {std::numeric_limits<float>::quiet_NaN(), kInfinity, -kInfinity, 1e30F, -1e18F}) {
    for (const LineSegment& line :
         {LineSegment{{value, 99.6F}, {160.0F, 99.6F}}, LineSegment{{80.0F, 99.6F}, {160.0F, value}},
          LineSegment{{value, value}, {value, value}}}) {
      EXPECT_EQ(refiner.contrastOf(image, line), 0.0F) << value;
      EXPECT_EQ(refiner.fit(image, line, 60.0F).support, 0.0F) << value;
    }
  }
}

// Found by fuzzing: beyond the ends of the chord such a bend is no number any more, which
// UndefinedBehaviorSanitizer notices (scripts/sanitize.sh).
TEST(LineRefiner, ALineWhoseBendLeavesTheImageComesBackWithoutSupport) {
  const LineRefiner refiner(LineRefinerParameters{});
  const cv::Mat image = edgeImage(0.0F, 60.0F, 0.0F, kMiddle);
  for (const float c : {9000.0F, -9000.0F}) {
    LineCurve line(LineSegment{{40.0F, 40.0F}, {160.0F, 99.6F}});
    line.bend.c.fill(c);
    EXPECT_EQ(refiner.contrastOf(image, line), 0.0F);
    EXPECT_EQ(refiner.fit(image, line, 60.0F).support, 0.0F);
    EXPECT_EQ(refiner.reachOf(image, line, 60.0F, 10.0F), 0.0F);
  }
}

TEST(LineRefiner, NoiseIsMoreThanHalfOfTheVarianceOfAFaintEdgeAndNothingOfABlur) {
  const LineRefiner refiner(LineRefinerParameters{});
  const LineSegment truth = along(0.3F, 100.0F, kMiddle);
  const auto noiseShares = [&](float contrast, float noise, float width) {
    const cv::Mat image = edgeImage(0.3F, contrast, noise, kMiddle, width);
    const EdgeFit fit = refiner.fit(image, truth, refiner.contrastOf(image, truth));
    return std::array<float, 2>{fit.noise_px[0] / fit.covariance_px[0],
                                fit.noise_px[2] / fit.covariance_px[2]};
  };
  for (const float share : noiseShares(15.0F, 4.0F, 0.6F)) {
    EXPECT_GT(share, 0.5F);
    EXPECT_LT(share, 0.6F);
  }
  for (const float share : noiseShares(80.0F, 0.5F, 2.2F)) EXPECT_LT(share, 0.05F);
}

TEST(LineRefiner, ABlurredEdgeMayBeBesideItsPlaceAlikeAtBothEnds) {
  const LineRefiner refiner(LineRefinerParameters{});
  const LineSegment truth = along(0.3F, 100.0F, kMiddle);
  const auto fitTo = [&](float width) {
    const cv::Mat image = edgeImage(0.3F, 80.0F, 0.5F, kMiddle, width);
    return refiner.fit(image, truth, refiner.contrastOf(image, truth));
  };
  const EdgeFit sharp = fitTo(kSharp);
  const EdgeFit blurred = fitTo(2.2F);
  EXPECT_LT(sharp.sigma_px, 0.02F);
  EXPECT_GT(blurred.sigma_px, 0.15F);
  EXPECT_LT(blurred.sigma_px, 0.6F);
  const auto [start, both, end] = blurred.covariance_px;
  EXPECT_GT(both, 0.4F * std::sqrt(start * end));
}

TEST(LineRefiner, TheCovarianceOfTheEndsIsALittleMoreThanThatOfTheirErrorsFromPureNoise) {
  const LineRefiner refiner(LineRefinerParameters{});
  const LineSegment truth = along(0.4F, 90.0F, kMiddle);
  std::mt19937 generator(11);
  std::normal_distribution<float> normal(0.0F, 1.0F);
  double start_squares = 0.0, end_squares = 0.0;
  constexpr int kTrials = 200;
  const cv::Mat clean = edgeImage(0.4F, 25.0F, 0.0F, kMiddle);
  for (int i = 0; i < kTrials; ++i) {
    cv::Mat image = clean.clone();
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        image.at<std::uint8_t>(y, x) = cv::saturate_cast<std::uint8_t>(
            static_cast<float>(clean.at<std::uint8_t>(y, x)) + 4.0F * normal(generator));
      }
    }
    const EdgeFit fit = refiner.fit(image, truth, refiner.contrastOf(image, truth));
    const float start = truth.distance(fit.segment.start);
    const float end = truth.distance(fit.segment.end);
    start_squares += static_cast<double>(start * start / fit.covariance_px[0]);
    end_squares += static_cast<double>(end * end / fit.covariance_px[2]);
    EXPECT_LT(fit.covariance_px[1] * fit.covariance_px[1], fit.covariance_px[0] * fit.covariance_px[2]);
  }
  std::printf("normalised error %.2f %.2f\n", std::sqrt(start_squares / kTrials),
              std::sqrt(end_squares / kTrials));
  // In pictures neighbouring samples err alike, which this noise does not: 1 there is 0.8 here.
  EXPECT_NEAR(std::sqrt(start_squares / kTrials), 0.8, 0.18);
  EXPECT_NEAR(std::sqrt(end_squares / kTrials), 0.8, 0.18);
}

}  // namespace
}  // namespace tet_line_tracker
