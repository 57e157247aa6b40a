// Are the checks able to fail? Faults are put into our own shaders, and each must turn a check red or NO
// POWER.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lists/validation/report.h"
#include "lists/validation/runner.h"

namespace sfumato::lists::validation {

// A fault in a shader of the engine itself: `text`, which must be there exactly once, becomes `replacement`.
struct EngineMutant {
  std::string check;  // that uses the shader
  std::string name;
  std::string file;  // below shaders/
  std::string text;
  std::string replacement;
};
std::vector<EngineMutant> engineMutants();

// The shader with its fault. Throws Bug when the text is not there once: the shader has changed and the
// mutant must follow it.
std::string mutated(const EngineMutant& mutant);

// The runs of all mutants of these checks. Mutated shaders of the engine are written below `folder`.
std::vector<Run> mutantRuns(const std::vector<Check>& checks, const std::filesystem::path& folder);

// Whether the fault was seen: the check failed, and not because the mutant does not compile or its process
// does not start; or it said that it could not have seen a fault here, or could not run.
bool caught(const Outcome& outcome);
bool allCaught(const Report& report);
// For people: what became of each mutant, and how many were not seen.
std::string selfTestTable(const Report& report);

}  // namespace sfumato::lists::validation
