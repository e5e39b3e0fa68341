#include "tet_line_tracker/refinement/line_refiner.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/clamp.h"
#include "kernels/kernels.h"

namespace tet_line_tracker {
namespace {

constexpr int kMaxSamples = 48;
constexpr int kMinSamples = 6;
constexpr float kSampleSpacing = 2.0F;     // along the line, more on long ones [px]
constexpr float kOnEdge = 1.0F;            // a sample this near the fitted line lies on the edge [px]
constexpr float kMinContrastShare = 0.3F;  // of the contrast of the edge before
// What the edge must be where a line is to go on: clearly more than noise.
constexpr float kOnEdgeAhead = 0.75F;   // [px]
constexpr float kMinReachShare = 0.5F;  // of the contrast of the line
constexpr float kMinReachSlope = 1.5F;  // [gray / px]
constexpr float kMinSlope = 0.8F;       // slower slopes are noise in any picture [gray / px]
constexpr float kPeakShare = 0.3F;      // of the slope of the peak: what is under it does not pull its middle
constexpr float kSigmaFloor = 0.009F;   // what sampling and rounding leave on a perfect edge [px]
constexpr float kCorrelation =
    1.7F;  // variance of the fit over that of independent samples: neighbours err alike
// Share of that variance that is new in each image: pixels and texture make the rest, which stays.
constexpr float kNoiseShare = 0.6F;

// The steep part of a blurred edge is not symmetrical: light falls off to one side, the gray values are a
// curved function of it, or another edge is near. Where its middle lies is then off by a share of its width,
// alike along the line.
constexpr float kSharpWidth = 2.3F;     // narrower edges are symmetrical enough [px]
constexpr float kBiasPerWidth = 0.25F;  // deviation of the place per width beyond
constexpr float kBiasTilt = 0.25F;      // variance of the tilt over that of the offset

/// What profiles across the line found, from start to end; room for whole vectors.
struct Samples {
  static constexpr std::size_t kCapacity = kMaxSamples + kernels::kLanes;
  std::array<float, kCapacity> places;   ///< along the line, -1 at start to 1 at end
  std::array<float, kCapacity> offsets;  ///< of the edge from the line, along the normal [px]
  std::array<float, kCapacity>
      slopes;  ///< of the edge, positive when of the right polarity [gray / px]; 0: none found
  std::array<float, kCapacity> widths;  ///< of the edge across it [px]
  int count{0};
};

constexpr float kFarOutside = 1e6F;  // no image reaches so far [px]

/// Whether the pixels of `line` can be counted: it is finite, longer than a pixel, and not too far outside.
bool canBeSampled(const LineSegment& line) {
  return (line.start.array().abs() < kFarOutside).all() && (line.end.array().abs() < kFarOutside).all() &&
         line.length() > 1.0F;
}

/// Profiles along the image axis that is nearer to the normal: whole pixels, no interpolation.
class ProfileSampler {
 public:
  ProfileSampler(const cv::Mat& gray, const LineCurve& curve, float polarity, float search_px)
      : gray_(gray), length_(curve.chord.length()), bend_(curve.bend) {
    const LineSegment& line = curve.chord;
    const Eigen::Vector2f direction = line.direction();
    flat_ = std::abs(direction.x()) >= std::abs(direction.y());
    start_main_ = flat_ ? line.start.x() : line.start.y();
    start_cross_ = flat_ ? line.start.y() : line.start.x();
    main_per_along_ = flat_ ? direction.x() : direction.y();
    cross_per_main_ = (flat_ ? direction.y() : direction.x()) / main_per_along_;
    const Eigen::Vector2f normal = line.normal();
    normal_share_ = flat_ ? normal.y() : normal.x();
    along_per_cross_ = flat_ ? direction.y() : direction.x();
    const int reach = static_cast<int>(std::ceil(search_px / std::abs(normal_share_)));
    reach_ = std::min(reach, (kernels::kMaxProfile - 3) / 2);
    batch_.step = flat_ ? static_cast<std::ptrdiff_t>(gray.step[0]) : 1;
    batch_.count = 2 * reach_ + 3;
    // Along the profile's axis the gray values rise towards the normal's side.
    batch_.polarity = normal_share_ * polarity > 0.0F ? 1.0F : -1.0F;
    batch_.distance_scale = normal_share_ / search_px;
    batch_.peak_share = kPeakShare;
  }

