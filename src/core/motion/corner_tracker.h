#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "flow/patch_flow.h"
#include "kernels/kernels.h"
#include "tet_line_tracker/image/image_pyramid.h"

namespace tet_line_tracker {

/// Follows a few dozen corners, spread over the image, for the motion of the camera alone: unlike a point of
/// a line, a corner shows its movement in both directions. Lucas-Kanade as for lines, gain and offset
/// matched. Buffers are kept from image to image.
class CornerTracker {
 public:
  /// One corner at most is taken up in each cell of a grid over the image.
  static constexpr int kColumns = 10;
  static constexpr int kRows = 6;
  /// Pyramid levels that it wants to see.
  static constexpr int kPyramidLevels = 5;

  struct Corner {
    Eigen::Vector2f pixel{0.0F, 0.0F};     ///< in the image of the last call [px]
    Eigen::Vector2f expected{0.0F, 0.0F};  ///< in the next image, to be set before follow() [px]
    bool used{false};                      ///< otherwise the slot is free
    bool fresh{true};                      ///< taken up in the last image
    bool sure{false};                      ///< `expected` is off by a few pixels at most; set before follow()

   private:
    friend class CornerTracker;
    static constexpr int kSide = 7;
    static constexpr kernels::PatchShape kShape = kernels::PatchShape::ofSide(kSide);
    std::array<Patch, kPyramidLevels> patches;
    std::array<float, static_cast<std::size_t>(kPyramidLevels * 3 * kShape.floats())> values;
  };

  CornerTracker();

  /// Slots; an index stays that of the same corner as long as it is used.
  std::size_t size() const { return corners_.size(); }
  Corner& corner(std::size_t i) { return corners_[i]; }
  const Corner& corner(std::size_t i) const { return corners_[i]; }

  void clear();
  /// Moves the corners to where they are in this image; frees those that are not found.
  void follow(const ImagePyramid& pyramid);
  /// Takes what the corners look like in this image, and new ones in empty cells.
  void extractTemplates(const ImagePyramid& pyramid);

 private:
  bool followCorner(const ImagePyramid& pyramid, Corner& corner) const;
  void addCorners(const ImagePyramid& pyramid);
  /// The best corner of a cell of a level; false when it shows none.
  bool bestCorner(const cv::Mat& level, const cv::Rect& cell, Eigen::Vector2f& pixel);

  /// A window of the selection level reaches over its corner by several px, those of the finest level do not.
  /// `cell` of the selection level, which the corner does not leave.
  Eigen::Vector2f exactPlace(const cv::Mat& image, const cv::Rect& cell, const Eigen::Vector2f& pixel);

  std::vector<Corner> corners_;
  bool odd_turn_{false};            ///< which of the empty cells are looked into
  std::vector<std::int32_t> sums_;  ///< of products of gradients
};

}  // namespace tet_line_tracker
