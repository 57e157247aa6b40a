// Every struct that C++ and GLSL share, in a storage block each, all of them active; layout_test.cpp reflects them.
#include "shaders/shared/ambient_occlusion.h"
#include "shaders/shared/aovs.h"
#include "shaders/shared/deep.h"
#include "shaders/shared/deepshadow.h"
#include "shaders/shared/geometry.h"
#include "shaders/shared/grids.h"
#include "shaders/shared/lights.h"
#include "shaders/shared/lists.h"
#include "shaders/shared/post.h"
#include "shaders/shared/resolve.h"
#include "shaders/shared/stress.h"
#include "shaders/shared/surface.h"
#include "shaders/shared/view.h"
#include "shaders/shared/volumes.h"

layout(local_size_x = 1) in;
// STRUCT and LAYOUT are defined by the test, one program for each.
layout(LAYOUT, binding = 0) BLOCK Subject {
  STRUCT subject[2];
};
layout(std430, binding = 1) buffer Sink {
  STRUCT sink[2];
};

void main() {
  sink[1] = subject[1];
}