  /// Takes `count` samples evenly along the line; those whose profile leaves the image are left out.
  void take(int count, Samples& samples) {
    const std::size_t wanted = static_cast<std::size_t>(count);
    const float spacing = length_ / static_cast<float>(count);
    const bool bent = !bend_.isStraight();
    std::array<float, Samples::kCapacity> crosses;
    for (std::size_t i = 0; i < wanted; ++i) {
      const float along = (static_cast<float>(i) + 0.5F) * spacing;
      mains_[i] = nearestPixel(start_main_ + along * main_per_along_);
      crosses[i] = start_cross_ + (static_cast<float>(mains_[i]) - start_main_) * cross_per_main_;
      samples.places[i] = 2.0F * along / length_ - 1.0F;
    }
    if (bent) moveToCurve(wanted, crosses, samples);
    for (std::size_t i = 0; i < wanted; ++i) {
      begins_[i] = nearestPixel(crosses[i]) - reach_ - 1;
      centres_[i] = crosses[i] - static_cast<float>(begins_[i]);
    }
    // A straight line with both ends inside is all inside.
    std::size_t kept = wanted;
    if (bent || !inside(0) || !inside(wanted - 1)) {
      kept = 0;
      for (std::size_t i = 0; i < wanted; ++i) {
        if (!inside(i)) continue;
        samples.places[kept] = samples.places[i];
        mains_[kept] = mains_[i];
        begins_[kept] = begins_[i];
        centres_[kept++] = centres_[i];
      }
    }
    samples.count = static_cast<int>(kept);
    for (std::size_t i = 0; i < kept; i += kernels::kLanes) find(i, kept, samples);
    for (std::size_t i = 0; i < kept; ++i) {
      samples.offsets[i] = (samples.offsets[i] - centres_[i]) * normal_share_;
      samples.widths[i] *= std::abs(normal_share_);
    }
    for (std::size_t i = kept; i < kept + kernels::kLanes; ++i) {
      samples.places[i] = samples.offsets[i] = samples.widths[i] = 0.0F;
      samples.slopes[i] = -1.0F;
    }
  }

 private:
  /// Rounds what lies in an image or not too far left of it; what is farther, as a bend may be that goes on
  /// beyond its ends, stays outside.
  static int nearestPixel(float place) {
    constexpr int kShift = 1 << 12;
    const float near = clampOrLow(place, -static_cast<float>(kShift), kFarOutside);
    return static_cast<int>(near + (static_cast<float>(kShift) + 0.5F)) - kShift;
  }

  using Floats = std::array<float, Samples::kCapacity>;

  /// Moves the crossings of the profiles from the chord to the curve; sets their places along the line. In
  /// loops over all samples, which compilers turn into vectors.
  void moveToCurve(std::size_t count, Floats& crosses, Samples& samples) const {
    const float share_per_main = 1.0F / (main_per_along_ * length_);
    const float cross_per_offset = 1.0F / normal_share_;
    // The profile is not along the normal: it meets the curve beside where it meets the chord.
    const float share_per_offset = cross_per_offset * along_per_cross_ / length_;
    Floats fractions, offsets;
    for (std::size_t i = 0; i < count; ++i) {
      fractions[i] = (static_cast<float>(mains_[i]) - start_main_) * share_per_main;
    }
    findOffsets(count, fractions, offsets);
    for (std::size_t i = 0; i < count; ++i) fractions[i] += offsets[i] * share_per_offset;
    findOffsets(count, fractions, offsets);
    for (std::size_t i = 0; i < count; ++i) {
      samples.places[i] = 2.0F * fractions[i] - 1.0F;
      crosses[i] += offsets[i] * cross_per_offset;
    }
  }

