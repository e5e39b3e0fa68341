#include "sensor.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "counter_random.h"

namespace tet_line_tracker {

float vignettingAt(const Sensor& sensor, const cv::Size& size, float x, float y) {
  const float half_width = 0.5F * static_cast<float>(size.width - 1);
  const float half_height = 0.5F * static_cast<float>(size.height - 1);
  const float dx = x - half_width;
  const float dy = y - half_height;
  const float corner = half_width * half_width + half_height * half_height;
  return 1.0F - sensor.vignetting * (dx * dx + dy * dy) / std::max(corner, 1.0F);
}

cv::Mat expose(const Sensor& sensor, const cv::Mat& radiance, double brightness, double gain,
               std::uint64_t noise_seed) {
  cv::Mat light;
  cv::GaussianBlur(radiance, light, cv::Size(5, 5), static_cast<double>(sensor.blur_px), 0.0,
                   cv::BORDER_REPLICATE);
  cv::Mat image(radiance.size(), CV_8UC1);
  const auto scale = static_cast<float>(brightness);
  const auto amplification = static_cast<float>(gain);
  const float shot = 1.0F / sensor.electrons_per_gray;
  const float read = sensor.read_noise_gray * sensor.read_noise_gray;
  for (int y = 0; y < image.rows; ++y) {
    const auto* in = light.ptr<float>(y);
    auto* out = image.ptr<std::uint8_t>(y);
    const std::uint64_t row_seed = hash64(noise_seed, static_cast<std::uint64_t>(y));
    for (int x = 0; x < image.cols; ++x) {
      const float signal =
          in[x] * scale * vignettingAt(sensor, image.size(), static_cast<float>(x), static_cast<float>(y));
      const float noise =
          std::sqrt(signal * shot + read) * normalFromBits(hash64(row_seed + static_cast<std::uint64_t>(x)));
      const float gray = amplification * (signal + noise);
      out[x] = cv::saturate_cast<std::uint8_t>(gray);
    }
  }
  return image;
}

}  // namespace tet_line_tracker
