#include "lists/validation/self_test_gpu.h"

#include <algorithm>

#include "base/error.h"
#include "base/file.h"
#include "gl/shader_source.h"

namespace sfumato::lists::validation {

namespace fs = std::filesystem;

std::vector<EngineMutant> engineMutants() {
  const std::string insert = "lists/insert.glsl";
  return {
      {"engine-spinlock", "no-lock", insert, "uint head = atomicExchange(listHeads[cell], LIST_LOCKED);",
       "uint head = listHeads[cell];"},
      {"engine-lockfree", "no-atomic-head", insert, "atomicCompSwap(listHeads[cell], current, node)",
       "(listHeads[cell] == current ? (listHeads[cell] = node, current) : ~current)"},
      {"engine-lockfree", "no-atomic-next", "lists/links.glsl",
       "found = atomicCompSwap(listLinks[bank].links[i].next, expected, next)",
       "found = listLinks[bank].links[i].next; if (found == expected) listLinks[bank].links[i].next = next"},
      {"engine-append", "no-atomic", insert, "setLinkNext(node, atomicExchange(listHeads[cell], node));",
       "setLinkNext(node, listHeads[cell]); listHeads[cell] = node;"},
      {"engine-append", "no-atomic-node", insert, "uint node = atomicAdd(listCounters.demand, 1u) + 1u;",
       "uint node = ++listCounters.demand;"},
      {"engine-count", "no-atomic", insert,
       "uint node = atomicAdd(listRuns[cell - uint(listWindow.range.x)].first, 0xffffffffu) - 1u;",
       "uint node = --listRuns[cell - uint(listWindow.range.x)].first;"},
      {"engine-count", "no-atomic-count", insert,
       "atomicAdd(listRuns[cell - uint(listWindow.range.x)].count, 1u)",
       "++listRuns[cell - uint(listWindow.range.x)].count"},
  };
}

std::string mutated(const EngineMutant& mutant) {
  const auto& all = gl::embeddedShaders();
  const auto shader = std::find_if(all.begin(), all.end(),
                                   [&](const gl::EmbeddedShader& s) { return s.name == mutant.file; });
  std::string text(shader == all.end() ? std::string_view() : shader->text);
  const size_t at = text.find(mutant.text);
  if (at == std::string::npos || text.find(mutant.text, at + 1) != std::string::npos)
    base::fail(base::ExitCode::Bug,
               "self-test: {}: \"{}\" is not there once: the mutant {} must follow the shader", mutant.file,
               mutant.text, mutant.name);
  return text.replace(at, mutant.text.size(), mutant.replacement);
}

std::vector<Run> mutantRuns(const std::vector<Check>& checks, const fs::path& folder) {
  const std::vector<EngineMutant> ofTheEngine = engineMutants();
  std::vector<Run> runs;
  for (const Check& check : checks) {
    for (const std::string& mutant : check.mutants) runs.push_back({check, mutant, {"--mutant", mutant}});
    for (const EngineMutant& mutant : ofTheEngine) {
      if (mutant.check != check.name) continue;
      const fs::path shaders = folder / (check.name + "-" + mutant.name);
      fs::create_directories((shaders / mutant.file).parent_path());
      base::writeFile(shaders / mutant.file, mutated(mutant));
      runs.push_back({check, mutant.name, {"--shader-dir", shaders}});
    }
  }
  return runs;
}

bool caught(const Outcome& outcome) {
  const Result& result = outcome.result;
  const auto says = [&](const char* text) { return result.finding.find(text) != std::string::npos; };
  return result.verdict != Verdict::Pass && !says("does not compile") && !says("does not link") &&
         !says("ended with exit code");
}

bool allCaught(const Report& report) {
  const auto& all = report.outcomes.all;
  return std::all_of(all.begin(), all.end(), [](const Outcome& outcome) { return caught(outcome); });
}

std::string selfTestTable(const Report& report) {
  const Driver& driver = report.driver.driver;
  std::string text = fmt::format("{}, {}\nfaults in our own shaders, and what the checks say to them\n\n",
                                 driver.renderer, driver.version);
  size_t missed = 0;
  for (const Outcome& outcome : report.outcomes.all) {
    const bool seen = caught(outcome);
    missed += seen ? 0 : 1;
    text += fmt::format("  {:<8} {:<8} {:<36} {}\n", seen ? "seen" : "NOT SEEN", name(outcome.result.verdict),
                        outcome.run.check.name + ": " + outcome.run.mutant, outcome.result.finding);
  }
  if (report.outcomes.interrupted) text += "\ninterrupted: what was not done by then is not listed\n";
  return text + fmt::format("\n{} faults in {:.1f} s, {} not seen\n", report.outcomes.all.size(),
                            report.seconds, missed);
}

}  // namespace sfumato::lists::validation
