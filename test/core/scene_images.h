#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <optional>
#include <random>
#include <vector>

#include <Eigen/Core>
#include <opencv2/imgproc.hpp>

#include "tet_line_tracker/camera/camera_model.h"

namespace tet_line_tracker {

/// A board that faces along z.
struct Board {
  Eigen::Vector3d centre;     ///< [m]
  Eigen::Vector2d half_size;  ///< [m]
  double gray;
};

/// Boards in space before a camera without distortion, for tests of what parallax does. x right, y down, z
/// forwards, as in the optical frame of a camera that is not turned.
class BoardScene {
 public:
  static constexpr int kWidth = 640;
  static constexpr int kHeight = 480;
  static constexpr double kFocal = 450.0;

  struct Pose {
    Eigen::Vector3d position{Eigen::Vector3d::Zero()};               ///< of the camera [m]
    Eigen::Matrix3d camera_from_world{Eigen::Matrix3d::Identity()};  ///< rotation
  };

  static std::shared_ptr<const CameraModel> camera() {
    CameraCalibration calibration;
    calibration.model = "plumb_bob";
    calibration.width = kWidth;
    calibration.height = kHeight;
    calibration.fx = calibration.fy = kFocal;
    calibration.cx = 0.5 * (kWidth - 1);
    calibration.cy = 0.5 * (kHeight - 1);
    calibration.distortion = {0.0, 0.0, 0.0, 0.0};
    return makeCameraModel(calibration);
  }

  /// Boards of 2 to 8 m from the origin.
  static BoardScene random(unsigned seed, int count = 90) {
    std::mt19937 random(seed);
    const auto uniform = [&](double low, double high) {
      return std::uniform_real_distribution<double>(low, high)(random);
    };
    BoardScene scene;
    for (int i = 0; i < count; ++i) {
      const double z = 1.0 / uniform(0.12, 0.5);
      scene.add({{uniform(-1.1, 1.1) * z, uniform(-0.7, 0.7) * z, z},
                 {uniform(0.05, 0.14) * z, uniform(0.05, 0.14) * z},
                 uniform(20.0, 235.0)});
    }
    return scene;
  }

  void add(const Board& board) {
    boards_.push_back(board);
    std::stable_sort(boards_.begin(), boards_.end(),
                     [](const Board& a, const Board& b) { return a.centre.z() > b.centre.z(); });
  }
  const std::vector<Board>& boards() const { return boards_; }

  /// The four corners in the image [px], from the top-left one round; nothing when one is behind the camera.
  static std::optional<std::vector<Eigen::Vector2d>> cornersOf(const Board& board, const Pose& pose) {
    std::vector<Eigen::Vector2d> corners;
    for (const Eigen::Vector2d& sign :
         {Eigen::Vector2d(-1, -1), Eigen::Vector2d(1, -1), Eigen::Vector2d(1, 1), Eigen::Vector2d(-1, 1)}) {
      Eigen::Vector3d point = board.centre;
      point.head<2>() += sign.cwiseProduct(board.half_size);
      const Eigen::Vector3d seen = pose.camera_from_world * (point - pose.position);
      if (seen.z() < 0.2) return std::nullopt;
      corners.emplace_back(kFocal * seen.x() / seen.z() + 0.5 * (kWidth - 1),
                           kFocal * seen.y() / seen.z() + 0.5 * (kHeight - 1));
    }
    return corners;
  }

  cv::Mat image(const Pose& pose) const {
    constexpr int kShift = 6;
    cv::Mat image(kHeight, kWidth, CV_8UC1, cv::Scalar(110));
    for (const Board& board : boards_) {
      const auto corners = cornersOf(board, pose);
      if (!corners) continue;
      std::vector<cv::Point> outline;
      for (const Eigen::Vector2d& corner : *corners) {
        outline.emplace_back(cvRound(corner.x() * (1 << kShift)), cvRound(corner.y() * (1 << kShift)));
      }
      cv::fillConvexPoly(image, outline, cv::Scalar(board.gray), cv::LINE_AA, kShift);
    }
    return image;
  }

 private:
  std::vector<Board> boards_;  ///< the farthest first
};

}  // namespace tet_line_tracker
