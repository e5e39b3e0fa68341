#include "tet_line_tracker/line_refiner.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "kernels/kernels.h"

namespace tet_line_tracker {
namespace {

constexpr int kMaxInner = 48;
constexpr int kMinInner = 6;
constexpr int kMaxBeyond = 4;              // samples beyond each end
constexpr float kSampleSpacing = 2.0F;     // along the line, more on long ones [px]
constexpr float kEndReach = 4.0F;          // an end follows its edge this far in one image [px]
constexpr float kOnEdge = 1.0F;            // a sample this near the fitted line lies on the edge [px]
constexpr float kMinContrastShare = 0.3F;  // of the contrast of the edge before
constexpr float kMinSlope = 0.8F;          // slower slopes are noise in any picture [gray / px]
constexpr float kPeakShare = 0.3F;     // of the slope of the peak: what is under it does not pull its middle
constexpr float kSigmaFloor = 0.025F;  // what sampling and rounding leave on a perfect edge [px]

/// What profiles across the line found, from start to end; room for whole vectors.
struct Samples {
  static constexpr int kCapacity = kMaxInner + 2 * kMaxBeyond + kernels::kLanes;
  std::array<float, kCapacity> along;    ///< from start [px]
  std::array<float, kCapacity> places;   ///< along the line, -1 at start to 1 at end
  std::array<float, kCapacity> offsets;  ///< of the edge from the line, along the normal [px]
  std::array<float, kCapacity>
      slopes;  ///< of the edge, positive when of the right polarity [gray / px]; 0: none found
  int count{0};
};

/// Profiles along the image axis that is nearer to the normal: whole pixels, no interpolation.
class ProfileSampler {
 public:
  ProfileSampler(const cv::Mat& gray, const LineSegment& line, float polarity, float search_px)
      : gray_(gray), start_(line.start), direction_(line.direction()), length_(line.length()) {
    flat_ = std::abs(direction_.x()) >= std::abs(direction_.y());
    cross_per_main_ = flat_ ? direction_.y() / direction_.x() : direction_.x() / direction_.y();
    const Eigen::Vector2f normal = line.normal();
    normal_share_ = flat_ ? normal.y() : normal.x();
    const int reach = static_cast<int>(std::ceil(search_px / std::abs(normal_share_)));
    reach_ = std::min(reach, (kernels::kMaxProfile - 3) / 2);
    batch_.step = flat_ ? static_cast<std::ptrdiff_t>(gray.step[0]) : 1;
    batch_.count = 2 * reach_ + 3;
    // Along the profile's axis the gray values rise towards the normal's side.
    batch_.polarity = normal_share_ * polarity > 0.0F ? 1.0F : -1.0F;
    batch_.distance_scale = normal_share_ / search_px;
    batch_.peak_share = kPeakShare;
  }

  /// Adds a sample at `along` from start [px]; false when its profile leaves the image.
  bool add(float along, Samples& samples) {
    const Eigen::Vector2f on_line = start_ + along * direction_;
    const float main_place = flat_ ? on_line.x() : on_line.y();
    const int main_pixel = static_cast<int>(std::floor(main_place + 0.5F));
    const float cross =
        (flat_ ? on_line.y() : on_line.x()) + (static_cast<float>(main_pixel) - main_place) * cross_per_main_;
    const int first = static_cast<int>(std::floor(cross + 0.5F)) - reach_ - 1;
    const int main_size = flat_ ? gray_.cols : gray_.rows;
    const int cross_size = flat_ ? gray_.rows : gray_.cols;
    if (main_pixel < 0 || main_pixel >= main_size || first < 0 || first + batch_.count > cross_size)
      return false;
    batch_.pixels[waiting_] =
        flat_ ? gray_.ptr<std::uint8_t>(first) + main_pixel : gray_.ptr<std::uint8_t>(main_pixel) + first;
    batch_.centre[waiting_] = cross - static_cast<float>(first);
    const std::size_t i = static_cast<std::size_t>(samples.count);
    samples.along[i] = along;
    samples.places[i] = 2.0F * along / length_ - 1.0F;
    ++samples.count;
    if (++waiting_ == kernels::kLanes) find(samples);
    return true;
  }

