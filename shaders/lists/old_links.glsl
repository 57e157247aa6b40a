// A list container for readers.
#include "shaders/shared/bindings.h"
#include "shaders/shared/lists.h"

layout(std430, binding = STORAGE_OLD_HEADS) readonly buffer ListHeads {
  uint listHeads[];
};
layout(std430, binding = STORAGE_OLD_LINKS) readonly buffer ListLinks {
  ListLink listLinks[];
};