  /// LineBend::offset() of many fractions.
  void findOffsets(std::size_t count, const Floats& fractions, Floats& offsets) const {
    for (std::size_t i = 0; i < count; ++i) offsets[i] = bend_.c[bend_.terms - 1];
    for (std::size_t k = bend_.terms - 1; k-- > 0;) {
      const float c = bend_.c[k];
      for (std::size_t i = 0; i < count; ++i) offsets[i] = offsets[i] * (2.0F * fractions[i] - 1.0F) + c;
    }
    for (std::size_t i = 0; i < count; ++i) offsets[i] *= fractions[i] * (1.0F - fractions[i]);
  }

  bool inside(std::size_t i) const {
    const int main_size = flat_ ? gray_.cols : gray_.rows;
    const int cross_size = flat_ ? gray_.rows : gray_.cols;
    return mains_[i] >= 0 && mains_[i] < main_size && begins_[i] >= 0 &&
           begins_[i] + batch_.count <= cross_size;
  }

  /// Eight profiles from number `first` on; the last one fills up.
  void find(std::size_t first, std::size_t count, Samples& samples) {
    for (std::size_t lane = 0; lane < kernels::kLanes; ++lane) {
      const std::size_t i = std::min(first + lane, count - 1);
      batch_.pixels[lane] = flat_ ? gray_.ptr<std::uint8_t>(begins_[i]) + mains_[i]
                                  : gray_.ptr<std::uint8_t>(mains_[i]) + begins_[i];
      batch_.centre[lane] = centres_[i];
    }
    kernels::active().findEdges(batch_, samples.offsets.data() + first, samples.slopes.data() + first,
                                samples.widths.data() + first);
  }