  /// Looks for the edge in the profiles that still wait.
  void finish(Samples& samples) {
    if (waiting_ > 0) find(samples);
    for (std::size_t i = 0; i < kernels::kLanes; ++i) {
      const std::size_t beyond = static_cast<std::size_t>(samples.count) + i;
      samples.places[beyond] = samples.offsets[beyond] = 0.0F;
      samples.slopes[beyond] = -1.0F;
    }
  }

 private:
  void find(Samples& samples) {
    for (int lane = waiting_; lane < kernels::kLanes; ++lane) {
      batch_.pixels[lane] = batch_.pixels[0];
      batch_.centre[lane] = batch_.centre[0];
    }
    std::array<float, kernels::kLanes> places, slopes;
    kernels::active().findEdges(batch_, places.data(), slopes.data());
    const int first = samples.count - waiting_;
    for (int lane = 0; lane < waiting_; ++lane) {
      const std::size_t from = static_cast<std::size_t>(lane);
      const std::size_t to = static_cast<std::size_t>(first + lane);
      samples.offsets[to] = (places[from] - batch_.centre[lane]) * normal_share_;
      samples.slopes[to] = slopes[from];
    }
    waiting_ = 0;
  }

  const cv::Mat& gray_;
  Eigen::Vector2f start_;
  Eigen::Vector2f direction_;
  float length_;
  bool flat_{true};
  float cross_per_main_{0.0F};
  float normal_share_{1.0F};
  int reach_{0};
  int waiting_{0};
  kernels::ProfileBatch batch_{};
};

/// Iteratively re-weighted least squares with Tukey's weights, from wide to narrow, over `count` samples from
/// `first`.
kernels::OffsetFit fitOffsets(const Samples& samples, int first, int count, float min_slope) {
  const kernels::EdgeSamples inner{samples.places.data() + first, samples.offsets.data() + first,
                                   samples.slopes.data() + first, count};
  kernels::OffsetFit fit;
  for (const float width : {4.0F, 3.0F, 2.0F, 1.5F, 1.5F}) {
    std::array<float, 5> sums;
    kernels::active().sumOffsets(inner, fit, width, min_slope, sums.data());
    const auto [w, wp, wpp, wo, wpo] = sums;
    const float determinant = w * wpp - wp * wp;
    if (determinant < 1e-3F) break;
    fit.offset = (wpp * wo - wp * wpo) / determinant;
    fit.turn = (w * wpo - wp * wo) / determinant;
  }
  return fit;
}

/// True when the sample lies on the fitted edge.
bool onEdge(const Samples& samples, int i, const kernels::OffsetFit& fit, float min_slope) {
  const std::size_t k = static_cast<std::size_t>(i);
  return samples.slopes[k] >= min_slope && std::abs(samples.offsets[k] - fit.at(samples.places[k])) < kOnEdge;
}

}  // namespace

float LineRefiner::contrastOf(const cv::Mat& gray, const LineSegment& line) const {
  constexpr int kCount = 2 * kernels::kLanes;
  const float length = line.length();
  float best = 0.0F;
  for (const float polarity : {1.0F, -1.0F}) {
    ProfileSampler sampler(gray, line, polarity, 1.5F);
    Samples samples;
    for (int i = 0; i < kCount; ++i) sampler.add((static_cast<float>(i) + 0.5F) * length / kCount, samples);
    sampler.finish(samples);
    if (samples.count < kCount / 2) continue;
    const auto middle = samples.slopes.begin() + samples.count / 2;
    std::nth_element(samples.slopes.begin(), middle, samples.slopes.begin() + samples.count);
    if (*middle > std::abs(best)) best = polarity * *middle;
  }
  return best;
}

EdgeFit LineRefiner::fit(const cv::Mat& gray, const LineSegment& line, float contrast) const {
  EdgeFit result;
  result.segment = line;
  const float length = line.length();
  if (!(length > 1.0F)) return result;
  ProfileSampler sampler(gray, line, contrast, static_cast<float>(parameters_.search_px));
  const float min_slope = std::max(kMinSlope, kMinContrastShare * std::abs(contrast));

  // Samples evenly along the line, and a few beyond each end.
  const int inner = std::clamp(static_cast<int>(length / kSampleSpacing), kMinInner, kMaxInner);
  const float spacing = length / static_cast<float>(inner);
  const int beyond =
      parameters_.fit_ends ? std::clamp(static_cast<int>(kEndReach / spacing), 1, kMaxBeyond) : 0;
  Samples samples;
  int first_inner = 0;
  int inner_count = 0;
  for (int i = -beyond; i < inner + beyond; ++i) {
    if (!sampler.add((static_cast<float>(i) + 0.5F) * spacing, samples)) continue;
    if (i < 0) ++first_inner;
    if (i >= 0 && i < inner) ++inner_count;
  }
  sampler.finish(samples);
  if (inner_count < kMinInner) return result;

  // Samples beyond the end that share a vector with inner ones are as good: they lie on the same edge or
  // weigh nothing.
  const kernels::OffsetFit fit = fitOffsets(samples, first_inner, inner_count, min_slope);
  std::array<float, kMaxInner> slopes;
  std::size_t supported = 0;
  float squares = 0.0F;
  for (int i = first_inner; i < first_inner + inner_count; ++i) {
    if (!onEdge(samples, i, fit, min_slope)) continue;
    const std::size_t k = static_cast<std::size_t>(i);
    slopes[supported++] = samples.slopes[k];
    const float rest = samples.offsets[k] - fit.at(samples.places[k]);
    squares += rest * rest;
  }
  result.support = static_cast<float>(supported) / static_cast<float>(inner_count);
  if (supported < 4 || result.support < static_cast<float>(parameters_.min_support)) return result;

  const auto middle = slopes.begin() + static_cast<std::ptrdiff_t>(supported / 2);
  std::nth_element(slopes.begin(), middle, slopes.begin() + static_cast<std::ptrdiff_t>(supported));
  result.contrast = std::copysign(*middle, contrast);
  const float variance = squares / static_cast<float>(supported - 2);
  result.sigma_px = std::sqrt(kSigmaFloor * kSigmaFloor + variance / static_cast<float>(supported));

  float from = 0.0F;
  float to = length;
  if (parameters_.fit_ends) {
    // From the middle outwards to the last sample on the edge before a gap of more than two.
    const auto reach = [&](int i, int step) {
      int last = i;
      for (int gap = 0; i >= 0 && i < samples.count && gap <= 2; i += step) {
        if (onEdge(samples, i, fit, min_slope)) {
          last = i;
          gap = 0;
        } else {
          ++gap;
        }
      }
      return samples.along[static_cast<std::size_t>(last)] + 0.5F * spacing * static_cast<float>(step);
    };
    const int centre = first_inner + inner_count / 2;
    const float first = reach(centre, -1);
    const float last = reach(centre, 1);
    // A gap in the middle leaves one half; which one is chance, so such a line stays whole.
    if (last - first >= 0.5F * length) {
      from = first;
      to = last;
    }
  }
  const Eigen::Vector2f direction = line.direction();
  const Eigen::Vector2f normal = line.normal();
  const auto onFit = [&](float along) -> Eigen::Vector2f {
    return line.start + along * direction + fit.at(2.0F * along / length - 1.0F) * normal;
  };
  result.segment = {onFit(from), onFit(to)};
  return result;
}

}  // namespace tet_line_tracker
