#include "tet_line_tracker/tracking/line_tracker.h"

#include <algorithm>
#include <bitset>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include "camera/field_of_view.h"
#include "detection/candidate_selector.h"
#include "geometry/segment_index.h"
#include "image/mask.h"
#include "tet_line_tracker/detection/line_detector.h"
#include "tet_line_tracker/flow/endpoint_tracker.h"
#include "tet_line_tracker/image/image_pyramid.h"
#include "tet_line_tracker/motion/motion_prior.h"
#include "tet_line_tracker/refinement/line_refiner.h"
#include "tet_line_tracker/tracking/stream_gate.h"
#include "tracking/mad_threshold.h"
#include "tracking/stopwatch.h"
#include "tracking/worker_pool.h"

namespace tet_line_tracker {
namespace {

const LineTrackerParameters& checked(const LineTrackerParameters& parameters) {
  std::string sentences;
  for (const std::string& broken : check(parameters)) sentences += (sentences.empty() ? "" : "; ") + broken;
  if (!sentences.empty()) throw std::invalid_argument(sentences);
  return parameters;
}

/// What the field of view did to a line.
enum class ViewCut { kNone, kCut, kLeftOut };

/// What a line looked like in the last image.
struct Appearance {
  LineTemplate patches;
  float contrast{0.0F};     ///< across the edge [gray / px]
  float edge_offset{0.0F};  ///< of the edge from where the flow put the line [px]
  /// Movement of both ends beyond what the rotation of the camera explains, from the image before [px]:
  /// parallax, which goes on as it was.
  Eigen::Vector2f start_parallax{Eigen::Vector2f::Zero()};
  Eigen::Vector2f end_parallax{Eigen::Vector2f::Zero()};
  ViewCut view_cut{ViewCut::kNone};
};

/// A new line is this much longer than it must be, and as far inside the border: else noise soon ends it
/// [px].
constexpr float kRoom = 2.0F;

/// Tracks this near to each other follow the same edge.
constexpr SameEdgeLimits kNewLineLimits{};
constexpr SameEdgeLimits kDuplicateLimits{0.05F, 1.5F, 0.3F};

/// What noise moves ends by from image to image, more or less [px].
constexpr float kNoise = 0.25F;

/// `found`, or `before` where the difference may be noise alone: a line that stands still keeps its ends,
/// which would otherwise wander along it.
LineSegment standStill(const LineSegment& before, const LineSegment& found) {
  const bool still = (found.start - before.start).norm() < kNoise && (found.end - before.end).norm() < kNoise;
  return still ? before : found;
}

/// Share of the cells of an 8x6 grid over the image that a line crosses.
float coverageOf(const std::vector<TrackedLine>& lines, int width, int height) {
  constexpr int kColumns = 8;
  constexpr int kRows = 6;
  std::bitset<kColumns * kRows> crossed;
  for (const TrackedLine& line : lines) {
    // Steps of a quarter of the smaller cell side miss only corners that a line barely touches.
    const float cell = std::min(static_cast<float>(width) / kColumns, static_cast<float>(height) / kRows);
    const int steps = 1 + static_cast<int>(4.0F * line.segment.length() / cell);
    for (int i = 0; i <= steps; ++i) {
      const Eigen::Vector2f p = line.segment.at(static_cast<float>(i) / static_cast<float>(steps));
      const int column =
          std::clamp(static_cast<int>(p.x() * kColumns / static_cast<float>(width)), 0, kColumns - 1);
      const int row = std::clamp(static_cast<int>(p.y() * kRows / static_cast<float>(height)), 0, kRows - 1);
      crossed.set(static_cast<std::size_t>(row * kColumns + column));
    }
  }
  return static_cast<float>(crossed.count()) / static_cast<float>(crossed.size());
}

}  // namespace

class LineTracker::Implementation {
 public:
  explicit Implementation(const LineTrackerParameters& parameters)
      : parameters_(checked(parameters)),
        in_force_(parameters.method == "paper" ? asPublished(parameters) : parameters),
        gate_(parameters.stream),
        endpoint_tracker_(in_force_.flow),
        prior_(in_force_.motion),
        refiner_(in_force_.refiner),
        detector_(makeLineDetector(parameters.detection.detector)),
        workers_(parameters.threads) {}

