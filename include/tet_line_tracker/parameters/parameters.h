#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "tet_line_tracker/parameters/parameter_table.h"

namespace tet_line_tracker {

/// Endpoint flow: Algorithm 1 of the paper, and the joint estimate of both movement vectors.
struct EndpointTrackerParameters {
  int pyramid_levels{3};      ///< images in the pyramid, the original included, 1..8 (paper: n = 3)
  int window_px{7};           ///< side of the square patch, odd, 3..21 (paper: omega = 7)
  int max_iterations{10};     ///< per level, 1..100 (paper: N_itermax = 10)
  double max_residual{0.02};  ///< paper: mean absolute gray difference on [0, 1] above which a line is an
                              ///< outlier, 0.001..1 (omega_errormin)
  double min_step{0.01};      ///< paper: iterations end below this step, 0..1 [px]

  // Of the joint estimate alone.
  int finest_level{1};             ///< level at which the flow ends, 0..3; the re-fit does the rest
  double patch_spacing{10.0};      ///< between patches along the segment, 3..100 [px]
  int max_patches{8};              ///< per segment and level, 2..16
  bool gain_and_offset{true};      ///< match mean and spread of each patch to its template
  bool robust_patches{true};       ///< less weight to patches that do not match, e.g. covered ones
  double max_joint_residual{0.1};  ///< as max_residual, 0.001..1
};

/// Where endpoints are expected in the next image.
struct MotionPriorParameters {
  /// none, image, imu (image where its samples are missing), auto (image also where the images contradict the
  /// imu), odometry (image where it is missing or corners contradict it; needs ego_motion)
  std::string prior{"auto"};
  /// the translation of the camera and the depth of lines predict their parallax; needs a calibration
  bool ego_motion{true};
  /// t_imu - t_image [s], -0.5..0.5: what happens at stamp t of an image has the IMU stamp t + offset (as
  /// Kalibr's timeshift_cam_imu and VINS's td); or auto: estimated
  std::string imu_time_offset{"0"};
  bool predict_parallax{true};  ///< the movement that rotation does not explain goes on as in the last image
};

/// Re-fit of a tracked line to the edge under it.
struct LineRefinerParameters {
  bool refine{true};        ///< otherwise lines stay where the flow puts them
  double search_px{3.0};    ///< the edge is searched this far on both sides, 1..6 [px]
  double min_support{0.5};  ///< share of the samples along the line that must lie on the edge, 0..1
};

/// How much a line may change from image to image.
struct PlausibilityParameters {
  double max_rotation{0.2};      ///< of the direction against the expected one, 0.01..3 [rad]
  double max_length_ratio{1.5};  ///< of the length to the expected one, or its inverse, 1.01..10
  double max_edge_offset{1.0};   ///< of the edge from where the flow puts the line, beyond what is usual in
                                 ///< the image, 0.1..10 [px]
  bool check_depth{true};        ///< lines are lost that would lie behind the camera or jump in depth; false
                                 ///< keeps moving objects
};

/// Which segments are worth tracking, and when to detect new ones.
struct DetectionParameters {
  std::string detector{"auto"};  ///< auto, edge, lsd, fld
  double min_length{30.0};       ///< shorter lines are ignored, 5..1000 [px] (paper: 30)
  int min_lines{30};             ///< detect again when fewer are left, 0..1000 (paper: 30)
  int max_lines{150};            ///< tracked at a time, 1..1000
  double border{2.0};            ///< margin of the image without endpoints, 0..100 [px]
  double redetect_ratio{0.9};    ///< joint: detect again when the number of lines or their coverage of
                                 ///< the image falls below this ratio to that after the last detection, 0..1
  int detection_interval{3};     ///< joint: images from one detection to the next at least, 1..1000
  double min_detection_support{0.8};  ///< joint: share of a new line that must lie on an edge, 0..1; clear
                                      ///< edges may have a quarter of the gaps
};

/// When an image continues a stream of images and when it starts another.
struct StreamParameters {
  double max_gap{1.0};  ///< a longer gap between two images starts a new epoch, 0.001..3600 [s]
};

/// Everything that LineTracker needs to know.
struct LineTrackerParameters {
  std::string method{"joint"};  ///< joint, paper
  int threads{1};               ///< that follow lines, 1..64; the result does not depend on it
  EndpointTrackerParameters flow;
  MotionPriorParameters motion;
  LineRefinerParameters refiner;
  PlausibilityParameters plausibility;
  DetectionParameters detection;
  StreamParameters stream;
};

/// The offset that imu_time_offset gives [s]; nothing for auto, and for what check() refuses.
std::optional<double> givenImuTimeOffset(const MotionPriorParameters& parameters);

/// Entries bound to the fields of `parameters`, which must outlive the table.
ParameterTable tableOf(LineTrackerParameters& parameters);

/// One sentence for each broken rule, empty when the parameters can be used.
std::vector<std::string> check(const LineTrackerParameters& parameters);
std::vector<std::string> check(const EndpointTrackerParameters& parameters);

/// Whether tracks that were followed with `before` cannot be followed with `after`.
bool needsNewEpoch(const LineTrackerParameters& before, const LineTrackerParameters& after);

/// `parameters`, if check() finds no broken rule. Throws std::invalid_argument with all of them otherwise.
template <class Parameters>
const Parameters& checked(const Parameters& parameters) {
  std::string sentences;
  for (const std::string& sentence : check(parameters)) {
    sentences += (sentences.empty() ? "" : "; ") + sentence;
  }
  if (!sentences.empty()) throw std::invalid_argument(sentences);
  return parameters;
}

}  // namespace tet_line_tracker
