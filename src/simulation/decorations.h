#pragma once

#include "counter_random.h"
#include "texture.h"

namespace tet_line_tracker {

// What hangs on walls, painted into their texture: no two surfaces share a plane, so nothing flickers.
// Places are the lower left corner [m].

/// Frame, leaf with low-contrast panels, handle: 0.98 x 2.08 m.
void paintDoor(Texture& texture, RandomSequence& random, float u);
/// Frame, 2 x 2 bright panes, sill.
void paintWindow(Texture& texture, RandomSequence& random, float u, float v, float width, float height);
/// Sheet with a border, a few fields and lines of text.
void paintPoster(Texture& texture, RandomSequence& random, float u, float v, float width, float height);
/// Boards with things on them, over the whole texture.
void paintShelf(Texture& texture, RandomSequence& random, int boards);
/// Boards around the rim and one across, as on a crate.
void paintCrate(Texture& texture, RandomSequence& random);
/// A strip of parcel tape and a label.
void paintParcel(Texture& texture, RandomSequence& random);
/// The strip along the foot of a wall.
void paintSkirting(Texture& texture, float gray);

}  // namespace tet_line_tracker
