#include "motion/ego_motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "camera/camera_models.h"
#include "geometry/so3.h"

namespace tet_line_tracker {
namespace {

constexpr double kGyroSigma = 0.001;  ///< of a rotation that the gyroscope measured, besides its bias [rad]
constexpr double kImageSigma = 0.04;  ///< of one that the images alone show: it takes up parallax [rad]
// Shares of the corners: that agree with a trusted gyroscope, and that must agree with another rotation
// beyond those that agree with the gyroscope, trusted or not yet.
constexpr double kConfirmed = 0.85;
constexpr double kLeadOverTrusted = 0.10;
constexpr double kLead = 0.03;
constexpr double kMinStep = 0.005;        ///< by an odometry; a shorter one has no direction [m]
constexpr double kOtherRotation = 0.02;   ///< a difference that corners are to decide on [rad]
constexpr std::size_t kManyInliers = 20;  ///< that no chance brings together
constexpr std::size_t kMinRatios = 5;     ///< corners that must tell how much longer a step is than the last
constexpr double kMaxRatio = 4.0;
constexpr double kMinMovement = 2.0;  ///< by parallax, for a corner to tell that [px]
constexpr double kNewWeight = 0.6;    ///< of a measured inverse depth against that of the images before
constexpr double kMinDepth = 1e-4;    ///< corners at infinity count as this far [1 / step]

/// Turns to look for corners from, when nothing else finds them again: as far apart as the flow reaches
/// [rad].
constexpr std::array<double, 5> kYaws = {0.0, 0.2, -0.2, 0.4, -0.4};
constexpr std::array<double, 3> kPitches = {0.0, 0.2, -0.2};

}  // namespace

void EgoMotionTracker::setCamera(std::shared_ptr<const CameraModel> camera) {
  if (camera == camera_) return;
  camera_ = std::move(camera);
  if (camera_) focal_ = meanFocal(camera_->calibration());
  reset();
}

void EgoMotionTracker::reset() {
  corners_.clear();
  known_.assign(corners_.size(), Known());
  pairs_.reserve(corners_.size());
  free_pairs_.reserve(corners_.size());
  translation_.setZero();
  rotation_.setZero();
  last_interval_s_ = 0.0;
  last_step_m_ = 0.0;
}

void EgoMotionTracker::rememberPlaces() {
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    known_[i].followed = corners_.corner(i).used;
    known_[i].pixel_before = corners_.corner(i).pixel;
    known_[i].inverse_before = 0.0;
  }
}

void EgoMotionTracker::expect(const Eigen::Matrix3d& rotation, double interval_s) {
  const Eigen::Vector3d step = steadyRatio(interval_s) * (rotation * translation_);
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    CornerTracker::Corner& corner = corners_.corner(i);
    const Known& known = known_[i];
    corner.used = known.followed;
    if (!corner.used) continue;
    corner.expected = known.pixel_before;
    corner.sure = false;
    const std::optional<Eigen::Vector2d> pixel =
        camera_->project(rotation * known.ray + known.inverse_depth * step);
    if (!pixel || !pixel->allFinite()) continue;
    corner.expected = pixel->cast<float>();
    corner.sure = known.inverse_depth > 0.0;
  }
}

void EgoMotionTracker::collectPairs(const Eigen::Matrix3d& rotation) {
  pairs_.clear();
  slots_.clear();
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    CornerTracker::Corner& corner = corners_.corner(i);
    if (!corner.used) continue;
    const std::optional<Eigen::Vector2d> now = camera_->normalize(corner.pixel.cast<double>());
    if (!now) {
      corner.used = false;
      continue;
    }
    PointPair& pair = pairs_.emplace_back();
    pair.before = rotation * known_[i].ray;
    pair.now = now->homogeneous();
    slots_.push_back(i);
  }
}

double EgoMotionTracker::steadyRatio(double interval_s) const {
  return last_interval_s_ > 0.0 ? interval_s / last_interval_s_ : 1.0;
}

Eigen::Matrix3d EgoMotionTracker::steadyRotation(double interval_s) const {
  return so3Exp(steadyRatio(interval_s) * rotation_).toRotationMatrix();
}

