// Who is bound where. One number has one meaning in every pass that uses it.
#pragma once

// Uniform blocks
#define UNIFORM_VIEW 0  // ViewParams: what is looked from
#define UNIFORM_PASS 1  // the pass's own block
#define UNIFORM_LISTS 2      // ListWindow, while lists are built
#define UNIFORM_LIST_STEP 3  // ListStep: one step of their scan or sort
#define UNIFORM_GRIDS 4      // GridData[]

// Storage blocks
#define STORAGE_LIST_RUNS 2   // the lists that are built: see lists.h
#define STORAGE_LIST_HEADS 3  // of linked lists
#define STORAGE_LIST_SUMS 4   // of the scan; then the cells that are sorted
#define STORAGE_LIST_COUNTERS 5
#define STORAGE_AOVS 7              // AovPixel[]
#define STORAGE_SMOKE_KNOTS 7       // uvec4[]: see SmokeBlock
#define STORAGE_ROUTED_MET 7        // uvec2[]: keys of the last fragments that rays have met
#define STORAGE_RECEIVER_DEPTHS 8   // of each cell of the light lists
#define STORAGE_LOOKUPS 9           // of each ray, when they are counted: see resolve.h
#define STORAGE_STRESS_NUMBERS 8    // of the nodes of a load
#define STORAGE_FIRE_RAMPS 8        // vec4[]: radiance per metre
#define STORAGE_SHADOW_TEXELS 11  // ShadowTexel[] of the light that is built
#define STORAGE_SHADOW_KNOTS 12   // uint[], four a unit, likewise
#define STORAGE_VOLUMES 13        // VolumeData[]
#define STORAGE_RAYS 14         // RayState[]
#define STORAGE_SEEN 27         // float[]: what rays have seen: see rays.glsl
#define STORAGE_COUNTERS 15       // the pass's own counters
#define STORAGE_PIXEL_GROUPS 16   // which pixels are walked sample by sample: see resolve.h
#define STORAGE_LIST_NODES 17     // keys or links, LIST_MAX_BANKS of them
#define STORAGE_LIST_PAYLOADS 21  // likewise
#define STORAGE_BENDS 9             // of each pixel: see layer_walk.comp
#define STORAGE_SMOKE_PARENTS 25  // uint[]: blocks of smoke that are refined
#define STORAGE_WALKED_RAYS 25    // uint[]: numbers of the rays that meet surfaces
#define STORAGE_DEEP_RAYS 25      // the rays that are recorded: see deep_events.glsl
#define STORAGE_DEEP_EVENTS 26    // DeepEvent[]

// Images that are written
#define IMAGE_PICTURE 0  // of post-processing

// Texture units
#define TEXTURE_PICTURE 0           // what post-processing reads
#define TEXTURE_PICTURE_SURFACES 1  // normal and 1 / depth of each pixel
#define TEXTURE_BASE_COLOUR 0
#define TEXTURE_METALLIC_ROUGHNESS 1
#define TEXTURE_NORMAL 2
#define TEXTURE_EMISSIVE 3
#define TEXTURE_TRANSMISSION 4
#define TEXTURE_SPECULAR 5
#define TEXTURE_SPECULAR_COLOUR 6
#define TEXTURE_OPAQUE_DEPTH 7
#define TEXTURE_SURFACE_0 8
#define TEXTURE_SURFACE_1 9
#define TEXTURE_SHADOW_TEXELS 10
#define TEXTURE_SHADOW_KNOTS 11
#define TEXTURE_LIST_RUNS 12  // the lists that are read
#define TEXTURE_LIST_KEYS 13
#define TEXTURE_LIST_PAYLOADS 14
#define TEXTURE_LIST_LINKS 13  // while they are built
#define TEXTURE_LIST_LINKED_PAYLOADS 14
#define TEXTURE_LIGHT_CELL_RUNS 15  // the light lists, likewise
#define TEXTURE_LIGHT_CELL_KEYS 16
#define TEXTURE_SHADOW_NODES 17  // of linked shadow lists, for comparisons
#define TEXTURE_RECEIVER_DEPTHS 17  // of each cell, while its light list is built
#define TEXTURE_BRICK_MAP 18
#define TEXTURE_SMOKE_BLOCKS 19  // SmokeBlock[]
// Where layers of surfaces are lit one at a time, and no lists of them are read:
#define TEXTURE_SURFACE_2 12
#define TEXTURE_LAYER_LIGHT 13
#define TEXTURE_PEELED_DEPTH 14
#define TEXTURE_PEELED_ID 17
#define TEXTURE_FINISHED_LIGHT 13
#define TEXTURE_FINISHED_DEPTH 14
#define TEXTURE_ROUTED_KEYS 14  // of the fragments in samples: depth, number
#define TEXTURE_ROUTED_COUNTS 13  // of fragments of a pixel
#define TEXTURE_ROUTED_PAGE 14  // while they are drawn
#define TEXTURE_OCCLUSION 20  // of ambient light, where surfaces are lit
#define TEXTURE_SMOKE_KNOTS 21   // of these
#define TEXTURE_DRAWS 22         // DrawData[]
#define TEXTURE_MATERIALS 23     // MaterialData[]
#define TEXTURE_LIGHTS 24        // LightData[]
#define TEXTURE_SHADOW_FACES 25  // ShadowFace[]
#define TEXTURE_GRIDS 26  // and the units after it

// Image units
#define IMAGE_RESULT 0  // what a pass of images writes
