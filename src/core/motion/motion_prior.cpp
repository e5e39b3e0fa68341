#include "tet_line_tracker/motion/motion_prior.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "camera/camera_models.h"
#include "geometry/so3.h"
#include "motion/ego_motion.h"
#include "motion/gyro_bias.h"
#include "motion/gyro_integrator.h"
#include "motion/imu_time_offset.h"
#include "motion/odometry_interpolator.h"
#include "motion/rotation_aligner.h"

namespace tet_line_tracker {
namespace {

constexpr int kCoarseLevel = 4;
constexpr int kFineLevel = 3;
constexpr int kCoarseIterations = 12;
constexpr int kFineIterations = 6;

/// A prediction must make the images fit at least this much better than no motion does.
constexpr float kMinImprovement = 0.9F;

/// The gyroscope's rotation, and one that was found from it, must fit at least this much better than the one
/// that was found from the images alone.
constexpr float kMinLead = 0.95F;

/// Gyroscope and images contradict each other when their rotations differ by more than this [rad]: parallax
/// looks like a few milliradians from image to image.
constexpr float kAgreement = 0.015F;

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
    case Source::kOdometry:
      return "odometry";
    default:
      return "none";
  }
}

class MotionPrior::Implementation {
 public:
  explicit Implementation(const MotionPriorParameters& parameters) : parameters_(parameters) {
    setImuTimeOffset();
  }

  void setParameters(const MotionPriorParameters& parameters) {
    // What was not in use has not seen the last images.
    if (parameters_.prior == "none") reset();
    if (!parameters_.ego_motion) ego_motion_.reset();
    const bool other_offset = parameters.imu_time_offset != parameters_.imu_time_offset;
    parameters_ = parameters;
    if (other_offset) setImuTimeOffset();
  }
  void setCamera(std::shared_ptr<const CameraModel> camera) {
    if (camera == camera_) return;
    ego_motion_.setCamera(camera);
    camera_ = std::move(camera);
    image_size_ = cv::Size();
  }
  void setImuRotation(const Eigen::Matrix3d& camera_from_imu) {
    if (camera_from_imu_ && *camera_from_imu_ != camera_from_imu) {
      gyro_bias_.reset();
      if (estimated_offset_) estimated_offset_->reset();
    }
    camera_from_imu_ = camera_from_imu;
  }
  Eigen::Vector3d gyroBias() const { return -gyro_bias_.value().cast<double>(); }
  void addAngularVelocity(std::int64_t stamp_ns, const Eigen::Vector3d& velocity) {
    gyro_.add(stamp_ns, velocity);
    if (estimated_offset_) estimated_offset_->addAngularVelocity(stamp_ns, velocity);
  }
  void setOdometryExtrinsic(const Eigen::Isometry3d& camera_from_body) {
    camera_from_body_ = camera_from_body;
  }
  void addOdometry(std::int64_t stamp_ns, const Eigen::Isometry3d& odometry_from_body) {
    odometry_.add(stamp_ns, odometry_from_body);
  }
  double imuTimeOffset() const { return estimated_offset_ ? estimated_offset_->value() : given_offset_s_; }
  void reset() {
    coarse_.clearTemplate();
    fine_.clearTemplate();
    ego_motion_.reset();
    last_rotation_.setZero();
    last_stamp_ns_.reset();
  }
  MotionPrediction predict(const ImagePyramid& pyramid, std::int64_t stamp_ns);
  LineSegment apply(const MotionPrediction& prediction, const LineSegment& segment,
                    const Eigen::Vector2d& start_normalized, const Eigen::Vector2d& end_normalized,
                    const Eigen::Vector2d& inverse_depths) const;
  std::optional<DepthGuess> depthNear(const Eigen::Vector2f& pixel) const {
    return ego_motion_.depthNear(pixel);
  }
  double focal() const { return lens_ ? meanFocal(lens_->calibration()) : 1.0; }

