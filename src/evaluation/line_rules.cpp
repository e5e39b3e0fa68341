#include "line_rules.h"

#include <cmath>

namespace tet_line_tracker {
namespace {

// Endpoints are float32: a length of exactly the minimum may come out a hair short.
constexpr double kLengthRounding = 1e-3;

bool finiteOrUnknown(double value) {
  return !std::isinf(value);
}

}  // namespace

LineRules::LineRules(double min_length) : min_length_(min_length) {}

void LineRules::require(bool holds, const char* rule, const LineFrame& frame,
                        std::optional<std::uint64_t> id) {
  if (holds) return;
  Violation& violation = violations_[rule];
  if (violation.count++ > 0) return;
  violation.first = "epoch " + std::to_string(frame.epoch) + ", image " + std::to_string(frame.image_count) +
                    ", stamp " + std::to_string(frame.stamp_ns) + " ns";
  if (id) violation.first += ", id " + std::to_string(*id);
}

void LineRules::add(const LineFrame& frame) {
  checkStream(frame);
  ++messages_;
  lines_ += frame.lines.size();
  const TrackedLine* before = nullptr;
  for (const TrackedLine& line : frame.lines) {
    require(before == nullptr || line.id >= before->id, "lines are ordered by id, oldest first", frame,
            line.id);
    before = &line;
    checkLine(frame, line);
  }
  message_sizes_[frame.stamp_ns] = {frame.width, frame.height};
}

void LineRules::checkStream(const LineFrame& frame) {
  require(frame.width > 0 && frame.height > 0, "the image size is positive", frame);
  const bool first = messages_ == 0;
  if (first || frame.epoch != epoch_) {
    require(first || frame.epoch > epoch_, "the epoch only goes up", frame);
    require(first || frame.image_count == 1, "an epoch starts with image_count 1", frame);
    require(frame.image_count >= 1, "image_count counts from 1", frame);
    ids_.clear();
    joined_late_ = first && frame.image_count > 1;
  } else {
    require(frame.image_count == image_count_ + 1, "image_count goes up by one", frame);
    require(frame.stamp_ns > stamp_ns_, "stamps increase within an epoch", frame);
    joined_late_ = false;
  }
  epoch_ = frame.epoch;
  image_count_ = frame.image_count;
  stamp_ns_ = frame.stamp_ns;
}

void LineRules::checkLine(const LineFrame& frame, const TrackedLine& line) {
  const auto rule = [&](bool holds, const char* name) { require(holds, name, frame, line.id); };

  const auto [seen, is_new] = ids_.try_emplace(line.id, Seen{messages_, line.age});
  if (is_new) {
    rule(joined_late_ ? line.age >= 1 && line.age <= frame.image_count : line.age == 1,
         "a new id has age 1 (a line that was missing must not return under its old id)");
  } else {
    rule(seen->second.message != messages_, "no id stands twice in a message");
    rule(seen->second.message + 1 >= messages_, "a line that was missing does not return under its old id");
    rule(seen->second.message + 1 != messages_ || line.age == seen->second.age + 1,
         "the age goes up by one from image to image");
    seen->second = {messages_, line.age};
  }

  const LineSegment& segment = line.segment;
  const bool finite = segment.start.allFinite() && segment.end.allFinite();
  rule(finite, "pixels are finite");
  if (finite) {
    const ImageBounds bounds = ImageBounds::ofImage(frame.width, frame.height);
    rule(bounds.contains(segment.start) && bounds.contains(segment.end), "lines lie inside the image");
    rule(segment.length() >= min_length_ - kLengthRounding, "lines are at least min_length long");
  }
  for (const Eigen::Vector2d& point : {line.start_normalized, line.end_normalized}) {
    rule(finiteOrUnknown(point.x()) && finiteOrUnknown(point.y()) &&
             std::isnan(point.x()) == std::isnan(point.y()),
         "normalised endpoints are finite, or NaN in both coordinates");
  }
  if (line.start_normalized.hasNaN() || line.end_normalized.hasNaN()) ++lines_not_normalized_;
  rule(std::isnan(line.sigma_px) || (std::isfinite(line.sigma_px) && line.sigma_px > 0.0F),
       "sigma_px is positive or NaN");
  // A method that detects every line anew in every image has no residual at all.
  rule(line.age == 1 ? std::isnan(line.residual) : !std::isnan(line.residual) || frame.detected,
       "residual is NaN exactly when the line was detected here");
  rule(std::isnan(line.residual) || (line.residual >= 0.0F && line.residual <= 1.0F),
       "residual lies between 0 and 1");
}

void LineRules::addImage(std::int64_t stamp_ns, int width, int height) {
  images_[stamp_ns] = {width, height};
}

void LineRules::finish() {
  if (images_.empty()) return;
  LineFrame occasion;
  for (const auto& [stamp, size] : images_) {
    occasion.stamp_ns = stamp;
    const auto message = message_sizes_.find(stamp);
    require(message != message_sizes_.end(), "every image has a message", occasion);
    if (message == message_sizes_.end()) continue;
    require(message->second.width == size.width && message->second.height == size.height,
            "width and height are those of the image", occasion);
  }
  for (const auto& message : message_sizes_) {
    occasion.stamp_ns = message.first;
    require(images_.count(message.first) != 0, "every message has the stamp of an image", occasion);
  }
}

}  // namespace tet_line_tracker
