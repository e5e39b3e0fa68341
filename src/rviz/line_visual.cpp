#include "line_visual.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include <OgreColourValue.h>
#include <OgreQuaternion.h>
#include <OgreSceneManager.h>
#include <OgreSceneNode.h>
#include <rviz/ogre_helpers/billboard_line.h>
#include <rviz/ogre_helpers/movable_text.h>

namespace tet_line_tracker {
namespace {

Ogre::Vector3 toOgre(const Eigen::Vector3f& point) {
  return {point.x(), point.y(), point.z()};
}

Ogre::ColourValue toOgre(const Colour& colour) {
  return Ogre::ColourValue(colour.red, colour.green, colour.blue, colour.alpha);
}

}  // namespace

LineVisual::LineVisual(Ogre::SceneManager* manager, Ogre::SceneNode* parent)
    : manager_(manager), node_(parent->createChildSceneNode()) {
  billboards_ = std::make_unique<rviz::BillboardLine>(manager_, node_);
}

LineVisual::~LineVisual() {
  for (Label& label : labels_) {
    label.node->detachAllObjects();
    manager_->destroySceneNode(label.node);
  }
  billboards_.reset();
  manager_->destroySceneNode(node_);
}

void LineVisual::draw(const std::vector<ShownLine>& lines, float width, float text_height) {
  billboards_->clear();
  std::size_t labels = 0;
  if (!lines.empty()) {
    billboards_->setMaxPointsPerLine(2);
    billboards_->setNumLines(static_cast<std::uint32_t>(lines.size()));
    billboards_->setLineWidth(width);
    const auto faintest = std::min_element(
        lines.begin(), lines.end(),
        [](const ShownLine& left, const ShownLine& right) { return left.colour.alpha < right.colour.alpha; });
    // The opacity given here only decides whether the material is blended; each point has its own.
    billboards_->setColor(1.0F, 1.0F, 1.0F, faintest->colour.alpha);
  }
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const ShownLine& line = lines[i];
    if (i > 0) billboards_->newLine();
    billboards_->addPoint(toOgre(line.start), toOgre(line.colour));
    billboards_->addPoint(toOgre(line.end), toOgre(line.colour));
    if (!line.label.empty()) drawLabel(labels++, line, text_height);
  }
  for (std::size_t i = labels; i < labels_.size(); ++i) labels_[i].node->setVisible(false);
}

void LineVisual::drawLabel(std::size_t number, const ShownLine& line, float height) {
  if (number == labels_.size()) {
    labels_.push_back({node_->createChildSceneNode(), std::make_unique<rviz::MovableText>(line.label)});
    labels_.back().text->setTextAlignment(rviz::MovableText::H_CENTER, rviz::MovableText::V_ABOVE);
    labels_.back().node->attachObject(labels_.back().text.get());
  }
  const Label& label = labels_[number];
  label.text->setCaption(line.label);
  label.text->setColor(toOgre(line.colour));
  label.text->setCharacterHeight(height);
  label.node->setPosition(toOgre(0.5F * (line.start + line.end)));
  label.node->setVisible(true);
}

void LineVisual::setPose(const Ogre::Vector3& position, const Ogre::Quaternion& orientation) {
  node_->setPosition(position);
  node_->setOrientation(orientation);
}

}  // namespace tet_line_tracker
