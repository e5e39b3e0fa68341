#include "chord_camera.h"

#include <utility>

namespace tet_line_tracker {
namespace {

class ChordCamera final : public CameraModel {
 public:
  explicit ChordCamera(std::shared_ptr<const CameraModel> camera)
      : CameraModel(camera->calibration()), camera_(std::move(camera)) {}

  std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& point) const override {
    return camera_->project(point);
  }
  std::optional<Eigen::Vector3d> unproject(const Eigen::Vector2d& pixel) const override {
    return camera_->unproject(pixel);
  }
  bool bendsLines() const override { return false; }

 private:
  std::shared_ptr<const CameraModel> camera_;
};

}  // namespace

std::shared_ptr<const CameraModel> asChordCamera(std::shared_ptr<const CameraModel> camera) {
  if (!camera) return nullptr;
  return std::make_shared<ChordCamera>(std::move(camera));
}

}  // namespace tet_line_tracker
