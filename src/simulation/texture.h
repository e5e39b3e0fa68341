#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "grain.h"

namespace tet_line_tracker {

/// An axis-aligned patch of one gray, painted over what is below it.
struct PaintedRectangle {
  float u0, v0, u1, v1;  ///< [m]
  float gray;            ///< 0..255
};

/// Bricks, tiles or planks with joints between them.
struct BrickPattern {
  float length{0.42F};       ///< period along u, one joint included [m]
  float height{0.20F};       ///< period along v, one joint included [m]
  float joint{0.012F};       ///< width of a joint [m]
  float shift{0.5F};         ///< of every second row, in lengths
  float gray{120.0F};        ///< mean over bricks, 0..255
  float gray_spread{12.0F};  ///< deviation from brick to brick
  float joint_gray{170.0F};  ///< 0..255
  std::uint64_t seed{0};
};

/// How a pixel weighs what it sees along one axis of a texture: a trapezoid, as a step edge across a
/// parallelogram gives, so that a painted edge lies in the image where it projects to whatever its direction.
class PixelWeight {
 public:
  /// Of a parallelogram whose sides span `a` and `b` along the axis [m].
  PixelWeight(float a, float b);
  static PixelWeight box(float half_width) { return {2.0F * half_width, 0.0F}; }

  /// Distance from the centre beyond which nothing counts [m].
  float reach() const { return outer_; }
  /// Share of the weight between two places; the centre is 0.
  float share(float low, float high) const { return high > low ? below(high) - below(low) : 0.0F; }

 private:
  float below(float x) const;

  float outer_, inner_;  // half lengths of the trapezoid's parallel sides
};

/// A straight edge of a texture, in its own coordinates [m].
struct TextureEdge {
  Eigen::Vector2d start;
  Eigen::Vector2d end;
};

/// The look of one rectangle: plain or bricks, painted over, with grain and light on it. Every edge is a
/// step; gray() gives its mean over a pixel in closed form, so that edges are anti-aliased at every distance.
class Texture {
 public:
  /// `width` along u and `height` along v [m]; `gray` of the bare surface, 0..255.
  Texture(float width, float height, float gray);

  void setBricks(const BrickPattern& bricks);
  void paint(const PaintedRectangle& rectangle);
  /// `deviation` in gray levels; `offset` [m] keeps surfaces with the same grain apart.
  void setGrain(std::shared_ptr<const Grain> grain, float deviation, const Eigen::Vector2f& offset);
  /// Factor of the light in the middle, and its change from one end to the other along u and v.
  void setLight(float middle, float change_u, float change_v);

  /// Mean around a point.
  float gray(float u, float v, const PixelWeight& weight_u, const PixelWeight& weight_v) const;

  /// All edges of bricks and paint that no later paint covers.
  std::vector<TextureEdge> edges() const;

  float width() const { return width_; }
  float height() const { return height_; }

 private:
  float brickGray(float u, float v, const PixelWeight& weight_u, const PixelWeight& weight_v) const;
  void appendVisible(const TextureEdge& edge, std::size_t first_cover, std::vector<TextureEdge>& edges) const;

  float width_, height_, gray_;
  bool has_bricks_{false};
  BrickPattern bricks_;
  std::vector<PaintedRectangle> paint_;
  /// For each cell of a coarse grid the paint that a box around a point in it can touch, in order. Empty
  /// without paint.
  std::vector<std::vector<std::uint16_t>> paint_near_;
  int cells_u_, cells_v_;
  std::shared_ptr<const Grain> grain_;
  float grain_deviation_{0.0F};
  Eigen::Vector2f grain_offset_{0.0F, 0.0F};
  float light_{1.0F}, light_u_{0.0F}, light_v_{0.0F};
};

}  // namespace tet_line_tracker
