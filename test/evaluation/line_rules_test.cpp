#include "evaluation/line_rules.h"

#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace tet_line_tracker {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

TrackedLine line(std::uint64_t id, std::uint32_t age) {
  TrackedLine line;
  line.id = id;
  line.age = age;
  line.segment = {{10.0F, 10.0F + static_cast<float>(id)}, {60.0F, 20.0F + static_cast<float>(id)}};
  line.residual = age == 1 ? kNan : 0.01F;
  line.sigma_px = 0.2F;
  return line;
}

LineFrame frame(std::uint64_t count, std::vector<TrackedLine> lines) {
  LineFrame frame;
  frame.stamp_ns = static_cast<std::int64_t>(count) * 50000000;
  frame.epoch = 0;
  frame.image_count = count;
  frame.width = 320;
  frame.height = 240;
  frame.lines = std::move(lines);
  return frame;
}

using Stream = std::vector<LineFrame>;

/// A stream that keeps every rule: id 1 leaves, id 2 stays, id 3 comes.
Stream goodStream() {
  return {frame(1, {line(1, 1), line(2, 1)}), frame(2, {line(1, 2), line(2, 2)}),
          frame(3, {line(2, 3), line(3, 1)}), frame(4, {line(2, 4), line(3, 2)}), frame(5, {})};
}

LineRules rulesAfter(const Stream& stream) {
  LineRules rules(30.0);
  for (const LineFrame& frame : stream) {
    rules.add(frame);
    rules.addImage(frame.stamp_ns, 320, 240);
  }
  rules.finish();
  return rules;
}

TEST(LineRules, AcceptAStreamThatKeepsThem) {
  const LineRules rules = rulesAfter(goodStream());
  for (const auto& [rule, violation] : rules.violations()) ADD_FAILURE() << rule << ": " << violation.first;
  EXPECT_EQ(rules.messages(), 5U);
  EXPECT_EQ(rules.lines(), 8U);
}

TEST(LineRules, CountLinesThatAreNotNormalized) {
  TrackedLine both = line(1, 1);
  both.start_normalized = both.end_normalized = {0.1, 0.2};
  TrackedLine one = line(2, 1);
  one.start_normalized = {0.1, 0.2};
  one.end_normalized.setConstant(std::nan(""));
  EXPECT_EQ(rulesAfter({frame(1, {both, one})}).linesNotNormalized(), 1U);
}

TEST(LineRules, AcceptANewEpochThatReusesIds) {
  Stream stream = goodStream();
  LineFrame next = frame(1, {line(1, 1)});
  next.epoch = 1;
  next.stamp_ns = 1;  // a bag that starts again
  stream.push_back(next);
  EXPECT_TRUE(rulesAfter(stream).violations().empty());
}

TEST(LineRules, AcceptARecordingThatBeganInTheMiddle) {
  Stream stream = goodStream();
  stream.erase(stream.begin());
  EXPECT_TRUE(rulesAfter(stream).violations().empty());
}

struct Fault {
  const char* rule;
  std::function<void(Stream&)> commit;
};

class LineRulesFault : public testing::TestWithParam<Fault> {};

TEST_P(LineRulesFault, IsNamed) {
  Stream stream = goodStream();
  GetParam().commit(stream);
  const LineRules rules = rulesAfter(stream);
  EXPECT_EQ(rules.violations().count(GetParam().rule), 1U) << GetParam().rule;
}

INSTANTIATE_TEST_SUITE_P(
    Every, LineRulesFault,
    testing::Values(
        Fault{"a line that was missing does not return under its old id",
              [](Stream& s) { s[3].lines.insert(s[3].lines.begin(), line(1, 3)); }},
        Fault{"no id stands twice in a message", [](Stream& s) { s[1].lines.push_back(line(2, 2)); }},
        Fault{"lines are ordered by id, oldest first",
              [](Stream& s) { std::swap(s[1].lines[0], s[1].lines[1]); }},
        Fault{"a new id has age 1 (a line that was missing must not return under its old id)",
              [](Stream& s) { s[2].lines[1].age = 2; }},
        Fault{"the age goes up by one from image to image", [](Stream& s) { s[1].lines[0].age = 1; }},
        Fault{"image_count goes up by one", [](Stream& s) { s[2].image_count = 4; }},
        Fault{"an epoch starts with image_count 1", [](Stream& s) { s[4].epoch = 1; }},
        Fault{"the epoch only goes up", [](Stream& s) { s[0].epoch = 3; }},
        Fault{"stamps increase within an epoch", [](Stream& s) { s[3].stamp_ns = s[2].stamp_ns; }},
        Fault{"pixels are finite", [](Stream& s) { s[1].lines[0].segment.end.x() = kNan; }},
        Fault{"lines lie inside the image", [](Stream& s) { s[1].lines[0].segment.end.x() = 319.2F; }},
        Fault{"lines are at least min_length long",
              [](Stream& s) {
                s[1].lines[0].segment.end = s[1].lines[0].segment.start + Eigen::Vector2f(29.9F, 0.0F);
              }},
        Fault{"normalised endpoints are finite, or NaN in both coordinates",
              [](Stream& s) { s[1].lines[0].start_normalized.x() = 0.5; }},
        Fault{"sigma_px is positive or NaN", [](Stream& s) { s[1].lines[0].sigma_px = 0.0F; }},
        Fault{"residual is NaN exactly when the line was detected here",
              [](Stream& s) { s[1].lines[0].residual = kNan; }},
        Fault{"residual lies between 0 and 1", [](Stream& s) { s[1].lines[0].residual = 1.5F; }},
        Fault{"the image size is positive", [](Stream& s) { s[4].width = 0; }},
        Fault{"width and height are those of the image", [](Stream& s) { s[4].width = 640; }}));

TEST(LineRules, NameAnImageWithoutMessageAndAMessageWithoutImage) {
  LineRules rules(30.0);
  for (const LineFrame& frame : goodStream()) {
    rules.add(frame);
    rules.addImage(frame.stamp_ns + (frame.image_count == 3 ? 1 : 0), 320, 240);
  }
  rules.finish();
  ASSERT_EQ(rules.violations().count("every image has a message"), 1U);
  ASSERT_EQ(rules.violations().count("every message has the stamp of an image"), 1U);
  EXPECT_EQ(rules.violations().at("every image has a message").count, 1U);
}

}  // namespace
}  // namespace tet_line_tracker
