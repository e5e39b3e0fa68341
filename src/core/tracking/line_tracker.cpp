#include "tet_line_tracker/tracking/line_tracker.h"

#include <cmath>
#include <functional>
#include <optional>
#include <utility>

#include <Eigen/Geometry>

#include "tet_line_tracker/image/image_pyramid.h"
#include "tet_line_tracker/tracking/frame_sequence.h"
#include "tracking/stopwatch.h"
#include "tracking/track_follower.h"
#include "tracking/track_refiner.h"
#include "tracking/track_table.h"
#include "tracking/tracking_method.h"
#include "tracking/visible_area.h"
#include "tracking/worker_pool.h"

namespace tet_line_tracker {

class LineTracker::Implementation {
 public:
  explicit Implementation(const LineTrackerParameters& parameters)
      : parameters_(parameters),
        method_(makeTrackingMethod(parameters)),
        frames_(parameters.stream),
        prior_(method_.motion),
        area_(parameters.detection.border),
        workers_(std::make_unique<WorkerPool>(parameters.threads)) {}

  FrameResult process(const cv::Mat& gray, std::int64_t stamp_ns);
  std::size_t reset() {
    tracks_.clear();
    return frames_.reset();
  }
  bool setParameters(const LineTrackerParameters& parameters);
  void setCamera(std::shared_ptr<const CameraModel> camera);
  void setMask(const cv::Mat& mask) { area_.setMask(mask); }
  bool usesImu() const { return method_.motion.prior == "imu" || method_.motion.prior == "auto"; }
  bool usesOdometry() const { return method_.motion.prior == "odometry"; }
  MotionPrior& prior() { return prior_; }
  const LineTrackerParameters& parameters() const { return parameters_; }
  std::string detectorName() const { return method_.initializer->detectorName(); }
  const std::vector<std::string>& notes() const { return method_.notes; }

 private:
  void startEpoch();
  void follow(const MotionPrediction& motion);
  void refine();
  void check();
  void detect(const cv::Mat& gray);
  void extractTemplates();
  void markCuts();

  LineTrackerParameters parameters_;
  TrackingMethod method_;
  FrameSequence frames_;
  MotionPrior prior_;
  std::shared_ptr<const CameraModel> camera_;
  VisibleArea area_;

  ImagePyramid pyramid_;
  ImagePyramid pyramid_before_;  ///< of the image before; its level 0 is gone
  TrackTable tracks_;
  DetectionState detection_;
  std::unique_ptr<WorkerPool> workers_;
};

FrameResult LineTracker::Implementation::process(const cv::Mat& gray, std::int64_t stamp_ns) {
  const StreamVerdict verdict = frames_.begin(gray, stamp_ns);
  if (isDropped(verdict)) return {verdict, nullptr};
  Stopwatch total;
  Stopwatch stage;
  if (verdict == StreamVerdict::kNewEpoch) startEpoch();
  LineFrame& frame = frames_.frame();
  FrameStatistics& statistics = frame.statistics;
  area_.setImageSize(gray.size());

  std::swap(pyramid_, pyramid_before_);
  pyramid_.build(gray, method_.pyramid_levels);
  statistics.pyramid_ms = stage.lap();
  const MotionPrediction motion = prior_.predict(pyramid_, stamp_ns);
  statistics.prior = motion.sourceName();
  statistics.prior_rotation = static_cast<float>(motion.angle());
  statistics.imu_time_offset = prior_.imuTimeOffset();
  Eigen::Map<Eigen::Vector3f>(statistics.translation.data()) = motion.translation.cast<float>();
  statistics.translation_inliers = static_cast<std::uint32_t>(motion.inliers);
  statistics.prior_ms = stage.lap();
  follow(motion);
  statistics.flow_ms = stage.lap();
  refine();
  statistics.refine_ms = stage.lap();
  normalizeEndpoints(camera_.get(), tracks_.lines());
  tracks_.measureDepths(motion, prior_.focal());
  check();
  if (method_.motion.predict_parallax) tracks_.predictParallax();
  statistics.flow_ms += stage.lap();
  detect(gray);
  statistics.detect_ms = stage.lap();
  extractTemplates();
  statistics.flow_ms += stage.lap();
  normalizeMissingEndpoints(camera_.get(), tracks_.lines());
  markCuts();
  frame.lines = tracks_.lines();
  statistics.undistort_ms = stage.lap();
  statistics.total_ms = total.lap();
  return {verdict, &frame};
}

void LineTracker::Implementation::setCamera(std::shared_ptr<const CameraModel> camera) {
  prior_.setCamera(camera);
  area_.setCamera(camera);
  camera_ = std::move(camera);
}

bool LineTracker::Implementation::setParameters(const LineTrackerParameters& parameters) {
  // What may throw comes before what changes.
  TrackingMethod method = makeTrackingMethod(parameters);
  std::unique_ptr<WorkerPool> workers;
  if (parameters.threads != parameters_.threads) workers = std::make_unique<WorkerPool>(parameters.threads);
  const bool new_epoch = needsNewEpoch(parameters_, parameters);
  if (new_epoch) reset();
  parameters_ = parameters;
  method_ = std::move(method);
  frames_.setParameters(parameters.stream);
  prior_.setParameters(method_.motion);
  area_.setBorder(parameters.detection.border);
  if (workers) workers_ = std::move(workers);
  if (!method_.motion.predict_parallax) tracks_.forgetParallax();
  return new_epoch;
}

void LineTracker::Implementation::startEpoch() {
  tracks_.clear();
  prior_.reset();
  detection_.images_in_epoch = 0;
}

void LineTracker::Implementation::follow(const MotionPrediction& motion) {
  const TrackFollower follower(method_, prior_, area_, pyramid_before_);
  const auto followOne = [&](std::size_t i) {
    follower.follow(motion, pyramid_, tracks_.line(i), tracks_.state(i));
  };
  // By reference: the function is too large to be copied without heap.
  workers_->run(tracks_.size(), std::cref(followOne));
}

void LineTracker::Implementation::refine() {
  if (!method_.refiner) return;
  const TrackRefiner refiner(method_, area_, parameters_);
  const std::uint64_t number = frames_.frame().image_count;
  const auto refineOne = [&](std::size_t i) {
    if (!tracks_.state(i).lost()) {
      refiner.refine(pyramid_.level(0), number, tracks_.line(i), tracks_.state(i));
    }
  };
  workers_->run(tracks_.size(), std::cref(refineOne));
}

void LineTracker::Implementation::check() {
  LineFrame& frame = frames_.frame();
  for (const auto& check : method_.checks) check->apply(area_, tracks_, frame.statistics);
  tracks_.removeLost(frame);
}

void LineTracker::Implementation::detect(const cv::Mat& gray) {
  LineFrame& frame = frames_.frame();
  detection_.images_in_epoch = frame.image_count;
  ++detection_.images_since_detection;
  detection_.lines = tracks_.size();
  detection_.coverage = tracks_.coverage(gray.size());
  if (method_.detection_policy->isDue(detection_)) {
    method_.initializer->addTracks(gray, area_, tracks_, frame.statistics);
    frame.detected = true;
    detection_.setDetected(tracks_.size(), tracks_.coverage(gray.size()));
  }
  frame.statistics.coverage = detection_.coverage;
}

void LineTracker::Implementation::markCuts() {
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    tracks_.line(i).cut = area_.cutsOf({tracks_.line(i).segment, tracks_.state(i).bend});
  }
}

