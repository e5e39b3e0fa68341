#include "tet_line_tracker/motion/motion_prior.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "camera/camera_models.h"
#include "geometry/so3.h"
#include "motion/gyro_integrator.h"
#include "motion/rotation_aligner.h"

namespace tet_line_tracker {
namespace {

constexpr int kCoarseLevel = 4;
constexpr int kFineLevel = 3;
constexpr int kCoarseIterations = 12;
constexpr int kFineIterations = 6;
constexpr int kBiasIterations = 3;

/// The bias of a gyroscope is learned as a mean over about this share of an image each, up to this size
/// [rad/s].
constexpr float kBiasShare = 0.05F;
constexpr float kMaxGyroBias = 0.1F;

/// A prediction must make the images fit at least this much better than no motion does.
constexpr float kMinImprovement = 0.9F;

}  // namespace

double MotionPrediction::angle() const {
  return so3Log(rotation).norm();
}

const char* MotionPrediction::sourceName() const {
  switch (source) {
    case Source::kImu:
      return "imu";
    case Source::kImage:
      return "image";
    default:
      return "none";
  }
}

class MotionPrior::Implementation {
 public:
  explicit Implementation(const MotionPriorParameters& parameters) : parameters_(parameters) {}

  void setCamera(std::shared_ptr<const CameraModel> camera) {
    if (camera == camera_) return;
    camera_ = std::move(camera);
    image_size_ = cv::Size();
  }
  void setImuRotation(const Eigen::Matrix3d& camera_from_imu) { camera_from_imu_ = camera_from_imu; }
  void addAngularVelocity(std::int64_t stamp_ns, const Eigen::Vector3d& velocity) {
    gyro_.add(stamp_ns, velocity);
  }
  void reset() {
    coarse_.clearTemplate();
    fine_.clearTemplate();
    last_rotation_.setZero();
  }
  MotionPrediction predict(const ImagePyramid& pyramid, std::int64_t stamp_ns);
  LineSegment apply(const MotionPrediction& prediction, const LineSegment& segment,
                    const Eigen::Vector2d& start_normalized, const Eigen::Vector2d& end_normalized) const;

 private:
  void prepareCamera(const ImagePyramid& pyramid);
  std::optional<Eigen::Vector3f> integrateGyro(std::int64_t stamp_ns) const;
  void learnGyroBias(const Eigen::Vector3f& measured, const Eigen::Vector3f& aligned, float interval_s);
  Eigen::Vector3f alignImages(const ImagePyramid& pyramid);

