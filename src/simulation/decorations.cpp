#include "decorations.h"

#include <algorithm>

namespace tet_line_tracker {
namespace {

float between(RandomSequence& random, double low, double high) {
  return static_cast<float>(random.uniform(low, high));
}

}  // namespace

void paintDoor(Texture& texture, RandomSequence& random, float u) {
  const float frame = between(random, 60.0, 200.0);
  const float leaf = between(random, 80.0, 190.0);
  texture.paint({u, 0.0F, u + 0.98F, 2.08F, frame});
  const float left = u + 0.07F;
  const float right = u + 0.91F;
  texture.paint({left, 0.01F, right, 2.01F, leaf});
  const float step = between(random, 8.0, 18.0);
  for (const auto& [low, high] : {std::make_pair(0.15F, 0.95F), std::make_pair(1.10F, 1.88F)}) {
    texture.paint({left + 0.12F, low, left + 0.38F, high, leaf - step});
    texture.paint({left + 0.46F, low, left + 0.72F, high, leaf - step});
  }
  texture.paint({right - 0.07F, 1.00F, right - 0.03F, 1.06F, 35.0F});
}

void paintWindow(Texture& texture, RandomSequence& random, float u, float v, float width, float height) {
  const float frame = between(random, 40.0, 90.0);
  constexpr float kBar = 0.06F;
  texture.paint({u, v, u + width, v + height, frame});
  const float pane_width = (width - 3.0F * kBar) / 2.0F;
  const float pane_height = (height - 3.0F * kBar) / 2.0F;
  for (int j = 0; j < 2; ++j) {
    for (int i = 0; i < 2; ++i) {
      const float left = u + kBar + static_cast<float>(i) * (pane_width + kBar);
      const float bottom = v + kBar + static_cast<float>(j) * (pane_height + kBar);
      texture.paint({left, bottom, left + pane_width, bottom + pane_height, between(random, 195.0, 225.0)});
    }
  }
  texture.paint({u - 0.08F, v - 0.05F, u + width + 0.08F, v, 150.0F});
}

void paintPoster(Texture& texture, RandomSequence& random, float u, float v, float width, float height) {
  const float sheet = between(random, 150.0, 215.0);
  const float border = between(random, 25.0, 120.0);
  texture.paint({u, v, u + width, v + height, border});
  const float inset = 0.04F * std::min(width, height);
  texture.paint({u + inset, v + inset, u + width - inset, v + height - inset, sheet});
  const int fields = 2 + random.below(3);
  for (int i = 0; i < fields; ++i) {
    const float field_width = width * between(random, 0.2, 0.45);
    const float field_height = height * between(random, 0.12, 0.25);
    const float left = u + 2.0F * inset + between(random, 0.0, 1.0) * (width - field_width - 4.0F * inset);
    const float bottom = v + height * between(random, 0.4, 0.68);
    const float gray =
        random.below(3) == 0 ? sheet - between(random, 8.0, 20.0) : between(random, 20.0, 180.0);
    texture.paint({left, bottom, left + field_width, bottom + field_height, gray});
  }
  for (int line = 0; line < 4; ++line) {
    const float bottom = v + height * (0.10F + 0.065F * static_cast<float>(line));
    float left = u + 3.0F * inset;
    const float end = u + width * between(random, 0.6, 0.9);
    while (left < end) {  // words
      const float right = std::min(end, left + width * between(random, 0.05, 0.16));
      texture.paint({left, bottom, right, bottom + 0.03F * height, 60.0F});
      left = right + 0.02F * width;
    }
  }
}

void paintShelf(Texture& texture, RandomSequence& random, int boards) {
  const float width = texture.width();
  const float step = texture.height() / static_cast<float>(boards);
  constexpr float kBoard = 0.03F;
  for (int i = 0; i < boards; ++i) {
    const float bottom = static_cast<float>(i) * step + kBoard;
    texture.paint({kBoard, bottom, width - kBoard, static_cast<float>(i + 1) * step - kBoard, 45.0F});
    float left = kBoard;
    while (true) {  // books
      const float right = left + between(random, 0.025, 0.09);
      if (right > width - 2.0F * kBoard) break;
      if (random.below(6) != 0) {
        texture.paint(
            {left, bottom, right, bottom + step * between(random, 0.5, 0.85), between(random, 50.0, 210.0)});
      }
      left = right;
    }
  }
}

void paintCrate(Texture& texture, RandomSequence& random) {
  const float w = texture.width();
  const float h = texture.height();
  const float rim = 0.14F * std::min(w, h);
  const float inside = between(random, 70.0, 100.0);
  texture.paint({rim, rim, w - rim, h - rim, inside});
  texture.paint({rim, 0.5F * h - 0.5F * rim, w - rim, 0.5F * h + 0.5F * rim, inside + 45.0F});
}

void paintParcel(Texture& texture, RandomSequence& random) {
  const float w = texture.width();
  const float h = texture.height();
  texture.paint({0.46F * w, 0.0F, 0.54F * w, h, between(random, 170.0, 200.0)});
  const float left = between(random, 0.08, 0.18) * w;
  const float bottom = between(random, 0.2, 0.6) * h;
  texture.paint({left, bottom, left + 0.22F * w, bottom + 0.2F * h, 215.0F});
  texture.paint({left + 0.03F * w, bottom + 0.04F * h, left + 0.19F * w, bottom + 0.07F * h, 50.0F});
  texture.paint({left + 0.03F * w, bottom + 0.11F * h, left + 0.15F * w, bottom + 0.14F * h, 50.0F});
}

void paintSkirting(Texture& texture, float gray) {
  texture.paint({0.0F, 0.0F, texture.width(), 0.09F, gray});
}

}  // namespace tet_line_tracker
