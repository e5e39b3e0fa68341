#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace tet_line_tracker {

class WorldBuilder;

/// Things in a room whose lines are not what a tracker of straight edges assumes: they slide over a surface,
/// sag, sway, walk, or are images of something else.
struct Distractors {
  bool round{false};         ///< columns, a pipe and a round table: their outlines slide over the surface
  bool cables{false};        ///< two cables that sag
  bool foliage{false};       ///< plants whose leaves sway
  bool people{false};        ///< two people who walk to and fro
  bool mirror{false};        ///< a mirror on a wall
  bool glossy_floor{false};  ///< a floor without joints that reflects a third of the light
  bool screen{false};        ///< a screen whose picture changes every 0.4 s

  std::string text() const;  ///< as parseDistractors() reads it
};

/// Their names, in the order of Distractors.
std::vector<std::string> distractorNames();

/// Reads "none", "all" or a comma-separated list of names. Throws std::invalid_argument for others.
Distractors parseDistractors(const std::string& text);

/// Puts them into the room of makeWorld(), around the box in which the camera is and mostly on the side to
/// which it looks. `origin_ns`: stamp at which all that moves is in the middle.
void addDistractors(WorldBuilder& builder, const Distractors& distractors, std::int64_t origin_ns);

}  // namespace tet_line_tracker
