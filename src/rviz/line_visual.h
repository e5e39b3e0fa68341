#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include <OgrePrerequisites.h>

#include "shown_lines.h"

namespace rviz {
class BillboardLine;
class MovableText;
}  // namespace rviz

namespace tet_line_tracker {

/// Lines with labels in the scene of rviz.
class LineVisual {
 public:
  LineVisual(Ogre::SceneManager* manager, Ogre::SceneNode* parent);
  ~LineVisual();
  LineVisual(const LineVisual&) = delete;
  LineVisual& operator=(const LineVisual&) = delete;

  /// Replaces what is drawn. Width and height in metres.
  void draw(const std::vector<ShownLine>& lines, float width, float text_height);
  void clear() { draw({}, 1.0F, 1.0F); }

  /// Pose of the frame of the lines in the fixed frame; at first they are the same.
  void setPose(const Ogre::Vector3& position, const Ogre::Quaternion& orientation);

 private:
  struct Label {
    Ogre::SceneNode* node;
    std::unique_ptr<rviz::MovableText> text;
  };

  void drawLabel(std::size_t number, const ShownLine& line, float height);

  Ogre::SceneManager* manager_;
  Ogre::SceneNode* node_;
  std::unique_ptr<rviz::BillboardLine> billboards_;
  std::vector<Label> labels_;  ///< kept when not needed, as making them is slow
};

}  // namespace tet_line_tracker
