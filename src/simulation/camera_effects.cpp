#include "camera_effects.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "counter_random.h"
#include "named_flags.h"

namespace tet_line_tracker {
namespace {

constexpr double kStuckShare = 1.0 / 2500.0;
constexpr float kWhite = 255.0F;
constexpr float kGamma = 1.0F / 2.2F;
constexpr float kShoulder = 0.8F;         // of white, above which highlights are compressed
constexpr double kSharpeningSigma = 1.0;  // [px]
constexpr float kSharpening = 0.8F;       // of the difference from the blurred picture
constexpr int kJpegQuality = 50;

constexpr std::array<NamedFlag<CameraEffects>, 8> kEffects{
    {{"response", &CameraEffects::response},
     {"sharpening", &CameraEffects::sharpening},
     {"jpeg", &CameraEffects::jpeg},
     {"vignette", &CameraEffects::vignette},
     {"hot_pixels", &CameraEffects::hot_pixels},
     {"defocus", &CameraEffects::defocus},
     {"skewed_blur", &CameraEffects::skewed_blur},
     {"rolling_shutter", &CameraEffects::rolling_shutter}}};

void stickPixels(cv::Mat& gray, std::uint64_t camera_seed) {
  for (int y = 0; y < gray.rows; ++y) {
    auto* row = gray.ptr<float>(y);
    for (int x = 0; x < gray.cols; ++x) {
      const std::uint64_t bits =
          hash64(camera_seed, static_cast<std::uint64_t>(y) * 65536U + static_cast<std::uint64_t>(x));
      if (uniformFromBits(bits) < kStuckShare) row[x] = (bits & 1U) != 0 ? kWhite : 0.0F;
    }
  }
}

float respond(float gray) {
  const float curved = std::pow(std::max(0.0F, gray) / kWhite, kGamma);
  constexpr float kRest = 1.0F - kShoulder;
  if (curved <= kShoulder) return kWhite * curved;
  return kWhite * (kShoulder + kRest * (1.0F - std::exp((kShoulder - curved) / kRest)));
}

}  // namespace

std::string CameraEffects::text() const {
  return flagText(kEffects, *this);
}

std::vector<std::string> cameraEffectNames() {
  return flagNames(kEffects);
}

CameraEffects parseCameraEffects(const std::string& text) {
  return parseFlags(kEffects, "camera effect", text);
}

void addTail(cv::Mat& light) {
  // Along the diagonal; each step has half the light of the one before.
  constexpr int kSteps = 5;
  cv::Mat kernel = cv::Mat::zeros(2 * kSteps + 1, 2 * kSteps + 1, CV_32FC1);
  float sum = 0.0F;
  float middle = 0.0F;
  for (int i = 0; i < kSteps; ++i) {
    const float weight = std::pow(0.5F, static_cast<float>(i));
    sum += weight;
    middle += weight * static_cast<float>(i);
  }
  middle /= sum;
  // Moved back by its middle, between two pixels.
  const int whole = static_cast<int>(std::floor(middle));
  const float part = middle - static_cast<float>(whole);
  for (int i = 0; i < kSteps; ++i) {
    const float weight = std::pow(0.5F, static_cast<float>(i)) / sum;
    const int place = kSteps + i - whole;
    kernel.at<float>(place, place) += weight * (1.0F - part);
    kernel.at<float>(place - 1, place - 1) += weight * part;
  }
  // filter2D() correlates: a point's image is the kernel turned round.
  cv::flip(kernel, kernel, -1);
  cv::filter2D(light, light, CV_32F, kernel, cv::Point(-1, -1), 0.0, cv::BORDER_REPLICATE);
}

cv::Mat develop(const CameraEffects& effects, const cv::Mat& raw, std::uint64_t camera_seed) {
  cv::Mat gray = raw;
  if (effects.hot_pixels) stickPixels(gray, camera_seed);
  if (effects.response) {
    for (int y = 0; y < gray.rows; ++y) {
      auto* row = gray.ptr<float>(y);
      std::transform(row, row + gray.cols, row, respond);
    }
  }
  if (effects.sharpening) {
    cv::Mat blurred;
    cv::GaussianBlur(gray, blurred, cv::Size(7, 7), kSharpeningSigma, 0.0, cv::BORDER_REPLICATE);
    gray = gray + kSharpening * (gray - blurred);
  }
  cv::Mat image(gray.size(), CV_8UC1);
  for (int y = 0; y < image.rows; ++y) {
    const auto* row = gray.ptr<float>(y);
    std::transform(row, row + image.cols, image.ptr<std::uint8_t>(y),
                   [](float value) { return cv::saturate_cast<std::uint8_t>(value); });
  }
  if (effects.jpeg) {
    std::vector<std::uint8_t> file;
    cv::imencode(".jpg", image, file, {cv::IMWRITE_JPEG_QUALITY, kJpegQuality});
    image = cv::imdecode(file, cv::IMREAD_GRAYSCALE);
  }
  return image;
}

}  // namespace tet_line_tracker
