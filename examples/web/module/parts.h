// What the parts of the module share.
#ifndef BRUME_WEB_PARTS_H
#define BRUME_WEB_PARTS_H

#include <brume/brume.h>

#include "brume_web.h"

enum { kMasks = 64, kPlanned = 256, kTicksPerSecond = 64 };

typedef struct web_match {
  brume_context* context;
  brume_level* level;
  brume_masks* masks;
  brume_world* world;
  brume_field* fields[kPlayers];
  brume_state* states[kPlayers];  // the newest of each, or null
  brume_layout layout;
} web_match;
extern web_match g_match;

// The extinction of the densest smoke [1/m].
static const float kExtinction = 7.0f;

// Leaves a function with another number than 0 where a call fails.
#define TRY(call)                                 \
  do {                                            \
    const brume_result result_ = call;            \
    if (result_ != BRUME_OK) return (int)result_; \
  } while (0)

static inline brume_point point_of(const float* xyz) {
  return (brume_point){xyz[0], xyz[1], xyz[2]};
}

#endif
