// Judges every list that is built while it watches, whatever draws the nodes: the draws are issued once more,
// into a plain log and no list, and each finished list is compared with it node by node.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "lists/lists_gpu.h"
#include "lists/stress/comparison.h"
#include "lists/stress/guards_gpu.h"
#include "lists/stress/lookups_gpu.h"
#include "lists/stress/verification.h"

namespace sfumato::lists::stress {

struct Audited {
  Findings findings;
  size_t lookups = 0;
  double lookupSeconds = 0;
  std::vector<uint32_t> lengths;  // of the cells that were built first: nodes of each
};

// Costs the draws twice over, and memory and time on the host for all nodes of a window. The draws must store
// nodes through shaders/lists/insert.glsl, and the same ones each time.
class Audit : public Observer {
 public:
  void allocates(gl::Device& device) override { guards_.add(device); }
  void built(gl::Device& device, const Lists& lists, const Window& window, const Draw& draw) override;

  // By the containers' labels.
  const std::map<std::string, Audited>& audited() const { return audited_; }
  // Words of memory beside the lists that changed.
  size_t overwritten() const { return guards_.changedWords(); }

 private:
  LoggedNodes log(gl::Device& device, size_t payloadBytes, const Window& window, const Draw& draw,
                  size_t expected);
  void lookUp(gl::Device& device, const Lists& lists, const Window& window, const ReadLists& read,
              Audited& audited) const;

  Guards guards_;
  std::map<std::string, Audited> audited_;
};

}  // namespace sfumato::lists::stress