  MotionPriorParameters parameters_;
  std::shared_ptr<const CameraModel> camera_;
  std::shared_ptr<const CameraModel> lens_;  ///< camera_, or a pinhole without calibration
  cv::Size image_size_;                      ///< that the aligners know
  std::optional<Eigen::Matrix3d> camera_from_imu_;
  GyroIntegrator gyro_;
  RotationAligner coarse_{kCoarseLevel};
  RotationAligner fine_{kFineLevel};
  Eigen::Vector3f gyro_bias_{Eigen::Vector3f::Zero()};  ///< in the camera's optical frame [rad/s]
  std::int64_t last_stamp_ns_{0};
  Eigen::Vector3f last_rotation_{Eigen::Vector3f::Zero()};
};

void MotionPrior::Implementation::prepareCamera(const ImagePyramid& pyramid) {
  const cv::Size size = pyramid.level(0).size();
  if (size == image_size_) return;
  image_size_ = size;
  lens_ = camera_;
  if (!lens_) {
    CameraCalibration pinhole;
    pinhole.fx = pinhole.fy = size.width;
    pinhole.cx = 0.5 * (size.width - 1);
    pinhole.cy = 0.5 * (size.height - 1);
    lens_ = makeUncheckedCameraModel(pinhole);
  }
  coarse_.setCamera(*lens_, size);
  fine_.setCamera(*lens_, size);
}

std::optional<Eigen::Vector3f> MotionPrior::Implementation::integrateGyro(std::int64_t stamp_ns) const {
  if (!camera_from_imu_ || (parameters_.prior != "imu" && parameters_.prior != "auto")) return std::nullopt;
  const std::optional<Eigen::Matrix3d> rotation =
      gyro_.rotation(last_stamp_ns_, stamp_ns, Eigen::Vector3d::Zero());
  if (!rotation) return std::nullopt;
  return so3Log(*camera_from_imu_ * *rotation * camera_from_imu_->transpose()).cast<float>();
}

void MotionPrior::Implementation::learnGyroBias(const Eigen::Vector3f& measured,
                                                const Eigen::Vector3f& aligned, float interval_s) {
  const Eigen::Vector3f difference = (measured - aligned) / interval_s;
  // Parallax and blur disturb single images: a slow mean, and nothing that no gyroscope does.
  if (!difference.allFinite() || difference.norm() > kMaxGyroBias) return;
  gyro_bias_ += kBiasShare * (difference - gyro_bias_);
}

Eigen::Vector3f MotionPrior::Implementation::alignImages(const ImagePyramid& pyramid) {
  // From standing still and from going on as before, whichever fits better.
  Eigen::Vector3f start = Eigen::Vector3f::Zero();
  if (coarse_.hasTemplate()) {
    if (coarse_.cost(pyramid, last_rotation_) < coarse_.cost(pyramid, start)) start = last_rotation_;
    start = coarse_.align(pyramid, start, kCoarseIterations);
  }
  return fine_.hasTemplate() ? fine_.align(pyramid, start, kFineIterations) : start;
}

MotionPrediction MotionPrior::Implementation::predict(const ImagePyramid& pyramid, std::int64_t stamp_ns) {
  MotionPrediction prediction;
  if (parameters_.prior == "none") return prediction;
  prepareCamera(pyramid);
  RotationAligner& aligner = fine_.hasTemplate() ? fine_ : coarse_;
  if (aligner.hasTemplate()) {
    const float max_cost = kMinImprovement * aligner.cost(pyramid, Eigen::Vector3f::Zero());
    Eigen::Vector3f rotation = Eigen::Vector3f::Zero();
    const std::optional<Eigen::Vector3f> measured = integrateGyro(stamp_ns);
    const float interval_s = 1e-9F * static_cast<float>(stamp_ns - last_stamp_ns_);
    const Eigen::Vector3f corrected =
        measured ? Eigen::Vector3f(*measured - interval_s * gyro_bias_) : rotation;
    if (measured && aligner.cost(pyramid, corrected) < max_cost) {
      prediction.source = MotionPrediction::Source::kImu;
      rotation = corrected;
      learnGyroBias(*measured, aligner.align(pyramid, corrected, kBiasIterations), interval_s);
    } else if (!measured || parameters_.prior == "auto") {
      const Eigen::Vector3f found = alignImages(pyramid);
      if (found.allFinite() && aligner.cost(pyramid, found) < max_cost) {
        prediction.source = MotionPrediction::Source::kImage;
        rotation = found;
      }
    }
    // The norm in single precision, as the rotation vector.
    const double angle = static_cast<double>(rotation.norm());
    if (angle > 0.0) {
      prediction.rotation = Eigen::AngleAxisd(angle, rotation.cast<double>() / angle).toRotationMatrix();
    }
    last_rotation_ = rotation;
  }
  coarse_.extractTemplate(pyramid);
  fine_.extractTemplate(pyramid);
  gyro_.forgetBefore(stamp_ns);
  last_stamp_ns_ = stamp_ns;
  return prediction;
}

LineSegment MotionPrior::Implementation::apply(const MotionPrediction& prediction, const LineSegment& segment,
                                               const Eigen::Vector2d& start_normalized,
                                               const Eigen::Vector2d& end_normalized) const {
  if (!lens_ || !prediction.used()) return segment;
  const auto rotated = [&](const Eigen::Vector2f& point,
                           const Eigen::Vector2d& normalized) -> std::optional<Eigen::Vector2d> {
    if (normalized.allFinite()) return lens_->project(prediction.rotation * normalized.homogeneous());
    const std::optional<Eigen::Vector3d> ray = lens_->unproject(point.cast<double>());
    if (!ray) return std::nullopt;
    return lens_->project(prediction.rotation * *ray);
  };
  const std::optional<Eigen::Vector2d> start = rotated(segment.start, start_normalized);
  const std::optional<Eigen::Vector2d> end = rotated(segment.end, end_normalized);
  if (!start || !end) return segment;
  const LineSegment expected{start->cast<float>(), end->cast<float>()};
  return expected.start.allFinite() && expected.end.allFinite() ? expected : segment;
}

MotionPrior::MotionPrior(const MotionPriorParameters& parameters)
    : implementation_(std::make_unique<Implementation>(parameters)) {}
MotionPrior::~MotionPrior() = default;
MotionPrior::MotionPrior(MotionPrior&&) noexcept = default;
MotionPrior& MotionPrior::operator=(MotionPrior&&) noexcept = default;

void MotionPrior::setCamera(std::shared_ptr<const CameraModel> camera) {
  implementation_->setCamera(std::move(camera));
}
void MotionPrior::setImuRotation(const Eigen::Matrix3d& camera_from_imu) {
  implementation_->setImuRotation(camera_from_imu);
}
void MotionPrior::addAngularVelocity(std::int64_t stamp_ns, const Eigen::Vector3d& angular_velocity) {
  implementation_->addAngularVelocity(stamp_ns, angular_velocity);
}
void MotionPrior::reset() {
  implementation_->reset();
}
MotionPrediction MotionPrior::predict(const ImagePyramid& pyramid, std::int64_t stamp_ns) {
  return implementation_->predict(pyramid, stamp_ns);
}
LineSegment MotionPrior::apply(const MotionPrediction& prediction, const LineSegment& segment,
                               const Eigen::Vector2d& start_normalized,
                               const Eigen::Vector2d& end_normalized) const {
  return implementation_->apply(prediction, segment, start_normalized, end_normalized);
}

}  // namespace tet_line_tracker
