// Linked GPU programs.
#pragma once

#include <string>
#include <vector>

#include "gl/device.h"
#include "gl/object.h"
#include "gl/shader_source.h"

namespace sfumato::gl {

void deleteProgram(unsigned name);

// One member of a storage or uniform block, as the driver laid it out.
struct BlockMember {
  std::string name;        // "blockOrInstance[0].member" as GL spells it
  int offset = 0;          // bytes from the block's start
  int topLevelStride = 0;  // bytes between elements of the block's outer array, 0 when there is none
};

class Program {
 public:
  Program() = default;
  // Compiles the files (the stage is told by their endings .vert, .geom, .frag, .comp) and links them. Throws
  // Bug with the compiler's first lines, places named by file; Usage when a file is missing.
  Program(const Device& device, const std::vector<std::string>& names, const ShaderDefines& defines = {});

  unsigned name() const { return object_.name(); }
  // Of the binary that the driver made of it, as far as it tells; 0 where it keeps none.
  size_t bytes() const;

  // Every member of the active storage blocks (for the layout test).
  std::vector<BlockMember> storageMembers() const;
  // Every member of the active uniform blocks.
  std::vector<BlockMember> uniformMembers() const;

 private:
  Object<deleteProgram> object_;
};

// What the compiler has against this shader by itself; empty when it takes it.
std::string compileProblem(const Device& device, const std::string& name, const ShaderDefines& defines = {});

}  // namespace sfumato::gl
