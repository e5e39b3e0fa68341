#pragma once

#include <cstdint>

#include <opencv2/core.hpp>

#include "camera_effects.h"

namespace tet_line_tracker {

/// An 8-bit sensor behind a lens.
struct Sensor {
  float blur_px{0.5F};              ///< deviation of the lens's point spread [px]
  float vignetting{0.35F};          ///< light lost in the image's corners, share
  float electrons_per_gray{30.0F};  ///< at gain 1: sets the shot noise
  float read_noise_gray{0.6F};      ///< deviation at gain 1, 8-bit gray levels
  CameraEffects effects;
  std::uint64_t camera_seed{0};  ///< of what is the same in all images
};

/// A usual sensor, or one with effects.
Sensor makeSensor(const CameraEffects& effects, std::uint64_t seed);

/// Image that the sensor gives of a radiance image (CV_32FC1, 8-bit gray levels at `brightness` 1).
/// `brightness` is light that falls on the sensor and makes shot noise; `gain` amplifies signal and noise.
/// `noise_seed` must differ from image to image.
cv::Mat expose(const Sensor& sensor, const cv::Mat& radiance, double brightness, double gain,
               std::uint64_t noise_seed);

/// Share of the light that reaches a pixel.
float vignettingAt(const Sensor& sensor, const cv::Size& size, float x, float y);

}  // namespace tet_line_tracker
