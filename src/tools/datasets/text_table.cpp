#include "text_table.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <stdexcept>

namespace tet_line_tracker {
namespace {

constexpr std::uint64_t kNanosecondsPerSecond = 1000000000U;

bool isDigits(const std::string& text) {
  return !text.empty() &&
         std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c); });
}

std::vector<std::string> split(const std::string& line) {
  static const char* const kSeparators = ", \t\r";
  std::vector<std::string> fields;
  std::size_t begin = line.find_first_not_of(kSeparators);
  while (begin != std::string::npos) {
    const std::size_t end = line.find_first_of(kSeparators, begin);
    fields.push_back(line.substr(begin, end == std::string::npos ? end : end - begin));
    begin = line.find_first_not_of(kSeparators, end);
  }
  return fields;
}

}  // namespace

void TextRow::fail(std::size_t i, const std::string& needed) const {
  throw std::runtime_error(where_ + ": \"" + fields_.at(i) + "\" is not " + needed);
}

double TextRow::number(std::size_t i) const {
  const std::string& field = fields_.at(i);
  char* end = nullptr;
  const double value = std::strtod(field.c_str(), &end);
  if (end != field.c_str() + field.size() || !std::isfinite(value)) fail(i, "a number");
  return value;
}

int TextRow::frameNumber(std::size_t i) const {
  constexpr std::size_t kMaxDigits = 9;
  const std::string& field = fields_.at(i);
  if (!isDigits(field) || field.size() > kMaxDigits) fail(i, "a frame number");
  return static_cast<int>(std::strtol(field.c_str(), nullptr, 10));
}

Eigen::Vector3d TextRow::vector(std::size_t i) const {
  return {number(i), number(i + 1), number(i + 2)};
}

Eigen::Isometry3d TextRow::poseScalarFirst(std::size_t i) const {
  return pose(i, Eigen::Quaterniond(number(i + 3), number(i + 4), number(i + 5), number(i + 6)));
}

Eigen::Isometry3d TextRow::poseScalarLast(std::size_t i) const {
  return pose(i, Eigen::Quaterniond(number(i + 6), number(i + 3), number(i + 4), number(i + 5)));
}

Eigen::Isometry3d TextRow::pose(std::size_t i, const Eigen::Quaterniond& rotation) const {
  // Published quaternions are rounded to a few digits.
  constexpr double kRounding = 0.01;
  if (std::abs(rotation.norm() - 1.0) > kRounding) {
    throw std::runtime_error(where_ + ": the quaternion has norm " + std::to_string(rotation.norm()) +
                             ", needs 1");
  }
  return Eigen::Translation3d(vector(i)) * rotation.normalized();
}

ros::Time TextRow::nanoseconds(std::size_t i) const {
  const std::string& field = fields_.at(i);
  constexpr std::size_t kMaxDigits = 19;
  const std::uint64_t value =
      isDigits(field) && field.size() <= kMaxDigits ? std::strtoull(field.c_str(), nullptr, 10) : 0U;
  if (!isDigits(field) || field.size() > kMaxDigits ||
      value / kNanosecondsPerSecond > std::numeric_limits<std::uint32_t>::max()) {
    fail(i, "a stamp in nanoseconds");
  }
  return {static_cast<std::uint32_t>(value / kNanosecondsPerSecond),
          static_cast<std::uint32_t>(value % kNanosecondsPerSecond)};
}

ros::Time TextRow::seconds(std::size_t i) const {
  const double value = number(i);
  if (value < 0.0 || value >= std::numeric_limits<std::uint32_t>::max()) fail(i, "a stamp in seconds");
  const std::string& field = fields_.at(i);
  const std::size_t dot = std::min(field.find('.'), field.size());
  std::string fraction = dot < field.size() ? field.substr(dot + 1) : "";
  if (!isDigits(field.substr(0, dot)) || (!fraction.empty() && !isDigits(fraction))) return ros::Time(value);
  fraction.resize(9, '0');
  return {static_cast<std::uint32_t>(std::strtoul(field.c_str(), nullptr, 10)),
          static_cast<std::uint32_t>(std::strtoul(fraction.c_str(), nullptr, 10))};
}

std::vector<TextRow> readTextTable(const std::filesystem::path& path, std::size_t min_fields) {
  // A fifo would wait for a writer.
  if (!std::filesystem::is_regular_file(path)) throw std::runtime_error("cannot read " + path.string());
  std::ifstream file(path);
  if (!file) throw std::runtime_error("cannot read " + path.string());
  std::vector<TextRow> rows;
  std::string line;
  for (std::size_t number = 1; std::getline(file, line); ++number) {
    std::vector<std::string> fields = split(line);
    if (fields.empty() || fields.front().front() == '#') continue;
    const std::string where = path.string() + ":" + std::to_string(number);
    if (fields.size() < min_fields) {
      throw std::runtime_error(where + ": " + std::to_string(fields.size()) + " fields, needs " +
                               std::to_string(min_fields));
    }
    rows.emplace_back(where, std::move(fields));
  }
  return rows;
}

}  // namespace tet_line_tracker
