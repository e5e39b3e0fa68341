#include "texture.h"

#include <algorithm>
#include <cmath>

#include "counter_random.h"

namespace tet_line_tracker {
namespace {

constexpr float kCell = 0.25F;           // side of a cell of the paint grid [m]
constexpr float kMaxPaintReach = 0.25F;  // of a weight over paint [m]
constexpr float kMinHalf = 1e-5F;        // keeps a weight from vanishing [m]

/// A larger weight than this is cut to a box.
PixelWeight limited(const PixelWeight& weight, float reach) {
  return weight.reach() > reach ? PixelWeight::box(reach) : weight;
}

int cellOf(float x, int cells) {
  return std::min(std::max(static_cast<int>(x / kCell), 0), cells - 1);
}

}  // namespace

PixelWeight::PixelWeight(float a, float b)
    : outer_(std::max(0.5F * (std::abs(a) + std::abs(b)), kMinHalf)),
      inner_(std::min(0.5F * std::abs(std::abs(a) - std::abs(b)), outer_)) {}

float PixelWeight::below(float x) const {
  const float distance = std::abs(x);
  float beyond = 0.0F;  // weight further out on the same side
  if (distance < inner_) {
    beyond = 0.5F - distance / (outer_ + inner_);
  } else if (distance < outer_) {
    const float rest = outer_ - distance;
    beyond = 0.5F * rest * rest / (outer_ * outer_ - inner_ * inner_);
  }
  return x > 0.0F ? 1.0F - beyond : beyond;
}

Texture::Texture(float width, float height, float gray)
    : width_(width),
      height_(height),
      gray_(gray),
      cells_u_(static_cast<int>(width / kCell) + 1),
      cells_v_(static_cast<int>(height / kCell) + 1) {}

void Texture::setBricks(const BrickPattern& bricks) {
  bricks_ = bricks;
  has_bricks_ = true;
}

void Texture::paint(const PaintedRectangle& rectangle) {
  paint_near_.resize(static_cast<std::size_t>(cells_u_) * static_cast<std::size_t>(cells_v_));
  const auto number = static_cast<std::uint16_t>(paint_.size());
  paint_.push_back(rectangle);
  for (int j = cellOf(rectangle.v0 - kMaxPaintReach, cells_v_);
       j <= cellOf(rectangle.v1 + kMaxPaintReach, cells_v_); ++j) {
    for (int i = cellOf(rectangle.u0 - kMaxPaintReach, cells_u_);
         i <= cellOf(rectangle.u1 + kMaxPaintReach, cells_u_); ++i) {
      paint_near_[static_cast<std::size_t>(j * cells_u_ + i)].push_back(number);
    }
  }
}

void Texture::setGrain(std::shared_ptr<const Grain> grain, float deviation, const Eigen::Vector2f& offset) {
  grain_ = std::move(grain);
  grain_deviation_ = deviation;
  grain_offset_ = offset;
}

void Texture::setLight(float middle, float change_u, float change_v) {
  light_ = middle;
  light_u_ = change_u;
  light_v_ = change_v;
}

float Texture::brickGray(float u, float v, const PixelWeight& weight_u, const PixelWeight& weight_v) const {
  // Over three whole periods the mean no longer depends on the place: more need not be looked at.
  const PixelWeight wu = limited(weight_u, 1.5F * bricks_.length);
  const PixelWeight wv = limited(weight_v, 1.5F * bricks_.height);
  const auto fade = [](float reach, float period) {
    return std::min(1.0F, std::max(0.0F, 2.0F - reach / period));
  };
  const float spread =
      bricks_.gray_spread * fade(weight_u.reach(), bricks_.length) * fade(weight_v.reach(), bricks_.height);
  const int first_row = static_cast<int>(std::floor((v - wv.reach()) / bricks_.height));
  const int last_row = static_cast<int>(std::floor((v + wv.reach()) / bricks_.height));
  float covered = 0.0F;
  float sum = 0.0F;
  for (int row = first_row; row <= last_row; ++row) {
    const float bottom = static_cast<float>(row) * bricks_.height - v;
    const float share_v = wv.share(bottom, bottom + bricks_.height - bricks_.joint);
    if (share_v == 0.0F) continue;
    const float shift = (row & 1) != 0 ? bricks_.shift * bricks_.length : 0.0F;
    const int first = static_cast<int>(std::floor((u - wu.reach() - shift) / bricks_.length));
    const int last = static_cast<int>(std::floor((u + wu.reach() - shift) / bricks_.length));
    for (int column = first; column <= last; ++column) {
      const float left = static_cast<float>(column) * bricks_.length + shift - u;
      const float share = share_v * wu.share(left, left + bricks_.length - bricks_.joint);
      const auto brick = (static_cast<std::uint64_t>(static_cast<std::uint32_t>(row)) << 32U) |
                         static_cast<std::uint32_t>(column);
      covered += share;
      sum += share * (bricks_.gray + spread * normalFromBits(hash64(bricks_.seed, brick)));
    }
  }
  return sum + (1.0F - covered) * bricks_.joint_gray;
}

float Texture::gray(float u, float v, const PixelWeight& weight_u, const PixelWeight& weight_v) const {
  float gray = has_bricks_ ? brickGray(u, v, weight_u, weight_v) : gray_;
  if (!paint_near_.empty()) {
    const auto& near =
        paint_near_[static_cast<std::size_t>(cellOf(v, cells_v_) * cells_u_ + cellOf(u, cells_u_))];
    const PixelWeight wu = limited(weight_u, kMaxPaintReach);
    const PixelWeight wv = limited(weight_v, kMaxPaintReach);
    for (const std::uint16_t number : near) {
      const PaintedRectangle& r = paint_[number];
      if (r.u0 - u > wu.reach() || u - r.u1 > wu.reach() || r.v0 - v > wv.reach() || v - r.v1 > wv.reach()) {
        continue;
      }
      gray += (r.gray - gray) * wu.share(r.u0 - u, r.u1 - u) * wv.share(r.v0 - v, r.v1 - v);
    }
  }
  if (grain_) {
    const float width = 2.0F * std::max(weight_u.reach(), weight_v.reach());
    gray += grain_deviation_ * grain_->at(u + grain_offset_.x(), v + grain_offset_.y(), width);
  }
  const float light = light_ + light_u_ * (u / width_ - 0.5F) + light_v_ * (v / height_ - 0.5F);
  return std::max(0.0F, gray * light);
}

std::vector<TextureEdge> Texture::edges() const {
  std::vector<TextureEdge> edges;
  if (has_bricks_) {
    const float joint = bricks_.joint;
    for (int row = 0; static_cast<float>(row) * bricks_.height < height_; ++row) {
      const float bottom = static_cast<float>(row) * bricks_.height;
      const float top = bottom + bricks_.height - joint;
      appendVisible({{0.0, bottom}, {width_, bottom}}, 0, edges);
      appendVisible({{0.0, top}, {width_, top}}, 0, edges);
      const float shift = (row & 1) != 0 ? bricks_.shift * bricks_.length : 0.0F;
      for (int column = -1; static_cast<float>(column) * bricks_.length + shift < width_; ++column) {
        const float left = static_cast<float>(column) * bricks_.length + shift;
        const float right = left + bricks_.length - joint;
        appendVisible({{left, bottom}, {left, top}}, 0, edges);
        appendVisible({{right, bottom}, {right, top}}, 0, edges);
      }
    }
  }
  for (std::size_t i = 0; i < paint_.size(); ++i) {
    const PaintedRectangle& r = paint_[i];
    appendVisible({{r.u0, r.v0}, {r.u1, r.v0}}, i + 1, edges);
    appendVisible({{r.u0, r.v1}, {r.u1, r.v1}}, i + 1, edges);
    appendVisible({{r.u0, r.v0}, {r.u0, r.v1}}, i + 1, edges);
    appendVisible({{r.u1, r.v0}, {r.u1, r.v1}}, i + 1, edges);
  }
  return edges;
}

void Texture::appendVisible(const TextureEdge& edge, std::size_t first_cover,
                            std::vector<TextureEdge>& edges) const {
  const bool along_u = edge.start.y() == edge.end.y();
  const int axis = along_u ? 0 : 1;
  const double level = edge.start(1 - axis);
  const double limit = along_u ? width_ : height_;
  const double other_limit = along_u ? height_ : width_;
  constexpr double kOnBorder = 1e-4;  // there the outline of the rectangle is the edge [m]
  if (level < kOnBorder || level > other_limit - kOnBorder) return;

  std::vector<std::pair<double, double>> visible = {
      {std::max(0.0, edge.start(axis)), std::min(limit, edge.end(axis))}};
  for (std::size_t i = first_cover; i < paint_.size() && !visible.empty(); ++i) {
    const PaintedRectangle& r = paint_[i];
    if (level <= (along_u ? r.v0 : r.u0) || level >= (along_u ? r.v1 : r.u1)) continue;
    const double low = along_u ? r.u0 : r.v0;
    const double high = along_u ? r.u1 : r.v1;
    std::vector<std::pair<double, double>> left_over;
    for (const auto& [a, b] : visible) {
      if (std::min(b, low) > a) left_over.emplace_back(a, std::min(b, low));
      if (b > std::max(a, high)) left_over.emplace_back(std::max(a, high), b);
    }
    visible = std::move(left_over);
  }
  constexpr double kShortest = 0.01;  // [m]
  for (const auto& [a, b] : visible) {
    if (b - a < kShortest) continue;
    TextureEdge part = edge;
    part.start(axis) = a;
    part.end(axis) = b;
    edges.push_back(part);
  }
}

}  // namespace tet_line_tracker
