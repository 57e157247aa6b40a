// Copies each linked list into its run, a cell an invocation. The run's `first` is where the next node goes, and the
// head the next node: a long walk goes on in the next dispatch.
#include "shaders/lists/banks.glsl"
#include "shaders/lists/counting.glsl"
#include "shaders/lists/order.glsl"
#include "shaders/lists/pool.glsl"
#include "shaders/shared/linear_id.glsl"

layout(std430, binding = STORAGE_LIST_HEADS) buffer ListHeads {
  uint listHeads[];
};
layout(binding = TEXTURE_LIST_LINKS) uniform usamplerBuffer listLinks;  // ListLink
layout(binding = TEXTURE_LIST_LINKED_PAYLOADS) uniform usamplerBuffer listLinkedPayloads;

const uint WORK_LIMIT = 30000u / (PAYLOAD_WORDS + 1);

void main() {
  uint cell = linearId();
  if (cell >= uint(listWindow.range.y)) return;
  uint node = listHeads[cell];
  if (node == 0u) return;
  uint place = listRuns[cell].first;
  uvec2 previous = uvec2(0xffffffffu, 0u);  // before every other
  uint unsorted = 0u;
  uint work = 0u;
  while (node != 0u && work < WORK_LIMIT) {
    uvec3 link = texelFetch(listLinks, int(node)).xyz;
    if (work != 0u && !listBefore(previous, link.xy)) ++unsorted;
    setListKey(place, link.xy);
    for (uint word = 0u; word < uint(PAYLOAD_WORDS); ++word)
      setListWord(place, word, texelFetch(listLinkedPayloads, int(node * uint(PAYLOAD_WORDS) + word)).x);
    previous = link.xy;
    node = link.z;
    ++place;
    ++work;
  }
  // A run that took more than one dispatch is sorted whatever the order of its parts.
  if (node != 0u) {
    atomicAdd(listCounters.unfinished, 1u);
    ++unsorted;
  } else {
    place -= listRuns[cell].count;
  }
  if (unsorted != 0u) atomicAdd(listCounters.unsorted, unsorted);
  listHeads[cell] = node;
  listRuns[cell].first = place;
}