std::optional<double> EgoMotionTracker::odometryRatio(const std::optional<Eigen::Vector3d>& step) const {
  if (!step || !(last_step_m_ >= kMinStep) || translation_.isZero()) return std::nullopt;
  return std::min(kMaxRatio, step->norm() / last_step_m_);
}

EgoMotion EgoMotionTracker::follow(const ImagePyramid& pyramid, double interval_s,
                                   const Eigen::Matrix3d& rotation,
                                   const std::optional<MeasuredRotation>& measured, std::size_t min_inliers) {
  expect(rotation, interval_s);
  corners_.follow(pyramid);
  collectPairs(rotation);
  if (pairs_.size() < min_inliers) return {};
  EpipolarEstimator::Prior prior;
  prior.rotation_sigma = kImageSigma;
  if (measured) {
    prior.rotation = so3Log(measured->rotation * rotation.transpose());
    prior.rotation_sigma = kGyroSigma + measured->deviation;
  }
  prior.steady = so3Log(steadyRotation(interval_s) * rotation.transpose());
  prior.translation = rotation * translation_;
  EgoMotion motion = estimator_.estimate(pairs_, focal_, prior);
  if (measured) askCornersAlone(*measured, prior, motion);
  motion.rotates = motion.rotates && motion.inliers >= min_inliers;
  return motion.rotates ? motion : EgoMotion();
}

void EgoMotionTracker::askCornersAlone(const MeasuredRotation& measured, EpipolarEstimator::Prior prior,
                                       EgoMotion& motion) {
  const auto corners = static_cast<double>(pairs_.size());
  if (measured.trusted && static_cast<double>(motion.agreeing) >= kConfirmed * corners) return;
  prior.rotation.setZero();
  prior.rotation_sigma = kImageSigma;
  free_pairs_ = pairs_;
  const EgoMotion alone = estimator_.estimate(free_pairs_, focal_, prior);
  const double lead = static_cast<double>(alone.agreeing) - static_cast<double>(motion.agreeing);
  const bool contradicted = lead > (measured.trusted ? kLeadOverTrusted : kLead) * corners;
  if (!alone.rotates || !(contradicted || (!measured.trusted && !motion.rotates))) return;
  motion = alone;
  pairs_.swap(free_pairs_);
}

double EgoMotionTracker::stepRatio(const EgoMotion& motion, double fallback) {
  ratios_.clear();
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    const double before = known_[slots_[k]].inverse_depth;
    const PointPair& pair = pairs_[k];
    const double movement =
        focal_ * pair.inverse_depth * pair.now.cross(motion.translation).norm() / pair.now.squaredNorm();
    if (pair.inlier && before > 0.0 && movement > kMinMovement)
      ratios_.push_back(pair.inverse_depth / before);
  }
  if (ratios_.size() < kMinRatios) return fallback;
  const auto middle = ratios_.begin() + static_cast<std::ptrdiff_t>(ratios_.size() / 2);
  std::nth_element(ratios_.begin(), middle, ratios_.end());
  return std::clamp(*middle, 1.0 / kMaxRatio, kMaxRatio);
}

void EgoMotionTracker::learnDepths(const EgoMotion& motion, double ratio) {
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    const PointPair& pair = pairs_[k];
    Known& known = known_[slots_[k]];
    if (!pair.inlier) {
      corners_.corner(slots_[k]).used = false;
      continue;
    }
    double inverse = std::max(kMinDepth, pair.inverse_depth);
    if (known.inverse_depth > 0.0) {
      inverse = kNewWeight * inverse + (1.0 - kNewWeight) * ratio * known.inverse_depth;
    }
    known.inverse_before = inverse;
    // As the camera of this image sees it.
    const double depth = pair.before.z() + inverse * motion.translation.z();
    known.inverse_depth = depth > 0.1 ? inverse / depth : 0.0;
  }
}