  const LineFrame* process(const cv::Mat& gray, std::int64_t stamp_ns);
  std::size_t reset();
  void setCamera(std::shared_ptr<const CameraModel> camera) {
    if (camera != camera_) field_of_view_.reset();
    prior_.setCamera(camera);
    camera_ = std::move(camera);
  }
  void setMask(const cv::Mat& mask);
  MotionPrior& prior() { return prior_; }
  const LineTrackerParameters& parameters() const { return parameters_; }
  std::string detectorName() const { return detector_->name(); }

 private:
  void trackLines(const MotionPrediction& prediction);
  /// Why the line cannot go on, or kCount.
  /// Touches nothing but the line and its appearance: lines are followed side by side.
  LossReason follow(const MotionPrediction& prediction, TrackedLine& line, Appearance& appearance) const;
  void loseStrays();
  static void keepParallax(const LineSegment& turned, const LineSegment& found, Appearance& appearance);
  bool isPlausible(const LineSegment& expected, const LineSegment& found) const;
  /// Cuts `segment` to what can be normalised; left out, it stays as it is.
  ViewCut cutToView(LineSegment& segment) const;
  void count(ViewCut cut);
  void dropDuplicates();
  bool detectionIsDue();
  void addLines(const cv::Mat& gray);
  /// The edge under a detected segment, when it holds and enough of it can be tracked.
  std::optional<EdgeFit> edgeOf(const cv::Mat& gray, const LineSegment& candidate);
  void describeLines();
  void normalizeEndpoints();

  LineTrackerParameters parameters_;  ///< as given
  LineTrackerParameters in_force_;    ///< what the method makes of them
  StreamGate gate_;
  EndpointTracker endpoint_tracker_;
  MotionPrior prior_;
  LineRefiner refiner_;
  std::unique_ptr<LineDetector> detector_;
  std::shared_ptr<const CameraModel> camera_;
  cv::Mat mask_;           ///< as given
  cv::Mat mask_in_force_;  ///< empty for images of another size