  const cv::Mat& gray_;
  float length_;
  LineBend bend_;
  bool flat_;                       ///< the main axis is x
  float start_main_, start_cross_;  ///< [px]
  float main_per_along_, cross_per_main_;
  float normal_share_;
  float along_per_cross_;
  int reach_;
  kernels::ProfileBatch batch_{};
  std::array<int, Samples::kCapacity> mains_, begins_;
  std::array<float, Samples::kCapacity> centres_;
};

/// Offset and tilt with their cofactors: covariances for samples of variance 1.
struct WeightedFit {
  kernels::OffsetFit line;
  float offset_offset{0.0F}, offset_tilt{0.0F}, tilt_tilt{0.0F};
};

/// Iteratively re-weighted least squares with Tukey's weights, from wide to narrow.
WeightedFit fitOffsets(const kernels::EdgeSamples& samples, float min_slope) {
  WeightedFit weighted;
  kernels::OffsetFit& fit = weighted.line;
  for (const float width : {4.0F, 3.0F, 2.0F, 1.5F, 1.5F}) {
    std::array<float, 5> sums;
    kernels::active().sumOffsets(samples, fit, width, min_slope, sums.data());
    const auto [w, wp, wpp, wo, wpo] = sums;
    const float determinant = w * wpp - wp * wp;
    if (determinant < 1e-3F) break;
    fit.offset = (wpp * wo - wp * wpo) / determinant;
    fit.tilt = (w * wpo - wp * wo) / determinant;
    weighted.offset_offset = wpp / determinant;
    weighted.offset_tilt = -wp / determinant;
    weighted.tilt_tilt = w / determinant;
  }
  return weighted;
}

/// Covariance of the distances at -1 and 1 from that of offset and tilt: var(start), cov, var(end).
std::array<float, 3> covarianceOfEnds(float offset_offset, float offset_tilt, float tilt_tilt) {
  const float twice = 2.0F * offset_tilt;
  return {offset_offset - twice + tilt_tilt, offset_offset - tilt_tilt, offset_offset + twice + tilt_tilt};
}

}  // namespace

float LineRefiner::contrastOf(const cv::Mat& gray, const LineCurve& line) const {
  if (!canBeSampled(line.chord)) return 0.0F;
  constexpr int kCount = 2 * kernels::kLanes;
  ProfileSampler sampler(gray, line, 1.0F, 1.5F);
  Samples samples;
  sampler.take(kCount, samples);
  if (samples.count < kCount / 2) return 0.0F;
  const auto middle = samples.slopes.begin() + samples.count / 2;
  std::nth_element(samples.slopes.begin(), middle, samples.slopes.begin() + samples.count);
  return *middle;
}

float LineRefiner::reachOf(const cv::Mat& gray, const LineCurve& ahead, float contrast, float max_gap) const {
  const float length = ahead.chord.length();
  if (!canBeSampled(ahead.chord)) return 0.0F;
  const int wanted = std::clamp(static_cast<int>(length / kSampleSpacing), 1, kMaxSamples);
  const float spacing = length / static_cast<float>(wanted);
  const float min_slope = std::max(kMinReachSlope, kMinReachShare * std::abs(contrast));
  ProfileSampler sampler(gray, ahead, contrast, static_cast<float>(parameters_.search_px));
  Samples samples;
  sampler.take(wanted, samples);
  float reach = 0.0F;  // of what belongs to the edge
  float last = 0.0F;   // where the edge was found last
  float gap = 0.0F;    // the longest one that is not made up for, and what was found behind it
  float behind = 0.0F;
  for (std::size_t i = 0; i < static_cast<std::size_t>(samples.count); ++i) {
    const float place = 0.5F * (samples.places[i] + 1.0F) * length;
    if (place - last > max_gap + spacing) break;
    if (samples.slopes[i] < min_slope || std::abs(samples.offsets[i]) > kOnEdgeAhead) continue;
    if (place - last > 1.5F * spacing) {
      gap = std::max(gap, place - last - spacing);
      behind = 0.0F;
    }
    behind += spacing;
    last = place;
    if (behind < 2.0F * gap) continue;
    gap = 0.0F;
    reach = place;
  }
  return reach > length - spacing ? length : reach;  // the last sample stands for the rest
}

EdgeFit LineRefiner::fit(const cv::Mat& gray, const LineCurve& curve, float contrast) const {
  EdgeFit result;
  const LineSegment& line = curve.chord;
  result.segment = line;
  const float length = line.length();
  if (!canBeSampled(line)) return result;
  ProfileSampler sampler(gray, curve, contrast, static_cast<float>(parameters_.search_px));
  const float min_slope = std::max(kMinSlope, kMinContrastShare * std::abs(contrast));

  const int wanted = std::clamp(static_cast<int>(length / kSampleSpacing), kMinSamples, kMaxSamples);
  Samples samples;
  sampler.take(wanted, samples);
  if (samples.count < kMinSamples) return result;

  const kernels::EdgeSamples found{samples.places.data(), samples.offsets.data(), samples.slopes.data(),
                                   samples.widths.data(), samples.count};
  const WeightedFit weighted = fitOffsets(found, min_slope);
  const kernels::OffsetFit& fit = weighted.line;
  std::array<float, 4> sums;
  kernels::active().sumSupport(found, fit, kOnEdge, min_slope, sums.data());
  const auto [supported, slopes, squares, widths] = sums;
  if (supported < 4.0F) return result;
  result.support = supported / static_cast<float>(samples.count);
  if (result.support < static_cast<float>(parameters_.min_support)) return result;

  result.contrast = std::copysign(slopes / supported, contrast);
  const float variance = kCorrelation * squares / (supported - 2.0F);
  constexpr float kFloor = kSigmaFloor * kSigmaFloor;
  const float bias = kBiasPerWidth * std::max(0.0F, widths / supported - kSharpWidth);
  const float blur = bias * bias;
  result.sigma_px = std::sqrt(kFloor + blur + variance / supported);
  // Of the ends, at -1 and 1. The floor is of offset and tilt alike: a sampling error differs along the line.
  const float offsets = variance * weighted.offset_offset + kFloor + blur;
  const float tilts = variance * weighted.tilt_tilt + kFloor + kBiasTilt * blur;
  result.covariance_px = covarianceOfEnds(offsets, variance * weighted.offset_tilt, tilts);
  result.noise_px = covarianceOfEnds(weighted.offset_offset, weighted.offset_tilt, weighted.tilt_tilt);
  for (float& element : result.noise_px) element *= kNoiseShare * variance;
  const Eigen::Vector2f normal = line.normal();
  result.segment = {line.start + fit.at(-1.0F) * normal, line.end + fit.at(1.0F) * normal};
  return result;
}

}  // namespace tet_line_tracker