 private:
  void setImuTimeOffset() {
    const std::optional<double> given = givenImuTimeOffset(parameters_);
    given_offset_s_ = given.value_or(0.0);
    estimated_offset_.reset();
    if (!given) estimated_offset_.emplace();
  }
  std::int64_t imuStamp(std::int64_t image_stamp_ns) const {
    return image_stamp_ns + std::llround(1e9 * imuTimeOffset());
  }
  Eigen::Vector3f withoutBias(const Eigen::Vector3f& measured, float interval_s) const {
    return measured - interval_s * gyro_bias_.value();
  }
  void prepareCamera(const ImagePyramid& pyramid);
  std::optional<Eigen::Vector3f> integrateGyro(std::int64_t stamp_ns) const;
  /// Takes points in the camera's optical frame at the image before to the same points at this one.
  std::optional<Eigen::Isometry3d> interpolateOdometry(std::int64_t stamp_ns) const;
  bool estimatesEgoMotion() const { return parameters_.ego_motion && camera_ != nullptr; }
  /// `measured`, `seen`: rotation by the gyroscope, its bias included, and by the alignment of the images
  /// alone, where it was needed.
  void addEgoMotion(const ImagePyramid& pyramid, const std::optional<Eigen::Vector3f>& measured,
                    const std::optional<Eigen::Vector3f>& seen,
                    const std::optional<Eigen::Isometry3d>& odometry, float interval_s,
                    MotionPrediction& prediction);
  /// Rotation by gyroscope or images, whichever the images confirm; none where neither is.
  void chooseRotation(const ImagePyramid& pyramid, const Eigen::Vector3f& seen,
                      const std::optional<Eigen::Vector3f>& measured, float interval_s,
                      MotionPrediction& prediction);
  Eigen::Vector3f alignImages(const ImagePyramid& pyramid);
  /// Rotation from what the gyroscope `measured` and what the images alone have `seen`, whichever fits
  /// better; nothing when they contradict each other. Learns the bias.
  std::optional<Eigen::Vector3f> fuse(RotationAligner& aligner, const ImagePyramid& pyramid,
                                      const Eigen::Vector3f& measured, Eigen::Vector3f seen, float max_cost,
                                      float interval_s);

  MotionPriorParameters parameters_;
  std::shared_ptr<const CameraModel> camera_;
  std::shared_ptr<const CameraModel> lens_;  ///< camera_, or a pinhole without calibration
  cv::Size image_size_;                      ///< that the aligners know
  std::optional<Eigen::Matrix3d> camera_from_imu_;
  GyroIntegrator gyro_;
  double given_offset_s_{0.0};
  std::optional<ImuTimeOffset> estimated_offset_;  ///< when the parameter is auto
  RotationAligner coarse_{kCoarseLevel};
  RotationAligner fine_{kFineLevel};
  EgoMotionTracker ego_motion_;
  GyroBias gyro_bias_;  ///< of directions in the camera's optical frame, which rotate against the camera
  std::optional<Eigen::Isometry3d> camera_from_body_;
  OdometryInterpolator odometry_;
  std::optional<std::int64_t> last_stamp_ns_;  ///< nothing before the first image
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
  if (!last_stamp_ns_ || !camera_from_imu_ || (parameters_.prior != "imu" && parameters_.prior != "auto"))
    return std::nullopt;
  const std::optional<Eigen::Matrix3d> rotation =
      gyro_.rotation(imuStamp(*last_stamp_ns_), imuStamp(stamp_ns), Eigen::Vector3d::Zero());
  if (!rotation) return std::nullopt;
  return so3Log(*camera_from_imu_ * *rotation * camera_from_imu_->transpose()).cast<float>();
}