EgoMotion EgoMotionTracker::followFromElsewhere(const ImagePyramid& pyramid, double interval_s,
                                                const std::optional<MeasuredRotation>& measured,
                                                MotionPrediction& prediction) {
  const Eigen::Matrix3d predicted = prediction.rotation;
  EgoMotion motion;
  const auto tryFrom = [&](const Eigen::Matrix3d& rotation, std::size_t min_inliers) {
    if (motion.rotates || so3Log(rotation * predicted.transpose()).norm() < kOtherRotation) return;
    motion = follow(pyramid, interval_s, rotation, measured, min_inliers);
    if (!motion.rotates) return;
    prediction.rotation = rotation;
    prediction.source = measured ? MotionPrediction::Source::kImu : MotionPrediction::Source::kImage;
  };
  if (measured) {
    tryFrom(measured->rotation, 0);
    return motion;
  }
  tryFrom(steadyRotation(interval_s), 0);
  for (const double yaw : kYaws) {
    for (const double pitch : kPitches) tryFrom(so3Exp({pitch, yaw, 0.0}).toRotationMatrix(), kManyInliers);
  }
  return motion;
}

void EgoMotionTracker::update(const ImagePyramid& pyramid, double interval_s,
                              const std::optional<MeasuredRotation>& measured,
                              const std::optional<Eigen::Vector3d>& step, MotionPrediction& prediction) {
  if (!camera_) return;
  rememberPlaces();
  EgoMotion motion = follow(pyramid, interval_s, prediction.rotation, measured, 0);
  if (!motion.rotates) motion = followFromElsewhere(pyramid, interval_s, measured, prediction);
  if (motion.known()) {
    prediction.rotation = so3Exp(motion.rotation).toRotationMatrix() * prediction.rotation;
    for (PointPair& pair : pairs_) pair.before += motion.rotation.cross(pair.before);
    prediction.step_ratio = translation_.isZero()
                                ? 0.0
                                : stepRatio(motion, odometryRatio(step).value_or(steadyRatio(interval_s)));
    prediction.translation = motion.translation;
    prediction.inliers = motion.inliers;
    learnDepths(motion, prediction.step_ratio);
  } else {
    if (motion.rotates)
      prediction.rotation = so3Exp(motion.rotation).toRotationMatrix() * prediction.rotation;
    for (Known& known : known_) known.inverse_depth = known.inverse_before = 0.0;
    if (step && !motion.rotates && step->norm() >= kMinStep) {
      // Nothing in the image speaks against the odometry.
      prediction.step_ratio = odometryRatio(step).value_or(0.0);
      prediction.translation = step->normalized();
    }
  }
  prediction.confirmed = motion.rotates;
  for (std::size_t k = 0; k < pairs_.size(); ++k) known_[slots_[k]].ray = pairs_[k].now;
  corners_.extractTemplates(pyramid);
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    CornerTracker::Corner& corner = corners_.corner(i);
    if (!corner.used || !corner.fresh) continue;
    const std::optional<Eigen::Vector2d> ray = camera_->normalize(corner.pixel.cast<double>());
    corner.used = ray.has_value();
    known_[i] = Known();
    known_[i].ray = ray.value_or(Eigen::Vector2d::Zero()).homogeneous();
  }
  translation_ = prediction.translation;
  rotation_ = so3Log(prediction.rotation);
  last_interval_s_ = interval_s;
  last_step_m_ = step ? step->norm() : 0.0;
}

std::optional<DepthGuess> EgoMotionTracker::depthNear(const Eigen::Vector2f& pixel) const {
  // The nearest ones count most.
  double weights = 0.0;
  double sum = 0.0;
  double squares = 0.0;
  for (const Known& known : known_) {
    if (!(known.inverse_before > 0.0)) continue;
    const auto distance = static_cast<double>((known.pixel_before - pixel).squaredNorm());
    const double weight = 1.0 / ((distance + 100.0) * (distance + 100.0));
    weights += weight;
    sum += weight * known.inverse_before;
    squares += weight * known.inverse_before * known.inverse_before;
  }
  if (!(weights > 0.0)) return std::nullopt;
  const double mean = sum / weights;
  return DepthGuess{mean, std::max(0.0, squares / weights - mean * mean) + 0.09 * mean * mean};
}

}  // namespace tet_line_tracker
