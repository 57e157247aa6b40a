// Lets a header be read by C++ and GLSL alike. Struct members are scalars and vec4, ivec4, mat4 (never vec3), so
// that std140, std430 and C++ lay them out the same; a test reflects each of them.
#ifdef __cplusplus
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#define SHARED_BEGIN namespace sfumato::shared { using glm::mat4; using glm::vec4; using glm::ivec4; using uint = uint32_t;
#define SHARED_END }
#else
#define SHARED_BEGIN
#define SHARED_END
#endif
