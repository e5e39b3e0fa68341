#pragma once

#include <memory>

#include <rviz/message_filter_display.h>
#include <rviz/properties/bool_property.h>
#include <rviz/properties/float_property.h>
#include <rviz/properties/status_property.h>
#include <QObject>
#include <QString>
#include <boost/bind/bind.hpp>

#include "line_visual.h"

namespace tet_line_tracker {

/// What the displays of lines have in common: how lines are drawn, and a status that says what is missing.
/// Everything runs in the thread of the window.
template <class Message>
class LineDisplay : public rviz::MessageFilterDisplay<Message> {
 public:
  void reset() override {
    rviz::MessageFilterDisplay<Message>::reset();
    arrived_ = 0;
    forget();
    if (visual_) visual_->clear();
    tellIfNothingArrived();
  }

 protected:
  using Base = rviz::MessageFilterDisplay<Message>;
  using StatusProperty = rviz::StatusProperty;

  /// The subclass makes its own properties before makeCommonProperties(), to have them above these.
  void makeCommonProperties(float width, float text_height) {
    width_ = makeFloat("Line Width", width, "Width of the lines [m].", 0.0001F);
    alpha_ = makeFloat("Alpha", 1.0F, "Opacity of the lines: 0 is invisible, 1 is opaque.", 0.0F);
    alpha_->setMax(1.0F);
    ids_ = new rviz::BoolProperty("Show Ids", false, "Write the id of each line beside its middle.", this);
    text_height_ = new rviz::FloatProperty("Text Height", text_height, "Height of the ids [m].", ids_);
    text_height_->setMin(0.001F);
    redrawWith(ids_);
    redrawWith(text_height_);
  }

  rviz::FloatProperty* makeFloat(const char* name, float value, const char* description, float min) {
    auto* property = new rviz::FloatProperty(name, value, description, this);
    property->setMin(min);
    redrawWith(property);
    return property;
  }

  /// Changes of the property are seen at once, also while no messages come.
  void redrawWith(rviz::Property* property) {
    // A connection to a member function, so that these classes need no moc.
    QObject::connect(property, &rviz::Property::changed, this, &LineDisplay::redraw);
  }

  void onInitialize() override {
    Base::onInitialize();
    visual_ = std::make_unique<LineVisual>(this->scene_manager_, this->scene_node_);
    this->sub_.registerCallback(boost::bind(&LineDisplay::noteArrival, this, boost::placeholders::_1));
  }

  void subscribe() override {
    Base::subscribe();
    tellIfNothingArrived();
  }

  void redraw() {
    if (!visual_) return;
    const ShownLines shown = show();
    visual_->draw(shown.lines, width_->getFloat(), text_height_->getFloat());
    this->context_->queueRender();
  }

  /// The lines to draw now, with the settings of now. Sets the status.
  virtual ShownLines show() = 0;
  /// Drops all messages.
  virtual void forget() = 0;

  void tellTransform(bool known, const std::string& frame) {
    if (known) {
      this->deleteStatus("Transform");
    } else {
      this->setStatus(StatusProperty::Error, "Transform",
                      QString("No transform from [%1] to [%2] at the stamp of the message")
                          .arg(QString::fromStdString(frame), this->fixed_frame_));
    }
  }

  void tellCounts(const ShownLines& shown) {
    this->setStatus(StatusProperty::Ok, "Lines",
                    QString("%1 shown, %2 hidden by the settings").arg(shown.shown).arg(shown.hidden));
  }

  rviz::FloatProperty* width_{};
  rviz::FloatProperty* alpha_{};
  rviz::BoolProperty* ids_{};
  rviz::FloatProperty* text_height_{};
  std::unique_ptr<LineVisual> visual_;

 private:
  void tellIfNothingArrived() {
    if (!this->isEnabled() || arrived_ > 0 || this->topic_property_->getTopicStd().empty()) return;
    this->setStatus(StatusProperty::Warn, "Topic", "No message has come: does its publisher run?");
  }

  /// Messages come here before they wait for their transform.
  void noteArrival(const typename Message::ConstPtr& message) {
    ++arrived_;
    if (this->messages_received_ > 0) return;
    this->setStatus(StatusProperty::Warn, "Topic",
                    QString("%1 messages, none shown: no transform from [%2] to [%3] yet")
                        .arg(arrived_)
                        .arg(QString::fromStdString(message->header.frame_id), this->fixed_frame_));
  }

  int arrived_{0};
};

}  // namespace tet_line_tracker