std::optional<Eigen::Isometry3d> MotionPrior::Implementation::interpolateOdometry(
    std::int64_t stamp_ns) const {
  if (!last_stamp_ns_ || !camera_from_body_ || parameters_.prior != "odometry" || !estimatesEgoMotion()) {
    return std::nullopt;
  }
  const std::optional<Eigen::Isometry3d> motion = odometry_.motion(*last_stamp_ns_, stamp_ns);
  if (!motion) return std::nullopt;
  return *camera_from_body_ * *motion * camera_from_body_->inverse();
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

std::optional<Eigen::Vector3f> MotionPrior::Implementation::fuse(RotationAligner& aligner,
                                                                 const ImagePyramid& pyramid,
                                                                 const Eigen::Vector3f& measured,
                                                                 Eigen::Vector3f seen, float max_cost,
                                                                 float interval_s) {
  const Eigen::Vector3f corrected = withoutBias(measured, interval_s);
  const float cost = aligner.cost(pyramid, corrected);
  if (cost < max_cost) {
    // Where the images alone go astray, the gyroscope leads them back.
    const Eigen::Vector3f led = aligner.align(pyramid, corrected, kFineIterations);
    if (!seen.allFinite() || aligner.cost(pyramid, led) < kMinLead * aligner.cost(pyramid, seen)) seen = led;
  }
  if (!estimatesEgoMotion()) gyro_bias_.learn(measured, seen, interval_s);
  if (!(cost < max_cost) && !((seen - corrected).norm() < kAgreement)) return std::nullopt;
  const bool leads = !seen.allFinite() || cost < kMinLead * aligner.cost(pyramid, seen);
  return leads ? corrected : seen;
}

void MotionPrior::Implementation::chooseRotation(const ImagePyramid& pyramid, const Eigen::Vector3f& seen,
                                                 const std::optional<Eigen::Vector3f>& measured,
                                                 float interval_s, MotionPrediction& prediction) {
  RotationAligner& aligner = fine_.hasTemplate() ? fine_ : coarse_;
  const float max_cost = kMinImprovement * aligner.cost(pyramid, Eigen::Vector3f::Zero());
  const std::optional<Eigen::Vector3f> fused =
      measured ? fuse(aligner, pyramid, *measured, seen, max_cost, interval_s) : std::nullopt;
  if (fused && fused->allFinite() && aligner.cost(pyramid, *fused) < max_cost) {
    prediction.source = MotionPrediction::Source::kImu;
    prediction.rotation = so3Exp(fused->cast<double>()).toRotationMatrix();
  } else if ((!measured || parameters_.prior == "auto") && seen.allFinite() &&
             aligner.cost(pyramid, seen) < max_cost) {
    prediction.source = MotionPrediction::Source::kImage;
    prediction.rotation = so3Exp(seen.cast<double>()).toRotationMatrix();
  }
}

MotionPrediction MotionPrior::Implementation::predict(const ImagePyramid& pyramid, std::int64_t stamp_ns) {
  MotionPrediction prediction;
  if (parameters_.prior == "none") return prediction;
  prepareCamera(pyramid);
  const float interval_s = 1e-9F * static_cast<float>(stamp_ns - last_stamp_ns_.value_or(stamp_ns));
  const std::optional<Eigen::Vector3f> measured = integrateGyro(stamp_ns);
  const std::optional<Eigen::Isometry3d> odometry = interpolateOdometry(stamp_ns);
  const bool trusted = measured && estimatesEgoMotion() && gyro_bias_.isTrusted();
  std::optional<Eigen::Vector3f> seen;
  const bool needs_images = !odometry && (!trusted || estimated_offset_);
  if (needs_images && (fine_.hasTemplate() || coarse_.hasTemplate())) seen = alignImages(pyramid);
  if (odometry) {
    prediction.source = MotionPrediction::Source::kOdometry;
    prediction.rotation = odometry->linear();
  } else if (trusted) {
    // Images align by what moves with the most of them, and large parallax leads them astray.
    prediction.source = MotionPrediction::Source::kImu;
    prediction.rotation = so3Exp(withoutBias(*measured, interval_s).cast<double>()).toRotationMatrix();
  } else if (seen) {
    chooseRotation(pyramid, *seen, measured, interval_s, prediction);
  }
  if (seen && estimated_offset_ && camera_from_imu_ && last_stamp_ns_) {
    estimated_offset_->addImageRotation(*last_stamp_ns_, stamp_ns, seen->cast<double>(), *camera_from_imu_);
  }
  if (estimatesEgoMotion()) addEgoMotion(pyramid, measured, seen, odometry, interval_s, prediction);
  last_rotation_ = so3Log(prediction.rotation).cast<float>();
  coarse_.setFirst(pyramid);
  fine_.setFirst(pyramid);
  // An estimate may still move back.
  gyro_.forgetBefore(imuStamp(stamp_ns) - (estimated_offset_ ? GyroIntegrator::kMaxGapNs : 0));
  odometry_.forgetBefore(stamp_ns);
  last_stamp_ns_ = stamp_ns;
  return prediction;
}

void MotionPrior::Implementation::addEgoMotion(const ImagePyramid& pyramid,
                                               const std::optional<Eigen::Vector3f>& measured,
                                               const std::optional<Eigen::Vector3f>& seen,
                                               const std::optional<Eigen::Isometry3d>& odometry,
                                               float interval_s, MotionPrediction& prediction) {
  std::optional<EgoMotionTracker::MeasuredRotation> turn;
  if (measured) {
    turn = EgoMotionTracker::MeasuredRotation{
        so3Exp(withoutBias(*measured, interval_s).cast<double>()).toRotationMatrix(),
        static_cast<double>(interval_s * gyro_bias_.deviation()), gyro_bias_.isTrusted()};
  }
  std::optional<Eigen::Vector3d> step;
  if (odometry) step = odometry->translation();
  ego_motion_.update(pyramid, static_cast<double>(interval_s), turn, step, prediction);
  if (!measured) return;
  if (prediction.confirmed && (gyro_bias_.isTrusted() || !prediction.translation.isZero())) {
    // The rotation that is left when translation has its part: parallax does not look like a bias.
    gyro_bias_.learn(*measured, so3Log(prediction.rotation).cast<float>(), interval_s);
  } else if (gyro_bias_.isTrusted()) {
    gyro_bias_.doubt();
  } else if (seen && (withoutBias(*measured, interval_s) - *seen).norm() < kAgreement) {
    // Where corners show no parallax, they were rotated by the gyroscope itself.
    gyro_bias_.learn(*measured, *seen, interval_s);
  }
}

LineSegment MotionPrior::Implementation::apply(const MotionPrediction& prediction, const LineSegment& segment,
                                               const Eigen::Vector2d& start_normalized,
                                               const Eigen::Vector2d& end_normalized,
                                               const Eigen::Vector2d& inverse_depths) const {
  if (!lens_ || !prediction.used()) return segment;
  const auto moved = [&](const Eigen::Vector2f& point, const Eigen::Vector2d& normalized,
                         double inverse_depth) -> std::optional<Eigen::Vector2d> {
    if (normalized.allFinite()) {
      return lens_->project(prediction.rotation * normalized.homogeneous() +
                            inverse_depth * prediction.translation);
    }
    const std::optional<Eigen::Vector3d> ray = lens_->unproject(point.cast<double>());
    if (!ray) return std::nullopt;
    return lens_->project(prediction.rotation * *ray);
  };
  const std::optional<Eigen::Vector2d> start = moved(segment.start, start_normalized, inverse_depths[0]);
  const std::optional<Eigen::Vector2d> end = moved(segment.end, end_normalized, inverse_depths[1]);
  if (!start || !end) return segment;
  const LineSegment expected{start->cast<float>(), end->cast<float>()};
  return expected.start.allFinite() && expected.end.allFinite() ? expected : segment;
}

MotionPrior::MotionPrior(const MotionPriorParameters& parameters)
    : implementation_(std::make_unique<Implementation>(parameters)) {}
MotionPrior::~MotionPrior() = default;
MotionPrior::MotionPrior(MotionPrior&&) noexcept = default;
MotionPrior& MotionPrior::operator=(MotionPrior&&) noexcept = default;

void MotionPrior::setParameters(const MotionPriorParameters& parameters) {
  implementation_->setParameters(parameters);
}
void MotionPrior::setCamera(std::shared_ptr<const CameraModel> camera) {
  implementation_->setCamera(std::move(camera));
}
void MotionPrior::setImuRotation(const Eigen::Matrix3d& camera_from_imu) {
  implementation_->setImuRotation(camera_from_imu);
}
void MotionPrior::addAngularVelocity(std::int64_t stamp_ns, const Eigen::Vector3d& angular_velocity) {
  implementation_->addAngularVelocity(stamp_ns, angular_velocity);
}
void MotionPrior::setOdometryExtrinsic(const Eigen::Isometry3d& camera_from_body) {
  implementation_->setOdometryExtrinsic(camera_from_body);
}
void MotionPrior::addOdometry(std::int64_t stamp_ns, const Eigen::Isometry3d& odometry_from_body) {
  implementation_->addOdometry(stamp_ns, odometry_from_body);
}
Eigen::Vector3d MotionPrior::gyroBias() const {
  return implementation_->gyroBias();
}
double MotionPrior::imuTimeOffset() const {
  return implementation_->imuTimeOffset();
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
  return implementation_->apply(prediction, segment, start_normalized, end_normalized,
                                Eigen::Vector2d::Zero());
}
LineSegment MotionPrior::apply(const MotionPrediction& prediction, const LineSegment& segment,
                               const Eigen::Vector2d& start_normalized, const Eigen::Vector2d& end_normalized,
                               const Eigen::Vector2d& inverse_depths) const {
  return implementation_->apply(prediction, segment, start_normalized, end_normalized, inverse_depths);
}
double MotionPrior::focal() const {
  return implementation_->focal();
}
std::optional<DepthGuess> MotionPrior::depthNear(const Eigen::Vector2f& pixel) const {
  return implementation_->depthNear(pixel);
}

}  // namespace tet_line_tracker