  ImagePyramid pyramid_;
  ImageBounds bounds_;
  std::optional<FieldOfView> field_of_view_;  ///< of camera_ within bounds_
  LineFrame frame_;
  /// Of frame_.lines, in their order; more may wait at the end for reuse.
  std::vector<Appearance> appearances_;
  std::vector<LossReason> reasons_;  ///< of the lines of the image before
  std::vector<float> edge_offsets_;
  WorkerPool workers_;
  std::size_t lines_after_detection_{0};
  float coverage_after_detection_{0.0F};
  int images_since_detection_{0};
  DetectionHints hints_;
  EdgeIndex older_{kDuplicateLimits};  ///< tracked lines before the one that is looked at
  EdgeIndex taken_{kNewLineLimits};    ///< tracked lines and new ones
  std::vector<LineSegment> candidates_;
  SpreadChooser chooser_;
  std::uint64_t next_id_{0};
  bool any_epoch_{false};
  StreamGate::Dropped dropped_before_epoch_;
};

const LineFrame* LineTracker::Implementation::process(const cv::Mat& gray, std::int64_t stamp_ns) {
  if (gray.empty() || gray.type() != CV_8UC1) {
    throw std::invalid_argument("image is " + std::to_string(gray.cols) + "x" + std::to_string(gray.rows) +
                                " of OpenCV type " + std::to_string(gray.type()) +
                                ", needs 8-bit gray (type 0)");
  }
  const StreamVerdict verdict = gate_.admit(stamp_ns, gray.cols, gray.rows);
  if (verdict != StreamVerdict::kTrack && verdict != StreamVerdict::kNewEpoch) return nullptr;

  Stopwatch total;
  Stopwatch stage;
  if (verdict == StreamVerdict::kNewEpoch) {
    if (any_epoch_) ++frame_.epoch;
    any_epoch_ = true;
    frame_.image_count = 0;
    frame_.lines.clear();
    field_of_view_.reset();
    prior_.reset();
    dropped_before_epoch_ = gate_.dropped();
  }
  ++frame_.image_count;
  frame_.stamp_ns = stamp_ns;
  frame_.width = gray.cols;
  frame_.height = gray.rows;
  frame_.detected = false;
  frame_.statistics = FrameStatistics{};
  FrameStatistics& statistics = frame_.statistics;
  bounds_ = ImageBounds::ofImage(gray.cols, gray.rows, static_cast<float>(parameters_.detection.border));
  if (!field_of_view_) field_of_view_.emplace(camera_, bounds_);
  mask_in_force_ = mask_.size() == gray.size() ? mask_ : cv::Mat();

  pyramid_.build(gray, std::max(in_force_.flow.pyramid_levels,
                                in_force_.motion.prior == "none" ? 1 : MotionPrior::kPyramidLevels));
  statistics.pyramid_ms = stage.lap();
  const MotionPrediction prediction = prior_.predict(pyramid_, stamp_ns);
  statistics.prior = prediction.sourceName();
  statistics.prior_rotation = static_cast<float>(prediction.angle());
  statistics.prior_ms = stage.lap();
  trackLines(prediction);
  dropDuplicates();
  statistics.flow_ms = stage.lap() - statistics.refine_ms;
  if (detectionIsDue()) addLines(gray);
  statistics.detect_ms = stage.lap();
  describeLines();
  statistics.flow_ms += stage.lap();
  normalizeEndpoints();
  statistics.undistort_ms = stage.lap();

  statistics.coverage = coverageOf(frame_.lines, gray.cols, gray.rows);
  statistics.dropped_late = gate_.dropped().late - dropped_before_epoch_.late;
  statistics.dropped_duplicate = gate_.dropped().duplicate - dropped_before_epoch_.duplicate;
  statistics.dropped_zero = gate_.dropped().zero - dropped_before_epoch_.zero;
  statistics.total_ms = total.lap();
  return &frame_;
}

void LineTracker::Implementation::setMask(const cv::Mat& mask) {
  if (!mask.empty() && mask.type() != CV_8UC1) {
    throw std::invalid_argument("mask is of OpenCV type " + std::to_string(mask.type()) +
                                ", needs 8-bit gray (type 0)");
  }
  mask_ = mask.clone();
}

std::size_t LineTracker::Implementation::reset() {
  const std::size_t dropped = frame_.lines.size();
  frame_.lines.clear();
  gate_.reset();
  return dropped;
}

void LineTracker::Implementation::trackLines(const MotionPrediction& prediction) {
  FrameStatistics& statistics = frame_.statistics;
  statistics.tracks_before = static_cast<std::uint32_t>(frame_.lines.size());
  reasons_.resize(frame_.lines.size());
  workers_.run(frame_.lines.size(),
               [&](std::size_t i) { reasons_[i] = follow(prediction, frame_.lines[i], appearances_[i]); });
  if (in_force_.refiner.refine) loseStrays();
  std::size_t kept = 0;
  for (std::size_t i = 0; i < frame_.lines.size(); ++i) {
    const LossReason reason = reasons_[i];
    count(appearances_[i].view_cut);
    if (reason != LossReason::kCount) {
      ++statistics.lost[static_cast<std::size_t>(reason)];
      continue;
    }
    if (kept != i) {
      frame_.lines[kept] = frame_.lines[i];
      std::swap(appearances_[kept], appearances_[i]);
    }
    ++kept;
  }
  frame_.lines.resize(kept);
  statistics.tracks_kept = static_cast<std::uint32_t>(kept);
}

LossReason LineTracker::Implementation::follow(const MotionPrediction& prediction, TrackedLine& line,
                                               Appearance& appearance) const {
  appearance.view_cut = ViewCut::kNone;
  const LineSegment turned =
      prior_.apply(prediction, line.segment, line.start_normalized, line.end_normalized);
  const LineSegment expected = {turned.start + appearance.start_parallax,
                                turned.end + appearance.end_parallax};
  const EndpointFlow flow = endpoint_tracker_.track(appearance.patches, pyramid_, expected);
  const bool joint = in_force_.flow.joint_endpoints;
  if (flow.status == EndpointFlow::Status::kNoSolution) return LossReason::kFlow;
  if (flow.status == EndpointFlow::Status::kOutside) return LossReason::kBorder;
  if (flow.status == EndpointFlow::Status::kHighResidual &&
      (!joint || flow.residual > in_force_.plausibility.max_joint_residual)) {
    return LossReason::kResidual;
  }
  line.segment = joint ? standStill(line.segment, flow.segment) : flow.segment;
  line.residual = flow.residual;
  ++line.age;
  const bool paper = in_force_.method == "paper";
  if (paper && !(bounds_.contains(line.segment.start) && bounds_.contains(line.segment.end))) {
    return LossReason::kBorder;
  }
  if (!paper) {
    if (!isPlausible(expected, line.segment)) return LossReason::kLength;
    if (angleBetween(expected, line.segment) > in_force_.plausibility.max_turn) return LossReason::kAngle;
  }
  if (in_force_.refiner.refine) {
    const EdgeFit fit = refiner_.fit(pyramid_.level(0), line.segment, appearance.contrast);
    if (fit.support < in_force_.refiner.min_support) return LossReason::kSupport;
    appearance.edge_offset = std::abs(fit.segment.distance(line.segment.middle()));
    line.segment = fit.segment;
    line.sigma_px = fit.sigma_px;
    appearance.contrast = fit.contrast;
  }
  if (!paper) {
    const std::optional<LineSegment> inside = clip(line.segment, bounds_);
    if (!inside || inside->length() < static_cast<float>(in_force_.detection.min_length)) {
      return inside && inside->length() == line.segment.length() ? LossReason::kLength : LossReason::kBorder;
    }
    line.segment = *inside;
  }
  if (line.segment.length() < static_cast<float>(in_force_.detection.min_length)) return LossReason::kLength;
  appearance.view_cut = cutToView(line.segment);
  if (appearance.view_cut == ViewCut::kLeftOut) return LossReason::kBorder;
  if (!mask_in_force_.empty() && !mostlyInMask(line.segment, mask_in_force_)) return LossReason::kMask;
  if (!paper && in_force_.motion.keep_parallax) keepParallax(turned, line.segment, appearance);
  return LossReason::kCount;
}

/// Lines that jumped to another edge near theirs: flow and edge disagree more than on the other lines.
void LineTracker::Implementation::loseStrays() {
  edge_offsets_.clear();
  for (std::size_t i = 0; i < reasons_.size(); ++i) {
    if (reasons_[i] == LossReason::kCount) edge_offsets_.push_back(appearances_[i].edge_offset);
  }
  const float limit = outlierLimit(edge_offsets_, static_cast<float>(in_force_.plausibility.max_edge_offset));
  for (std::size_t i = 0; i < reasons_.size(); ++i) {
    if (reasons_[i] == LossReason::kCount && appearances_[i].edge_offset > limit) {
      reasons_[i] = LossReason::kGeometry;
    }
  }
}

void LineTracker::Implementation::keepParallax(const LineSegment& turned, const LineSegment& found,
                                               Appearance& appearance) {
  // Across the line alone: along it the flow knows little. Not the whole of it, so that an error dies away.
  constexpr float kShare = 0.8F;
  const Eigen::Vector2f normal = turned.normal();
  appearance.start_parallax = -kShare * found.distance(turned.start) * normal;
  appearance.end_parallax = -kShare * found.distance(turned.end) * normal;
}

bool LineTracker::Implementation::isPlausible(const LineSegment& expected, const LineSegment& found) const {
  const float stretch = static_cast<float>(in_force_.plausibility.max_stretch);
  const float ratio = found.length() / expected.length();
  return ratio < stretch && ratio * stretch > 1.0F;
}

ViewCut LineTracker::Implementation::cutToView(LineSegment& segment) const {
  const std::optional<LineSegment> seen =
      field_of_view_->clip(segment, static_cast<float>(in_force_.detection.min_length));
  if (!seen) return ViewCut::kLeftOut;
  const bool whole = seen->start == segment.start && seen->end == segment.end;
  segment = *seen;
  return whole ? ViewCut::kNone : ViewCut::kCut;
}

void LineTracker::Implementation::count(ViewCut cut) {
  frame_.statistics.lines_cut += cut == ViewCut::kCut ? 1 : 0;
  frame_.statistics.lines_left_out += cut == ViewCut::kLeftOut ? 1 : 0;
}

void LineTracker::Implementation::dropDuplicates() {
  if (in_force_.method == "paper") return;
  older_.clear();
  std::size_t kept = 0;
  for (std::size_t i = 0; i < frame_.lines.size(); ++i) {
    if (older_.holdsEdgeOf(frame_.lines[i].segment)) {
      ++frame_.statistics.lost[static_cast<std::size_t>(LossReason::kDuplicate)];
      continue;
    }
    if (kept != i) {
      frame_.lines[kept] = frame_.lines[i];
      std::swap(appearances_[kept], appearances_[i]);
    }
    older_.add(frame_.lines[kept].segment);
    ++kept;
  }
  frame_.lines.resize(kept);
  frame_.statistics.tracks_kept = static_cast<std::uint32_t>(kept);
}

bool LineTracker::Implementation::detectionIsDue() {
  ++images_since_detection_;
  const std::size_t lines = frame_.lines.size();
  if (in_force_.method == "paper") return lines < static_cast<std::size_t>(in_force_.detection.min_lines);
  if (frame_.image_count == 1) return true;
  if (images_since_detection_ < in_force_.detection.detection_interval) return false;
  // Too few lines, or a part of the image that has lost its lines.
  const double share = in_force_.detection.redetect_share;
  return lines < static_cast<std::size_t>(in_force_.detection.min_lines) ||
         static_cast<double>(lines) < share * static_cast<double>(lines_after_detection_) ||
         coverageOf(frame_.lines, frame_.width, frame_.height) < share * coverage_after_detection_;
}

void LineTracker::Implementation::addLines(const cv::Mat& gray) {
  hints_.mask = mask_in_force_;
  hints_.tracked.clear();
  taken_.clear();
  for (const TrackedLine& line : frame_.lines) {
    hints_.tracked.push_back(line.segment);
    taken_.add(line.segment);
  }
  // A choice of lines is wanted, as some are no good, but the whole of a rich image takes time.
  const std::size_t max_lines = static_cast<std::size_t>(in_force_.detection.max_lines);
  const std::size_t tracked = frame_.lines.size();
  hints_.enough = 2 * (max_lines - std::min(max_lines, tracked)) + 20;
  detector_->detect(gray, static_cast<float>(in_force_.detection.min_length), candidates_, hints_);
  frame_.detected = true;
  frame_.statistics.lines_detected = static_cast<std::uint32_t>(candidates_.size());

  // Long and well spread ones first, until there is no more room. The cheap test before the fit, and again
  // after it.
  chooser_.start(frame_.width, frame_.height, candidates_);
  for (const LineSegment& line : hints_.tracked) chooser_.add(line);
  while (frame_.lines.size() < max_lines) {
    const LineSegment* candidate = chooser_.next();
    if (candidate == nullptr) break;
    if (taken_.holdsEdgeOf(*candidate)) continue;
    const std::optional<EdgeFit> edge = edgeOf(gray, *candidate);
    if (!edge || taken_.holdsEdgeOf(edge->segment)) continue;
    taken_.add(edge->segment);
    chooser_.add(edge->segment);
    TrackedLine line;
    line.id = next_id_++;
    line.segment = edge->segment;
    frame_.lines.push_back(line);
    if (appearances_.size() < frame_.lines.size()) appearances_.resize(frame_.lines.size());
    Appearance& appearance = appearances_[frame_.lines.size() - 1];
    appearance.contrast = edge->contrast;
    appearance.start_parallax.setZero();
    appearance.end_parallax.setZero();
  }
  frame_.statistics.lines_added = static_cast<std::uint32_t>(frame_.lines.size() - tracked);
  lines_after_detection_ = frame_.lines.size();
  coverage_after_detection_ = coverageOf(frame_.lines, frame_.width, frame_.height);
  images_since_detection_ = 0;
}

std::optional<EdgeFit> LineTracker::Implementation::edgeOf(const cv::Mat& gray,
                                                           const LineSegment& candidate) {
  EdgeFit edge;
  edge.segment = candidate;
  edge.contrast = refiner_.contrastOf(gray, candidate);
  if (in_force_.refiner.refine) {
    edge = refiner_.fit(gray, candidate, edge.contrast);
    if (edge.support < in_force_.detection.min_new_support) return std::nullopt;
  }
  const float room = in_force_.method == "paper" ? 0.0F : kRoom;
  const ImageBounds bounds =
      ImageBounds::ofImage(gray.cols, gray.rows, static_cast<float>(in_force_.detection.border) + room);
  const std::optional<LineSegment> inside = clip(edge.segment, bounds);
  if (!inside || inside->length() < static_cast<float>(in_force_.detection.min_length) + room) {
    return std::nullopt;
  }
  edge.segment = *inside;
  const ViewCut cut = cutToView(edge.segment);
  count(cut);
  if (cut == ViewCut::kLeftOut) return std::nullopt;
  return edge;
}

void LineTracker::Implementation::describeLines() {
  workers_.run(frame_.lines.size(), [this](std::size_t i) {
    endpoint_tracker_.describe(pyramid_, frame_.lines[i].segment, appearances_[i].patches);
  });
}

void LineTracker::Implementation::normalizeEndpoints() {
  const Eigen::Vector2d unknown = Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
  for (TrackedLine& line : frame_.lines) {
    const auto normalized = [&](const Eigen::Vector2f& pixel) -> Eigen::Vector2d {
      return camera_ ? camera_->normalize(pixel.cast<double>()).value_or(unknown) : unknown;
    };
    line.start_normalized = normalized(line.segment.start);
    line.end_normalized = normalized(line.segment.end);
  }
}

LineTracker::LineTracker(const LineTrackerParameters& parameters)
    : implementation_(std::make_unique<Implementation>(parameters)) {}
LineTracker::~LineTracker() = default;
LineTracker::LineTracker(LineTracker&&) noexcept = default;
LineTracker& LineTracker::operator=(LineTracker&&) noexcept = default;

const LineFrame* LineTracker::process(const cv::Mat& gray, std::int64_t stamp_ns) {
  return implementation_->process(gray, stamp_ns);
}
void LineTracker::setCamera(std::shared_ptr<const CameraModel> camera) {
  implementation_->setCamera(std::move(camera));
}
void LineTracker::setMask(const cv::Mat& mask) {
  implementation_->setMask(mask);
}
void LineTracker::setImuRotation(const Eigen::Matrix3d& camera_from_imu) {
  implementation_->prior().setImuRotation(camera_from_imu);
}
void LineTracker::addAngularVelocity(std::int64_t stamp_ns, const Eigen::Vector3d& angular_velocity) {
  implementation_->prior().addAngularVelocity(stamp_ns, angular_velocity);
}
std::size_t LineTracker::reset() {
  return implementation_->reset();
}
const LineTrackerParameters& LineTracker::parameters() const {
  return implementation_->parameters();
}
std::string LineTracker::detectorName() const {
  return implementation_->detectorName();
}

}  // namespace tet_line_tracker