void LineTracker::Implementation::extractTemplates() {
  const TrackFollower follower(method_, prior_, area_, pyramid_before_);
  const auto renew = [&](auto i) { follower.renewTemplate(pyramid_, tracks_.line(i), tracks_.state(i)); };
  workers_->run(tracks_.size(), std::cref(renew));
}

LineTracker::LineTracker(const LineTrackerParameters& parameters)
    : implementation_(std::make_unique<Implementation>(parameters)) {}
LineTracker::~LineTracker() = default;
LineTracker::LineTracker(LineTracker&&) noexcept = default;
LineTracker& LineTracker::operator=(LineTracker&&) noexcept = default;

FrameResult LineTracker::process(const cv::Mat& gray, std::int64_t stamp_ns) {
  return implementation_->process(gray, stamp_ns);
}
void LineTracker::setCamera(std::shared_ptr<const CameraModel> camera) {
  implementation_->setCamera(std::move(camera));
}
void LineTracker::setMask(const cv::Mat& mask) {
  implementation_->setMask(mask);
}
bool LineTracker::usesImu() const {
  return implementation_->usesImu();
}
void LineTracker::setImuRotation(const Eigen::Matrix3d& camera_from_imu) {
  implementation_->prior().setImuRotation(camera_from_imu);
}
void LineTracker::addAngularVelocity(std::int64_t stamp_ns, const Eigen::Vector3d& angular_velocity) {
  implementation_->prior().addAngularVelocity(stamp_ns, angular_velocity);
}
bool LineTracker::usesOdometry() const {
  return implementation_->usesOdometry();
}
void LineTracker::setOdometryExtrinsic(const Eigen::Isometry3d& camera_from_body) {
  implementation_->prior().setOdometryExtrinsic(camera_from_body);
}
void LineTracker::addOdometry(std::int64_t stamp_ns, const Eigen::Isometry3d& odometry_from_body) {
  implementation_->prior().addOdometry(stamp_ns, odometry_from_body);
}
std::int64_t LineTracker::imuStamp(std::int64_t image_stamp_ns) const {
  return image_stamp_ns + std::llround(1e9 * implementation_->prior().imuTimeOffset());
}
Eigen::Vector3d LineTracker::gyroBias() const {
  return implementation_->prior().gyroBias();
}
bool LineTracker::setParameters(const LineTrackerParameters& parameters) {
  return implementation_->setParameters(parameters);
}
std::size_t LineTracker::reset() {
  return implementation_->reset();
}
const LineTrackerParameters& LineTracker::parameters() const {
  return implementation_->parameters();
}
const std::vector<std::string>& LineTracker::notes() const {
  return implementation_->notes();
}
std::string LineTracker::detectorName() const {
  return implementation_->detectorName();
}

}  // namespace tet_line_tracker
