#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <ros/time.h>
#include <Eigen/Geometry>

namespace tet_line_tracker {

/// One line of a text file, split at commas and white space. Every error is a std::runtime_error that begins
/// with `file:line`.
class TextRow {
 public:
  TextRow(std::string where, std::vector<std::string> fields)
      : where_(std::move(where)), fields_(std::move(fields)) {}

  /// `file:line`.
  const std::string& where() const { return where_; }
  std::size_t size() const { return fields_.size(); }
  const std::string& text(std::size_t i) const { return fields_.at(i); }

  /// A finite number.
  double number(std::size_t i) const;
  /// A whole number from 0 to 999999999.
  int frameNumber(std::size_t i) const;
  /// Three finite numbers from field i on.
  Eigen::Vector3d vector(std::size_t i) const;
  /// Pose from a position at field i and a quaternion of norm 1 at field i + 3, whose scalar part comes first
  /// (w x y z) or last (x y z w).
  Eigen::Isometry3d poseScalarFirst(std::size_t i) const;
  Eigen::Isometry3d poseScalarLast(std::size_t i) const;
  /// Stamp written in whole nanoseconds.
  ros::Time nanoseconds(std::size_t i) const;
  /// Stamp written in seconds, without the rounding of a double where it is a plain decimal number.
  ros::Time seconds(std::size_t i) const;

 private:
  [[noreturn]] void fail(std::size_t i, const std::string& needed) const;
  Eigen::Isometry3d pose(std::size_t i, const Eigen::Quaterniond& rotation) const;

  std::string where_;
  std::vector<std::string> fields_;
};

/// Rows of a text file without empty lines and comments (#). Throws std::runtime_error when the file cannot
/// be read, and naming the line when a row has fewer than `min_fields` fields.
std::vector<TextRow> readTextTable(const std::filesystem::path& path, std::size_t min_fields);

}  // namespace tet_line_tracker
