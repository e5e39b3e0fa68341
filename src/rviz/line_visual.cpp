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
  std::size_t pieces = 0;
  float faintest = 1.0F;
  for (const ShownLine& line : lines) {
    pieces += line.between.size() + 1;
    faintest = std::min(faintest, line.colour.alpha);
    if (!line.label.empty()) drawLabel(labels++, line, text_height);
  }
  for (std::size_t i = labels; i < labels_.size(); ++i) labels_[i].node->setVisible(false);
  if (lines.empty()) return;

  // Pieces of two points each: BillboardLine mixes lines up when they have different numbers of points.
  billboards_->setMaxPointsPerLine(2);
  billboards_->setNumLines(static_cast<std::uint32_t>(pieces));
  billboards_->setLineWidth(width);
  // The opacity given here only decides whether the material is blended; each point has its own.
  billboards_->setColor(1.0F, 1.0F, 1.0F, faintest);
  bool is_first = true;
  const auto addPiece = [&](const Eigen::Vector3f& from, const Eigen::Vector3f& to, const Colour& colour) {
    if (!is_first) billboards_->newLine();
    is_first = false;
    billboards_->addPoint(toOgre(from), toOgre(colour));
    billboards_->addPoint(toOgre(to), toOgre(colour));
  };
  for (const ShownLine& line : lines) {
    Eigen::Vector3f last = line.start;
    for (const Eigen::Vector3f& point : line.between) {
      addPiece(last, point, line.colour);
      last = point;
    }
    addPiece(last, line.end, line.colour);
  }
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
  const Eigen::Vector3f middle =
      line.between.empty() ? 0.5F * (line.start + line.end) : line.between[line.between.size() / 2];
  label.node->setPosition(toOgre(middle));
  label.node->setVisible(true);
}

void LineVisual::setPose(const Ogre::Vector3& position, const Ogre::Quaternion& orientation) {
  node_->setPosition(position);
  node_->setOrientation(orientation);
}

}  // namespace tet_line_tracker
