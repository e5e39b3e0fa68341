#include "sensor.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "counter_random.h"

namespace tet_line_tracker {

Sensor makeSensor(const CameraEffects& effects, std::uint64_t seed) {
  Sensor sensor;
  sensor.effects = effects;
  sensor.camera_seed = hash64(seed, 7);
  if (effects.defocus) sensor.blur_px = 1.5F;
  if (effects.vignette) sensor.vignetting = 0.75F;
  return sensor;
}

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
  const int reach = std::max(2, static_cast<int>(std::ceil(3.0F * sensor.blur_px)));
  cv::GaussianBlur(radiance, light, cv::Size(2 * reach + 1, 2 * reach + 1),
                   static_cast<double>(sensor.blur_px), 0.0, cv::BORDER_REPLICATE);
  if (sensor.effects.skewed_blur) addTail(light);
  cv::Mat image(radiance.size(), CV_32FC1);
  const auto scale = static_cast<float>(brightness * sensor.effects.exposureFactor());
  const auto amplification = static_cast<float>(gain);
  const float shot = 1.0F / sensor.electrons_per_gray;
  const float read = sensor.read_noise_gray * sensor.read_noise_gray;
  for (int y = 0; y < image.rows; ++y) {
    const auto* in = light.ptr<float>(y);
    auto* out = image.ptr<float>(y);
    const std::uint64_t row_seed = hash64(noise_seed, static_cast<std::uint64_t>(y));
    for (int x = 0; x < image.cols; ++x) {
      const float signal =
          in[x] * scale * vignettingAt(sensor, image.size(), static_cast<float>(x), static_cast<float>(y));
      const float noise =
          std::sqrt(signal * shot + read) * normalFromBits(hash64(row_seed + static_cast<std::uint64_t>(x)));
      out[x] = amplification * (signal + noise);
    }
  }
  return develop(sensor.effects, image, sensor.camera_seed);
}

}  // namespace tet_line_tracker
